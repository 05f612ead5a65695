/// Lists as each role may ask for them; trials have a test of their own (find_trials_test.cpp).
#include <fmt/format.h>

#include "server/api/people/people_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using core::Json;
using testing::kCase;
using testing::PeopleTest;
using Texts = std::vector<std::string>;

class FoundLists : public PeopleTest {
 protected:
  Json found(const std::string& who, const std::string& address) {
    const auto answer = get(who, address);
    EXPECT_EQ(answer.status, 200) << address << ": " << text(answer);
    return json(answer);
  }
  /// This field of the rows.
  Texts of(const Json& answer, const char* rows, const char* field) {
    Texts out;
    for (const Json& row : answer[rows]) out.push_back(row[field]);
    return out;
  }
  /// An assignment of fay's to tom with this many trials.
  void assign(const std::string& id, const std::string& title, std::optional<std::int64_t> due,
              std::size_t trials) {
    const auto made = store_.write([&](store::Writing& tx) -> core::Result<void> {
      const store::AuditStamp stamp{"fay", 1};
      const auto assigned = TRY(store::add_assignment(
          tx,
          {.study = {.id = id, .title = title, .ordering = store::CaseOrder::fixed},
           .cohort_id = "c-tom",
           .due_utc_us = due,
           .made_by_id = "fay"},
          {kCase}, stamp));
      TRY(store::add_participant(tx, assigned, {.name = "P-" + id},
                                 std::vector<std::string>(trials, kCase), stamp));
      return store::add_assigned_person(tx, assigned, "tom", "P-" + id);
    });
    EXPECT_TRUE(made) << made.error().what;
  }
  /// The trainee does the next trial of the assignment.
  void work_on(const std::string& id, const std::string& trial) {
    const auto done = store_.write([&](store::Writing& tx) -> core::Result<void> {
      const auto assignment = TRY(store::find_assignment(tx, id));
      const auto slots = TRY(store::study_slots(tx, assignment));
      for (const auto& slot : slots)
        if (slot.state == store::SlotState::waiting) return furnish_trial(tx, trial, slot.id);
      return core::Error{core::Errc::not_found, "all are done"};
    });
    EXPECT_TRUE(done) << done.error().what;
  }
  Texts assignments(const std::string& who, const std::string& query = "") {
    return of(found(who, "/assignments" + query), "assignments", "id");
  }
};

TEST_F(FoundLists, UnfinishedAssignmentsComeFirstThoseDueEarliestBeforeTheOthers) {
  assign("later", "Later", now_ + 2000, 1);
  assign("none", "Without a due time", {}, 1);
  assign("over", "Overdue", now_ - 1000, 2);
  const Texts before{"over", "later", "none", "a-tom"};  // a-tom is done
  EXPECT_EQ(assignments("fay"), before);
  EXPECT_EQ(assignments("tom"), before);
  work_on("over", std::string(32, '1'));
  EXPECT_EQ(assignments("fay"), before) << "one of two trials is still to be done";
  work_on("over", std::string(32, '2'));
  const Texts after{"later", "none", "over", "a-tom"};
  EXPECT_EQ(assignments("fay"), after);
  EXPECT_EQ(assignments("tom"), after);
  EXPECT_EQ(assignments("fay", "?state=unfinished"), (Texts{"later", "none"}));
  EXPECT_EQ(assignments("tom", "?state=finished"), (Texts{"over", "a-tom"}));
  // The second trial does not count after all: it is repeated.
  EXPECT_EQ(post("fay", "/assignments/over/trials/" + std::string(32, '2') + "/invalid",
                 {{"reason", "slipped"}})
                .status,
            200);
  EXPECT_EQ(assignments("fay"), before);
  EXPECT_EQ(post("fay", "/assignments/later/due", {{"due_utc_us", nullptr}}).status, 200);
  EXPECT_EQ(assignments("fay"), (Texts{"over", "later", "none", "a-tom"}));
  EXPECT_EQ(post("fay", "/assignments/none/release", {{"release", "released"}}).status, 200);
  EXPECT_EQ(assignments("fay", "?release=held"), (Texts{"over", "later"}));
}

