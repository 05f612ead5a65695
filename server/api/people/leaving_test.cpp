/// A person's own data, and people who leave.
#include <archive.h>
#include <archive_entry.h>

#include <algorithm>

#include "db/store/people/consent.hpp"
#include "db/store/people/erasure.hpp"
#include "db/store/trials/debriefs.hpp"
#include "server/api/people/people_test_support.hpp"
#include "server/api/trials/uploads.hpp"
#include "tests/support/server/world.hpp"

namespace tractus {
namespace api {
namespace {

using core::Json;

const std::string kZoe(32, 'e');
constexpr const char* kName = "zoe of basel";
constexpr const char* kBadge = "Z-4711";
const Caller kStation{Role::station, "s1", "station-1", ""};

/// Names and contents of a zip's entries.
std::map<std::string, std::string> entries_of(const std::string& zip) {
  std::map<std::string, std::string> out;
  archive* reader = archive_read_new();
  archive_read_support_format_zip(reader);
  EXPECT_EQ(archive_read_open_memory(reader, zip.data(), zip.size()), ARCHIVE_OK);
  for (archive_entry* entry = nullptr; archive_read_next_header(reader, &entry) == ARCHIVE_OK;) {
    std::string content(static_cast<std::size_t>(archive_entry_size(entry)), 0);
    EXPECT_EQ(archive_read_data(reader, content.data(), content.size()),
              static_cast<la_ssize_t>(content.size()));
    out[archive_entry_pathname(entry)] = content;
  }
  archive_read_free(reader);
  return out;
}

class Leaving : public testing::PeopleTest {
 protected:
  Leaving() {
    const auto furnished = store_.write([&](store::Writing& tx) -> core::Result<void> {
      store::Account zoe{
          .id = kZoe, .name = kName, .role = Role::trainee, .password_hash = quick_hash()};
      zoe.pseudonym = "Pzoe";
      zoe.badge = kBadge;
      TRY(store::add_account(tx, zoe, 0));
      TRY(store::put_into_cohort(tx, "c-tom", kZoe, store::CohortPart::trainee, 0));
      TRY(store::set_consent(tx, {kZoe, "", "", store::Tier::full, "own word", 1, kName}));
      TRY(assign(tx, "a-zoe", store::Release::released));
      return assign(tx, "a-held", store::Release::held);
    });
    EXPECT_TRUE(furnished) << furnished.error().what;
  }
  core::Result<void> assign(store::Writing& tx, const std::string& id, store::Release release) {
    const store::AuditStamp stamp{"fay", 1};
    auto assigned = TRY(store::add_assignment(tx,
                                              {.study = {.id = id, .title = "title of " + id},
                                               .cohort_id = "c-tom",
                                               .release = release,
                                               .made_by_id = "fay"},
                                              {testing::kCase}, stamp));
    TRY(store::add_participant(tx, assigned, {.name = "Pzoe"},
                               {testing::kCase, testing::kCase, testing::kCase}, stamp));
    TRY(store::add_assigned_person(tx, assigned, kZoe, "Pzoe"));
    auto taken = TRY(store::take_slots(tx, assigned, {.name = "Pzoe"}, "s1", 2, {"station-1", 2}));
    for (const store::Slot& slot : taken.slots) slots_[id].push_back(slot.id);
    return {};
  }
  /// A trial file of the n-th slot that a station has, and its id.
  struct File {
    std::string trial, bytes;
    wire::UploadAnnouncement announced;
  };
  File file(const std::string& assignment, std::size_t n, char letter) {
    const std::string id(32, letter), slot = slots_[assignment].at(n);
    std::string bytes = world::trial_bytes(folder_.path(), id, slot, 250);
    const std::string sha = core::sha256(core::bytes_of(bytes));
    return {id, bytes, {slot, bytes.size(), sha}};
  }
  core::Result<Appended> send(const File& file, std::uint64_t from, std::uint64_t to) {
    const auto piece = core::bytes_of(std::string_view(file.bytes).substr(from, to - from));
    return append_upload(backend_, kStation, file.trial, from, core::crc32c(piece), piece);
  }
  void half_sent(const File& file) {
    ASSERT_TRUE(announce_upload(backend_, kStation, file.trial, file.announced));
    ASSERT_TRUE(send(file, 0, 100));
  }
  void uploaded(const File& file) {
    half_sent(file);
    ASSERT_TRUE(send(file, 100, file.bytes.size()));
    const auto done = commit_upload(backend_, kStation, file.trial);
    ASSERT_TRUE(done) << done.error().what;
  }
  http::Response leave(const std::string& mode, const std::string& typed = kName,
                       const std::string& who = "ann") {
    return post(who, "/accounts/" + kZoe + "/erasure", {{"mode", mode}, {"name", typed}});
  }
  void finish() {
    const auto begun =
        store_.read([](store::Reading& tx) { return store::unfinished_erasures(tx); });
    for (const std::int64_t number : begun.value()) {
      const auto done = store::finish_erasure(store_, objects_, partials_, number, now_);
      ASSERT_TRUE(done) << done.error().what;
    }
  }
  std::vector<std::string> findings() {
    return store_.read([&](store::Reading& tx) { return store::erasure_findings(tx, objects_); })
        .value();
  }
  /// Every place of the database in which the text stands: "table.column".
  std::vector<std::string> places_of(const std::string& wanted) {
    std::vector<std::string> out;
    const auto read = store_.read([&](store::Reading& tx) -> core::Result<void> {
      const auto tables = TRY(tx.tables());
      for (const store::Table& table : tables) {
        const auto rows = TRY(tx.query("select * from " + table.name));
        for (const store::Row& row : rows)
          for (std::size_t i = 0; i < row.size(); ++i)
            if (const auto* held = std::get_if<std::string>(&row.value(i));
                held && held->find(wanted) != std::string::npos)
              out.push_back(table.name + "." + std::to_string(i) + ": " + *held);
      }
      return {};
    });
    EXPECT_TRUE(read);
    return out;
  }
  std::optional<store::TrialRecord> trial(const std::string& id) {
    return store_.read([&](store::Reading& tx) { return store::trial_of(tx, id); }).value();
  }
  std::map<std::string, std::vector<std::string>> slots_;
};

TEST_F(Leaving, OwnDataHoldTheRecordingAndNothingThatIsHeldBack) {
  const File shown = file("a-zoe", 0, 'a'), held = file("a-held", 0, 'b');
  uploaded(shown);
  uploaded(held);
  ASSERT_TRUE(store_.write([&](store::Writing& tx) {
    return store::add_comment(tx, {"k", shown.trial, 0.1, "hold it flatter", "fay", "fay", 5});
  }));
  const auto own = ask(request("GET", "/api/v1/session/data", as(kZoe)));
  ASSERT_EQ(own.status, 200) << text(own);
  auto entries = entries_of(text(own));
  std::set<std::string> names;
  for (const auto& [name, content] : entries) {
    names.insert(name);
    for (const char* other : {"P-tom", "\"tom\"", "tia"})  // her cohort is called c-tom
      EXPECT_EQ(content.find(other), std::string::npos) << name << ": " << content;
    EXPECT_EQ(content.find(held.trial), std::string::npos) << name;
  }
  EXPECT_EQ(names, (std::set<std::string>{
                       "README.txt", "account.json", "assignments.json", "certificates.json",
                       "consents.json", "scores.csv", "sign_ins.csv", "trials.csv",
                       "trials/" + shown.trial + ".json", "trials/" + shown.trial + ".ttrial"}));
  EXPECT_EQ(entries["trials/" + shown.trial + ".ttrial"], shown.bytes);
  EXPECT_NE(entries["README.txt"].find("Not in here: 1 of your trials"), std::string::npos)
      << entries["README.txt"];
  EXPECT_EQ(Json::parse(entries["trials/" + shown.trial + ".json"])["comments"][0]["text"],
            "hold it flatter");
  EXPECT_EQ(Json::parse(entries["consents.json"])[0]["tier"], "full");
  const auto by_admin = get("ann", "/accounts/" + kZoe + "/data");
  ASSERT_EQ(by_admin.status, 200) << text(by_admin);
  EXPECT_EQ(entries_of(text(by_admin)).size(), names.size());
  for (const char* other : {"tom", "fay", "dora", "rex", "ted"})
    EXPECT_EQ(get(other, "/accounts/" + kZoe + "/data").status, 403) << other;
  EXPECT_EQ(get("ann", "/accounts/" + kZoe + "/data?part=2").status, 404);
  std::vector<std::string> noted;
  const auto trail =
      store_.read([](store::Reading& tx) { return store::audit_before(tx, 1'000'000, 1'000'000); });
  for (const store::AuditRow& row : trail.value())
    if (row.act.object == "id=" + kZoe && !row.act.what.starts_with("refused"))
      noted.push_back(row.act.who + " " + row.act.what);
  EXPECT_EQ(noted,
            (std::vector<std::string>{"ann dataOfAccount", std::string(kName) + " ownData"}));
}

TEST_F(Leaving, ErasingLeavesNoNameNoTrialAndNoFile) {
  const File done = file("a-zoe", 0, 'a');
  uploaded(done);
  const auto headers = as(kZoe);
  const auto preview = json(get("ann", "/accounts/" + kZoe + "/erasure?mode=erase"));
  EXPECT_EQ(preview["files"], 1) << preview.dump();
  EXPECT_EQ(preview["file_bytes"], done.bytes.size());
  ASSERT_TRUE(trial(done.trial));
  EXPECT_EQ(leave("erase", "zoe").status, 400);
  ASSERT_EQ(leave("erase").status, 202);
  EXPECT_EQ(ask(request("GET", "/api/v1/session", headers)).status, 401);
  EXPECT_EQ(findings().size(), 1u);  // not finished
  finish();
  EXPECT_TRUE(findings().empty());
  EXPECT_FALSE(trial(done.trial));
  EXPECT_FALSE(*objects_.size_of(done.announced.sha256));
  EXPECT_EQ(places_of(kName), std::vector<std::string>{});
  EXPECT_EQ(places_of(kBadge), std::vector<std::string>{});
  EXPECT_EQ(get("ann", "/accounts/" + kZoe + "/data").status, 404);
  EXPECT_EQ(post("ann", "/accounts/" + kZoe + "/state", {{"state", "active"}}).status, 404);
  EXPECT_EQ(leave("erase").status, 404);
  EXPECT_EQ(text(get("ann", "/accounts?limit=200")).find("erased person"), std::string::npos);
  // Another may be called so now.
  EXPECT_EQ(post("ann", "/accounts", {{"name", kName}, {"role", "trainee"}}).status, 201);
}

TEST_F(Leaving, AnonymisingKeepsTrialsThatNothingLinksToThePerson) {
  const File done = file("a-zoe", 0, 'a');
  uploaded(done);
  ASSERT_EQ(leave("anonymise").status, 202);
  finish();
  EXPECT_TRUE(findings().empty());
  ASSERT_TRUE(trial(done.trial));
  EXPECT_EQ(trial(done.trial)->summary.person, "");
  EXPECT_TRUE(*objects_.size_of(done.announced.sha256));
  EXPECT_EQ(places_of(kName), std::vector<std::string>{});
  const auto linked = store_.read([](store::Reading& tx) {
    return tx.query("select 1 from assignment_people where account_id = ? or participant = 'Pzoe'",
                    {kZoe});
  });
  EXPECT_TRUE(linked.value().empty());
  // Samples are not for research any more: motion identifies people (ADR-0022).
  const auto consents =
      store_.read([](store::Reading& tx) { return store::all_consents(tx); }).value();
  ASSERT_EQ(consents.size(), 2u);  // one per assignment
  for (const auto& one : consents) {
    EXPECT_EQ(one.account_id, "");
    EXPECT_EQ(one.participant, "Pzoe");
    EXPECT_EQ(one.tier, store::Tier::metrics);
  }
}

TEST_F(Leaving, AnUploadUnderWayIsRefusedInWordsAndLeavesNothing) {
  const File half = file("a-zoe", 0, 'a');
  half_sent(half);
  ASSERT_EQ(leave("erase").status, 202);
  const auto more = send(half, 100, half.bytes.size());
  ASSERT_FALSE(more);
  EXPECT_EQ(more.error().code, core::Errc::conflict);  // the station gives up, and says why
  EXPECT_NE(more.error().what.find("whose data were erased"), std::string::npos)
      << more.error().what;
  EXPECT_EQ(commit_upload(backend_, kStation, half.trial).error().code, core::Errc::conflict);
  EXPECT_EQ(announce_upload(backend_, kStation, half.trial, half.announced).error().code,
            core::Errc::conflict);
  finish();
  EXPECT_EQ(partials_.ids(), std::vector<std::string>{});
  EXPECT_TRUE(findings().empty());
}

/// The file is in its place, and the person leaves before the records are written; then the server dies.
TEST_F(Leaving, AFileThatWasPutInPlaceMeanwhileIsDeletedToo) {
  const File half = file("a-zoe", 0, 'a');
  half_sent(half);
  ASSERT_TRUE(send(half, 100, half.bytes.size()));
  ASSERT_TRUE(objects_.link_in(partials_.path_of(half.trial), half.announced.sha256));
  ASSERT_EQ(leave("erase").status, 202);
  EXPECT_EQ(commit_upload(backend_, kStation, half.trial).error().code, core::Errc::conflict);
  finish();
  EXPECT_FALSE(*objects_.size_of(half.announced.sha256));
  EXPECT_EQ(partials_.ids(), std::vector<std::string>{});
}

TEST_F(Leaving, AnAnonymisedPersonsUploadIsTakenAsNobodys) {
  const File half = file("a-zoe", 0, 'a');
  half_sent(half);
  ASSERT_EQ(leave("anonymise").status, 202);
  finish();
  ASSERT_TRUE(send(half, 100, half.bytes.size()));
  const auto done = commit_upload(backend_, kStation, half.trial);
  ASSERT_TRUE(done) << done.error().what;
  EXPECT_EQ(trial(half.trial)->summary.person, "");
  EXPECT_EQ(places_of(kName), std::vector<std::string>{});
}

/// A station that was offline has a slot of the person, and a trial that the server never heard of.
TEST_F(Leaving, ALaterTrialOfAStationIsRefusedInWords) {
  const File late = file("a-zoe", 1, 'c');
  ASSERT_EQ(leave("anonymise").status, 202);
  finish();
  const auto announced = announce_upload(backend_, kStation, late.trial, late.announced);
  ASSERT_FALSE(announced);
  EXPECT_EQ(announced.error().code, core::Errc::conflict);
  EXPECT_NE(announced.error().what.find("delete it from this station"), std::string::npos);
}

TEST_F(Leaving, TheLastAdministratorStays) {
  ASSERT_TRUE(store_.write([](store::Writing& tx) {
    return tx.query("update accounts set state = 'disabled' where id = '1'");
  }));
  const auto refused = post("ann", "/accounts/ann/erasure", {{"mode", "erase"}, {"name", "ann"}});
  EXPECT_EQ(refused.status, 409) << text(refused);
  for (const char* other : {"tom", "fay", "dora", "rex", "ted"})
    EXPECT_EQ(leave("erase", kName, other).status, 403) << other;
}

/// Whichever statement fails, the person is there as before or gone as a whole.
TEST_F(Leaving, AFailureAtAnyStatementLeavesEverythingAsItWas) {
  if (database_.kind() != test_support::DatabaseKind::sqlite)
    GTEST_SKIP() << "the connection of this test is SQLite's";
  uploaded(file("a-zoe", 0, 'a'));
  const auto count = [&] { return places_of(kName).size(); };
  const std::size_t before = count();
  for (int n = 1;; ++n) {
    ASSERT_LT(n, 1000);
    store::Store broken(database_.connection(store::Access::read),
                        std::make_unique<store::testing::FaultyConnection>(
                            database_.connection(store::Access::write), n));
    broken.set_audit_key(store_.audit_key());
    const auto begun = broken.write([&](store::Writing& tx) {
      return store::begin_erasure(tx, {.account_id = kZoe, .begun_utc_us = now_});
    });
    if (begun) break;
    ASSERT_EQ(count(), before) << "step " << n;
  }
  finish();
  EXPECT_EQ(count(), 0u);
}

TEST_F(Leaving, RetentionIsADirectorsAndShownFirst) {
  const Json rules{{"inactive_years", 1},
                   {"inactive_mode", "anonymise"},
                   {"sign_ins_months", nullptr},
                   {"notice_days", 30}};
  const auto shown = post("dora", "/retention/preview", rules);
  ASSERT_EQ(shown.status, 200) << text(shown);
  EXPECT_EQ(json(shown)["people"].size(), 3u);  // tia, tom, zoe: made in 1970
  EXPECT_EQ(json(get("dora", "/retention"))["versions"].size(), 0u);
  Json wish = rules;
  wish["reason"] = "the faculty's rule of 2026";
  for (const char* other : {"ann", "fay", "tom", "rex", "ted"})
    EXPECT_EQ(post(other, "/retention", wish).status, 403) << other;
  const auto set = post("dora", "/retention", wish);
  ASSERT_EQ(set.status, 201) << text(set);
  EXPECT_EQ(json(set)["versions"][0]["inactive_years"], 1);
  EXPECT_EQ(post("dora", "/retention", rules).status, 400);  // no reason
}

}  // namespace
}  // namespace api
}  // namespace tractus
