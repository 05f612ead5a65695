#include "server/api/export.hpp"

#include <fstream>

#include "core/file.hpp"
#include "server/api/people_test_support.hpp"
#include "trial/trial_file.hpp"

namespace api {
namespace {
using testing::PeopleTest;

class Export : public PeopleTest {
 protected:
  /// A trial file of 1 kHz whose depth is 1e-6 m a tick, in place of tom's.
  void write_toms_trial(std::uint32_t samples) {
    const auto path = folder_.path() / "trial";
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
      if (auto done = store::add_object(tx, sha256, bytes.size(), 1); !done) return done;
      auto set = tx.query("update trials set sha256 = ?, operator_name = ? where id = ?",
                          {sha256, std::string("Mustermann^Erika"), trial_of("tom")});
      if (!set) return set.error();
      return store::set_assessment(tx, trial_of("tom"), {{"force_mean", 2.5, ""}}, true, "{}");
    }));
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
  EXPECT_NE(all.find(",P-tom,"), std::string::npos) << "the pseudonym is there";
}

TEST_F(Export, APseudonymIsTheSameAgainAndAnotherWithAnotherKey) {
  const Pseudonyms here(backend_.secrets), elsewhere(Secrets::random());
  EXPECT_EQ(here.person("Erika"), Pseudonyms(backend_.secrets).person("Erika"));
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
  const std::string name = Pseudonyms(backend_.secrets).trial(trial_of("tom"));
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

TEST_F(Export, AnIdOfTheServersOwnOpensNothing) {
  write_toms_trial(10);
  EXPECT_EQ(get("rex", "/export/trials/" + trial_of("tom") + "/samples.npy").status, 404);
}

}  // namespace
}  // namespace api