/// What somebody else has still to do does not keep one's own part open.
TEST_F(FoundLists, ATraineesPartIsFinishedByTheTraineesOwnTrials) {
  assign("shared", "Shared", now_ + 1, 1);
  ASSERT_TRUE(store_.write([&](store::Writing& tx) -> core::Result<void> {
    const auto shared = TRY(store::find_assignment(tx, "shared"));
    TRY(store::add_participant(tx, shared, {.name = "P-other"}, {kCase}, {"fay", 1}));
    return store::add_assigned_person(tx, shared, "tia", "P-other");
  }));
  work_on("shared", std::string(32, '1'));
  EXPECT_EQ(assignments("fay", "?state=unfinished"), Texts{"shared"});
  const Texts tom = assignments("tom", "?state=finished"),
              tia = assignments("tia", "?state=unfinished");
  EXPECT_EQ(tom.size() + tia.size(), 3u);  // shared and a-tom; shared
  EXPECT_EQ(tia, Texts{"shared"});
}

TEST_F(FoundLists, AssignmentsAreFoundByThoseTheyConcernAlone) {
  assign("secret", "Knee of the mayor", {}, 1);
  for (const char* who : {"ann", "dora", "fay", "tom"})
    EXPECT_EQ(assignments(who, "?search=MAYOR"), Texts{"secret"}) << who;
  for (const char* who : {"flo", "tia"}) {
    const Json none = found(who, "/assignments?search=mayor");
    EXPECT_EQ(none["assignments"].size(), 0u) << who;
    EXPECT_EQ(none["total"], 0) << who << ": a count tells that there is something";
  }
  const std::string behind = found("ann", "/assignments?limit=1")["next"];
  EXPECT_EQ(assignments("tia", "?limit=200&cursor=" + behind).size() +
                assignments("tia", "?state=unfinished").size(),
            1u)
      << "a cursor of somebody else reaches no more";
  for (const char* who : {"rex", "ted"}) EXPECT_EQ(get(who, "/assignments").status, 403) << who;
}

TEST_F(FoundLists, AccountsAreForAdministrators) {
  EXPECT_EQ(of(found("ann", "/accounts?role=faculty"), "accounts", "name"), (Texts{"fay", "flo"}));
  EXPECT_EQ(of(found("ann", "/accounts?search=TI"), "accounts", "name"), Texts{"tia"});
  EXPECT_EQ(of(found("ann", "/accounts?sort=name&order=descending&limit=2"), "accounts", "name"),
            (Texts{"tom", "tia"}));
  EXPECT_EQ(found("ann", "/accounts?search=P-tom")["total"], 0)
      << "a pseudonym leads to nobody's name";
  EXPECT_EQ(post("ann", "/accounts/tom/state", {{"state", "disabled"}}).status, 200);
  EXPECT_EQ(of(found("ann", "/accounts?state=disabled"), "accounts", "name"), Texts{"tom"});
  for (const char* who : {"dora", "fay", "rex", "ted", "tia"})
    EXPECT_EQ(get(who, "/accounts?search=tom").status, 403) << who;
}

TEST_F(FoundLists, TheAuditTrailIsSearchedByAdministrators) {
  EXPECT_EQ(post("ann", "/accounts/tom/state", {{"state", "disabled"}}).status, 200);
  EXPECT_EQ(post("fay", "/accounts/tia/badge", {{"badge", "4"}}).status, 404) << "not her trainee";
  const Json changes = found("ann", "/audit?search=setaccountstate");
  ASSERT_EQ(changes["rows"].size(), 1u);
  EXPECT_EQ(changes["rows"][0]["who"], "ann");
  EXPECT_EQ(of(found("ann", "/audit?role=faculty"), "rows", "who"), Texts{"fay"});
  const auto oldest = found("ann", "/audit?order=ascending&limit=1");
  EXPECT_EQ(oldest["rows"][0]["number"], 1);
  const auto next =
      found("ann", "/audit?order=ascending&limit=1&cursor=" + oldest["next"].get<std::string>());
  EXPECT_EQ(next["rows"][0]["number"], 2);
  for (const char* who : {"dora", "fay", "rex", "ted", "tia"})
    EXPECT_EQ(get(who, "/audit?search=ann").status, 403) << who;
}

