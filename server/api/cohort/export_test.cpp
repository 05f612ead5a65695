#include "server/api/cohort/export.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <checkout.hpp>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "core/file.hpp"
#include "core/try.hpp"
#include "server/api/people/people_test_support.hpp"
#include "trial/trial_file.hpp"

namespace tractus {
namespace api {
namespace {
using testing::PeopleTest;

class Export : public PeopleTest {
 protected:
  Export() {
    backend_.pseudonym_key.emplace();
    backend_.pseudonym_key->fill(std::byte{7});
    agree("tom", "full");
  }
  /// By the trainee's own word, of everywhere.
  void agree(const std::string& account, const std::string& tier) {
    const auto said = post(account, "/session/consent", {{"tier", tier}});
    ASSERT_EQ(said.status, 200) << text(said);
    EXPECT_EQ(json(said)["everywhere"], tier);
  }
  std::string toms_name() const {
    return store::Pseudonyms(*backend_.pseudonym_key).trial(trial_of("tom"));
  }
  int rows(const std::string& name) {
    const std::string all = csv(name);
    return static_cast<int>(std::ranges::count(all, '\n')) - 1;
  }
  /// A trial file of 1 kHz whose depth is 1e-6 m a tick, in place of tom's.
  void write_toms_trial(std::uint32_t samples) {
    const auto path = folder_.path() / fmt::format("trial-{}", samples);
    trial::Header header;
    header.id = trial_of("tom");
    header.case_id = testing::kCase;
    header.station = "station-1";
    header.operator_name = "Mustermann^Erika";
    header.rig = trial::Rig::probing;
    header.device = "rig";
    header.started_utc_us = 1;
    header.rate_Hz = 1000.0;
    auto writer = trial::TrialWriter::create(path, header);
    ASSERT_TRUE(writer) << writer.error().what;
    std::vector<trial::ProbingSample> all(samples);
    for (std::uint32_t i = 0; i < samples; ++i) {
      all[i].t_s = i * 1e-3;
      all[i].x_m = i * 1e-6;
      all[i].fz_N = 2.5F;
      all[i].tick = i;
    }
    ASSERT_TRUE(writer->append(std::span<const trial::ProbingSample>(all)));
    ASSERT_TRUE(writer->append(trial::Event{samples * 1e-3, "end"}));
    ASSERT_TRUE(writer->finish());
    const auto bytes = core::read_file(path).value();
    const std::string sha256 = objects_.put(bytes).value();
    ASSERT_TRUE(store_.write([&](store::Writing& tx) -> core::Result<void> {
      TRY(store::add_object(tx, sha256, bytes.size(), 1));
      TRY(tx.query("update cases set kind = 'probing'"));
      TRY(tx.query(
          "update trials set sha256 = ?, operator_name = ?, samples = ? where id = ?",
          {sha256, std::string("Mustermann^Erika"), std::int64_t{samples}, trial_of("tom")}));
      return store::set_assessment(tx, trial_of("tom"), {{"force_mean", 2.5, ""}}, true, "{}");
    }));
  }
  http::Response cohort(const std::string& tier, std::map<std::string, std::string> headers = {}) {
    headers.merge(by_token("rex"));
    return ask(request("GET", "/api/v1/export/cohort.zip?tier=" + tier, headers));
  }
  std::string zipped(const std::string& tier) { return text(cohort(tier)); }
  /// Others take the places of those that are held.
  void forget_archives() {
    for (const char* of : {"summary", "metrics", "reduced", "metrics&study=a-tom"})
      EXPECT_EQ(cohort(of).status, 200);
  }
  std::string csv(const std::string& name) {
    const auto response = get("rex", "/export/" + name);
    EXPECT_EQ(response.status, 200) << text(response);
    return text(response);
  }
};

TEST_F(Export, NamesNobodyAndNoTimeOfDay) {
  write_toms_trial(10);
  const std::string all = csv("trials.csv") + csv("scores.csv");
  for (const std::string& secret :
       {std::string("Mustermann"), std::string("tom"), trial_of("tom"), std::string("fay")})
    EXPECT_EQ(all.find("," + secret + ","), std::string::npos) << secret << all;
  EXPECT_EQ(all.find("Mustermann"), std::string::npos) << all;
  EXPECT_EQ(all.find(trial_of("tom")), std::string::npos) << all;
  EXPECT_EQ(all.find("P-tom"), std::string::npos) << "that one stands in the database";
  const store::Pseudonyms names(*backend_.pseudonym_key);
  EXPECT_NE(all.find("," + names.person("account:tom") + ","), std::string::npos) << all;
}

TEST_F(Export, APseudonymIsTheSameAgainAndAnotherWithAnotherKey) {
  const Secrets::Key one{std::byte{1}}, two{std::byte{2}};
  const store::Pseudonyms here(one), elsewhere(two);
  EXPECT_EQ(here.person("Erika"), store::Pseudonyms(one).person("Erika"));
  EXPECT_NE(here.person("Erika"), elsewhere.person("Erika"));
  EXPECT_NE(here.person("Erika"), here.person("Eva"));
}

TEST_F(Export, EveryColumnStandsInTheDictionary) {
  const std::string dictionary = csv("dictionary.csv"), trials = csv("trials.csv");
  std::string head = trials.substr(0, trials.find('\r'));
  int columns = 0;
  while (!head.empty()) {
    const std::string one = head.substr(0, head.find(','));
    head.erase(0, std::min(head.size(), one.size() + 1));
    EXPECT_NE(dictionary.find("trials," + one + ","), std::string::npos) << one;
    ++columns;
  }
  EXPECT_EQ(columns, 15);
}

TEST_F(Export, AFormulaAndAQuoteAreHarmless) {
  ASSERT_TRUE(store_.write([](store::Writing& tx) {
    return tx.query("update cases set title = '=HYPERLINK(\"http://evil\"),x'");
  }));
  EXPECT_NE(csv("trials.csv").find(",\"'=HYPERLINK(\"\"http://evil\"\"),x\","), std::string::npos)
      << csv("trials.csv");
}

/// The .npy format by NumPy's own description (NEP 1): magic, version 1.0, header length, header
/// that ends in a newline at a multiple of 64.
TEST_F(Export, SamplesAreAnArrayThatNumpyReads) {
  write_toms_trial(1000);
  const std::string name = toms_name();
  const auto response = get("rex", "/export/trials/" + name + "/samples.npy?rate_Hz=100");
  ASSERT_EQ(response.status, 200) << text(response);
  const std::string array = text(response);
  ASSERT_EQ(array.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::size_t length =
      static_cast<unsigned char>(array[8]) + 256u * static_cast<unsigned char>(array[9]);
  EXPECT_EQ((10 + length) % 64, 0u);
  EXPECT_EQ(array[10 + length - 1], '\n');
  EXPECT_NE(array.find("'descr': '<f8', 'fortran_order': False, 'shape': (100, 8)"),
            std::string::npos)
      << array.substr(0, 128);
  ASSERT_EQ(array.size(), 10 + length + 100 * 8 * 8);
  std::array<double, 8> row{};
  std::memcpy(row.data(), array.data() + 10 + length + 50 * 64, 64);
  EXPECT_NEAR(row[0], 0.5, 1e-12) << "row 50 of 100 Hz";
  EXPECT_NEAR(row[1], 500e-6, 1e-12);
  EXPECT_EQ(row[3], 2.5);
  const auto full = text(get("rex", "/export/trials/" + name + "/samples.npy?rate_Hz=0"));
  EXPECT_NE(full.find("'shape': (1000, 8)"), std::string::npos);
}

TEST_F(Export, GivesOfEachPersonWhatTheyAgreedToAndNoMore) {
  write_toms_trial(1000);
  const std::string samples = "/export/trials/" + toms_name() + "/samples.npy?rate_Hz=";
  // tier, rows of summary, of trials (header and file aside), samples at 100 Hz, all samples
  struct Case {
    const char* tier;
    int summary, trials, reduced, full;
  };
  for (const Case& c : {Case{"full", 1, 1, 200, 200}, Case{"reduced", 1, 1, 200, 403},
                        Case{"metrics", 1, 1, 403, 403}, Case{"summary", 1, 0, 404, 404},
                        Case{"none", 0, 0, 404, 404}}) {
    agree("tom", c.tier);  // tia never said a word: nothing of hers is ever there
    EXPECT_EQ(rows("summary.csv"), c.summary) << c.tier;
    EXPECT_EQ(rows("trials.csv"), c.trials) << c.tier;
    EXPECT_EQ(get("rex", samples + "100").status, c.reduced) << c.tier;
    EXPECT_EQ(get("rex", samples + "0").status, c.full) << c.tier;
    EXPECT_EQ(get("rex", samples + "101").status, c.full) << c.tier;
  }
}

TEST_F(Export, ConsentOfOneStudyIsOfThatStudyAlone) {
  agree("tom", "none");
  EXPECT_EQ(post("tom", "/session/consent", {{"tier", "metrics"}, {"study", "a-tia"}}).status, 404);
  EXPECT_EQ(post("tom", "/session/consent", {{"tier", "metrics"}, {"study", "a-tom"}}).status, 200);
  EXPECT_EQ(rows("trials.csv"), 1);
  EXPECT_EQ(post("tom", "/session/consent", {{"tier", "everything"}}).status, 400);
  // For somebody with an account nobody but an administrator notes a form.
  const core::Json form{{"account", "tia"}, {"tier", "full"}, {"basis", "form 3"}};
  EXPECT_EQ(post("rex", "/consents", form).status, 403);
  EXPECT_EQ(post("rex", "/consents",
                 {{"study", "a-tia"}, {"participant", "P-tia"}, {"tier", "full"}, {"basis", "x"}})
                .status,
            404);
  EXPECT_EQ(post("ann", "/consents", form).status, 204);
  EXPECT_EQ(rows("trials.csv"), 2);
}

TEST_F(Export, TheWholeCohortIsOneZipOfTheSameTables) {
  write_toms_trial(1000);
  const auto zip = get("rex", "/export/cohort.zip?tier=full");
  ASSERT_EQ(zip.status, 200) << text(zip);
  const std::string bytes = text(zip);
  EXPECT_EQ(bytes.substr(0, 4), "PK\x03\x04");
  for (const std::string& name :
       {std::string("cohort.json"), std::string("trials.csv"), std::string("scores.csv"),
        std::string("dictionary.csv"), "samples/" + toms_name() + ".npy"})
    EXPECT_NE(bytes.find(name), std::string::npos) << name;
  EXPECT_EQ(text(get("rex", "/export/cohort.zip?tier=metrics")).find("samples/"),
            std::string::npos);
  EXPECT_EQ(get("rex", "/export/cohort.zip?tier=none").status, 400);
}

TEST_F(Export, TheZipHasTheArraysThatAreExportedOneByOne) {
  write_toms_trial(1000);
  const std::string one = "/export/trials/" + toms_name() + "/samples.npy?rate_Hz=";
  // The entries are stored: their bytes are in the zip as they are.
  for (const auto& [tier, rate] : {std::pair("full", "0"), std::pair("reduced", "100")})
    EXPECT_NE(zipped(tier).find(text(get("rex", one + rate))), std::string::npos) << tier;
}

TEST_F(Export, TheSameCohortIsTheSameBytes) {
  write_toms_trial(1000);
  const auto first = cohort("full"), again = cohort("full");
  EXPECT_EQ(first.header("ETag"), again.header("ETag"));
  EXPECT_EQ(text(first), text(again));
  EXPECT_NE(first.header("ETag"), cohort("reduced").header("ETag"));
  write_toms_trial(999);
  EXPECT_NE(first.header("ETag"), cohort("full").header("ETag"));
}

TEST_F(Export, ADownloadGoesOnWhereItBroke) {
  write_toms_trial(1000);
  const auto whole = cohort("full");
  const std::string bytes = text(whole), tag(whole.header("ETag"));
  for (const std::size_t first : {std::size_t{1}, bytes.size() / 2, bytes.size() - 30}) {
    const auto rest =
        cohort("full", {{"range", fmt::format("bytes={}-", first)}, {"if-range", tag}});
    EXPECT_EQ(rest.status, 206);
    EXPECT_EQ(rest.header("Content-Range"),
              fmt::format("bytes {}-{}/{}", first, bytes.size() - 1, bytes.size()));
    EXPECT_EQ(text(rest), bytes.substr(first));
  }
  const std::string beyond = fmt::format("bytes={}-", bytes.size());
  EXPECT_EQ(cohort("full", {{"range", beyond}, {"if-range", tag}}).status, 416);
  forget_archives();  // as after a restart: the checksums of what was sent are made anew
  const auto last = cohort("full", {{"range", "bytes=-500"}, {"if-range", tag}});
  EXPECT_EQ(last.status, 206);
  EXPECT_EQ(text(last), bytes.substr(bytes.size() - 500));
}

/// A part of another cohort behind what a client has would be a file of two cohorts.
TEST_F(Export, ARangeThatNamesNoCohortGetsTheWhole) {
  write_toms_trial(1000);
  const std::string bytes = zipped("full");
  const auto whole = cohort("full", {{"range", "bytes=1000-"}});
  EXPECT_EQ(whole.status, 200);
  EXPECT_EQ(text(whole), bytes);
}

TEST_F(Export, ADownloadGoesOnAlthoughATrialCameIn) {
  write_toms_trial(1000);
  const auto whole = cohort("full");
  const std::string bytes = text(whole), tag(whole.header("ETag"));
  agree("tia", "metrics");  // her trial is released now
  const auto rest = cohort("full", {{"range", "bytes=1000-"}, {"if-range", tag}});
  EXPECT_EQ(rest.status, 206);
  EXPECT_EQ(text(rest), bytes.substr(1000));
  const auto other = cohort("reduced", {{"range", "bytes=1000-"}, {"if-range", tag}});
  EXPECT_EQ(other.status, 200) << "the tag is of another export";
  EXPECT_NE(cohort("full").header("ETag"), tag);
}

TEST_F(Export, AWithdrawnConsentEndsADownload) {
  write_toms_trial(100'000);
  for (const char* tier : {"reduced", "none"}) {
    agree("tom", "full");
    const auto begun = cohort("full");
    const std::string tag(begun.header("ETag"));
    const auto& body = std::get<http::MadeBody>(begun.body);
    std::string piece;
    ASSERT_TRUE(body.source->read(piece));
    ASSERT_LT(piece.size(), body.size) << "there is more to come";
    agree("tom", tier);
    now_ += 1'000'000;
    const auto read = body.source->read(piece);
    ASSERT_FALSE(read) << tier;
    EXPECT_EQ(read.error().code, core::Errc::forbidden);
    EXPECT_THAT(read.error().what, ::testing::HasSubstr("1 of the 1 trials"));
    const auto rest = cohort("full", {{"range", "bytes=1000-"}, {"if-range", tag}});
    EXPECT_EQ(rest.status, 200) << "begins anew";
    EXPECT_LT(text(rest).size(), body.size) << "without the samples that were withdrawn";
  }
}

TEST_F(Export, WhoLeftIsInNothingThatIsSentOrHeld) {
  for (const char* mode : {"anonymise", "erase"}) {
    const std::string who = mode == std::string("erase") ? "tia" : "tom";
    agree(who, "metrics");
    const auto begun = cohort("metrics");
    const std::string tag(begun.header("ETag"));
    EXPECT_TRUE(backend_.held_cohorts.find(tag));
    const core::Json wish{{"mode", mode}, {"name", who}};
    ASSERT_EQ(post("ann", "/accounts/" + who + "/erasure", wish).status, 202);
    now_ += 1'000'000;
    std::string piece;
    const auto read = std::get<http::MadeBody>(begun.body).source->read(piece);
    ASSERT_FALSE(read) << mode;
    EXPECT_EQ(read.error().code, core::Errc::forbidden);
    EXPECT_TRUE(piece.empty());
    EXPECT_FALSE(backend_.held_cohorts.find(tag)) << mode;
    const auto rest = cohort("metrics", {{"range", "bytes=9-"}, {"if-range", tag}});
    EXPECT_EQ(rest.status, 200) << mode;
  }
  const std::string held(cohort("metrics").header("ETag"));
  EXPECT_TRUE(backend_.held_cohorts.find(held));
  backend_.held_cohorts.forget();
  EXPECT_FALSE(backend_.held_cohorts.find(held));
}

TEST_F(Export, ADownloadEndsWithTheRightToExport) {
  const auto begun = cohort("metrics");
  ASSERT_EQ(post("ann", "/accounts/rex/state", {{"state", "disabled"}}).status, 200);
  now_ += 1'000'000;
  std::string piece;
  const auto read = std::get<http::MadeBody>(begun.body).source->read(piece);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().what, "who asked for this export may not export any more");
}

TEST_F(Export, ADownloadEndsWhenATrialsFileIsGone) {
  write_toms_trial(1000);
  const auto begun = cohort("full");
  std::filesystem::remove_all(folder_.path() / "objects");
  EXPECT_LT(text(begun).size(), std::get<http::MadeBody>(begun.body).size);
}

TEST_F(Export, NobodyCountsRowsForAClientThatWent) {
  write_toms_trial(1000);
  auto asked = request("GET", "/api/v1/export/cohort.zip?tier=reduced", by_token("rex"));
  asked.called_off = [] { return true; };
  EXPECT_EQ(ask(asked).status, 503);
}

/// deploy/examples, as a researcher would run them: nothing but Python, nothing but R.
TEST_F(Export, TheExamplesInPythonAndRReadTheZip) {
  write_toms_trial(1000);
  const auto zip = get("rex", "/export/cohort.zip?tier=reduced");
  ASSERT_EQ(zip.status, 200) << text(zip);
  const auto path = folder_.path() / "cohort.zip";
  std::ofstream(path, std::ios::binary) << text(zip);
  // Tom's one trial, with its one score; 1 s at 1 kHz is 100 rows at 100 Hz, the last at 0.99 s;
  // of probing trials eight columns.
  const std::string expected = "trials 1 participants 1 scores 1\nsamples " + toms_name() +
                               " rows 100 columns 8 last_t_s 0.990000\n";
  int ran = 0;
  for (const auto& [program, script] :
       {std::pair("python3", "read_cohort.py"), std::pair("Rscript", "read_cohort.R")}) {
    if (std::system((std::string(program) + " --version > /dev/null 2>&1").c_str()) != 0) {
      std::printf("not run, %s is not installed: %s\n", program, script);
      continue;
    }
    const std::string command = std::string(program) + " " + checkout::kSource +
                                "/deploy/examples/" + script + " " + path.string() + " 2>&1";
    std::FILE* out = ::popen(command.c_str(), "r");
    std::string said;
    std::array<char, 4096> piece{};
    while (const std::size_t n = std::fread(piece.data(), 1, piece.size(), out))
      said.append(piece.data(), n);
    EXPECT_EQ(::pclose(out), 0) << said;
    EXPECT_EQ(said, expected) << script;
    ++ran;
  }
  if (ran == 0) GTEST_SKIP() << "the examples: neither python3 nor R is installed";
}

TEST_F(Export, TheKeyIsAnAdministratorsAndLookingAtItIsNoted) {
  write_toms_trial(10);
  EXPECT_EQ(get("rex", "/export/key.csv").status, 403);
  const auto key = get("ann", "/export/key.csv");
  ASSERT_EQ(key.status, 200);
  const store::Pseudonyms names(*backend_.pseudonym_key);
  EXPECT_NE(text(key).find(names.person("account:tom") + ",account,tom\r\n"), std::string::npos)
      << text(key);
  const auto rows = json(get("ann", "/audit"))["rows"];
  EXPECT_EQ(rows[0]["what"], "exportKey");
  EXPECT_EQ(rows[0]["who"], "ann");
  EXPECT_EQ(rows[1]["what"], "refused: exportKey");
  EXPECT_EQ(rows[1]["who"], "rex");
  backend_.pseudonym_key.reset();
  EXPECT_EQ(get("rex", "/export/trials.csv").status, 503);
}

TEST_F(Export, AnIdOfTheServersOwnOpensNothing) {
  write_toms_trial(10);
  EXPECT_EQ(get("rex", "/export/trials/" + trial_of("tom") + "/samples.npy").status, 404);
}

}  // namespace
}  // namespace api
}  // namespace tractus