TEST_F(FoundLists, CasesAreFoundByTitleSourceAndState) {
  const std::string other(64, 'd'), scenario(64, 'e');
  ASSERT_TRUE(store_.write([&](store::Writing& tx) -> core::Result<void> {
    TRY(store::add_case(tx,
                        {.id = other,
                         .title = "L4, lateral",
                         .source = "A hospital",
                         .made_utc_us = 2,
                         .planned = true},
                        {}, 5));
    return store::add_case(
        tx, {.id = scenario, .title = "L5 scenario", .source = "", .kind = trial::Rig::probing}, {},
        6);
  }));
  const auto titles = [&](const std::string& query) {
    return of(found("rex", "/cases" + query), "cases", "title");
  };
  EXPECT_EQ(titles(""), (Texts{"L4, lateral", "L3"})) << "newest first, without scenarios";
  EXPECT_EQ(titles("?search=hospital"), Texts{"L4, lateral"});
  EXPECT_EQ(titles("?search=scenario"), Texts{});
  EXPECT_EQ(titles("?sort=title"), (Texts{"L3", "L4, lateral"}));
  EXPECT_EQ(titles("?channel=planned"), Texts{"L4, lateral"});
  EXPECT_EQ(post("ann", "/cases/" + other + "/retire", {{"retired", true}}).status, 204);
  EXPECT_EQ(titles("?state=available"), Texts{"L3"});
  EXPECT_EQ(found("rex", "/cases?state=retired")["total"], 1);
  for (const char* who : {"tom", "ted"}) EXPECT_EQ(get(who, "/cases?search=L3").status, 403) << who;
}

TEST_F(FoundLists, RefuseWhatTheyDoNotKnowInOneLine) {
  for (const char* list : {"trials", "assignments", "accounts", "audit", "cases"}) {
    for (const char* bad :
         {"colour=red", "sort=id", "sort=;drop", "order=1", "limit=0", "limit=201", "limit=-1",
          "cursor=%27--", "search=%ff", "offset=3", "before=3"}) {
      const auto answer = get("ann", fmt::format("/{}?{}", list, bad));
      EXPECT_EQ(answer.status, 400) << list << " " << bad;
      const std::string why = json(answer)["error"];
      EXPECT_EQ(why.find('\n'), std::string::npos) << why;
    }
    const std::string why = json(get("ann", fmt::format("/{}?colour=red", list)))["error"];
    EXPECT_TRUE(why.starts_with("colour: this parameter is unknown; allowed: search, sort, order"))
        << why;
  }
}

TEST_F(FoundLists, ViewsAreTheirOwners) {
  const Json view{{"page", "trials"}, {"name", "My failures"}, {"search", "answer=incorrect"}};
  const Json saved = json(post("fay", "/session/views", view));
  ASSERT_EQ(saved["views"].size(), 1u) << saved;
  EXPECT_EQ(saved["views"][0]["search"], "answer=incorrect");
  EXPECT_EQ(found("flo", "/session/views")["views"].size(), 0u);
  const std::string path = "/api/v1/session/views/" + saved["views"][0]["id"].get<std::string>();
  EXPECT_EQ(ask(request("DELETE", path, as("flo"))).status, 404);
  for (const Json& bad :
       {Json{{"page", "secrets"}, {"name", "x"}, {"search", ""}},
        Json{{"page", "trials"}, {"name", " "}, {"search", ""}},
        Json{{"page", "trials"}, {"name", std::string(65, 'x')}, {"search", ""}},
        Json{{"page", "trials"}, {"name", "x"}, {"search", std::string(2001, 'x')}}})
    EXPECT_EQ(post("fay", "/session/views", bad).status, 400) << bad;
  EXPECT_EQ(found("fay", "/session/views")["views"].size(), 1u);
  EXPECT_EQ(ask(request("DELETE", path, as("fay"))).status, 200);
  EXPECT_EQ(found("fay", "/session/views")["views"].size(), 0u);
  EXPECT_EQ(post("ted", "/session/views", view).status, 403) << "a technician has no such list";
}

}  // namespace
}  // namespace api
}  // namespace tractus
