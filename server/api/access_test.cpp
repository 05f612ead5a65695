/// Who may call what: the catalogue's own statement, executed cell by cell.
#include "server/api/access.hpp"

#include <cstdio>
#include <regex>
#include <set>

#include "core/try.hpp"
#include "db/store/people/invitations.hpp"
#include "server/api/people/people_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using testing::kCase;
using testing::PeopleTest;

constexpr const char* kNotYours = "this object does not exist, or you may not access it";

/// Someone of the role; the one whose cohort, trial and account are `tom`'s.
std::string someone(Role role) {
  switch (role) {
    case Role::admin:
      return "ann";
    case Role::director:
      return "dora";
    case Role::faculty:
      return "fay";
    case Role::researcher:
      return "rex";
    case Role::technician:
      return "ted";
    default:
      return "tom";
  }
}

/// The name of an object of tom's or of tia's.
std::string object_of(const RouteInfo& route, const std::string& trainee) {
  switch (route.object) {
    case Object::trial:
      return trainee == "tom" ? "TOM" : "TIA";
    case Object::published_case:
      return kCase;
    case Object::account:
      return trainee;
    case Object::cohort:
      return "c-" + trainee;
    case Object::assignment:
      return "a-" + trainee;
    case Object::invitation:
      return trainee == "tom" ? "c-inv" : "c-tia";
    case Object::api_token:
      return "t-" + trainee;
    case Object::none:
      return kCase;
    default:
      return "";  // the object of no route
  }
}

class Access : public PeopleTest {
 protected:
  Access() {
    EXPECT_TRUE(store_.write([](store::Writing& tx) {
      return store::add_cohort(tx, {"c-inv", "into which tom and fay are invited", 0, "ann"});
    }));
  }
  std::string address(const RouteInfo& route, const std::string& trainee) {
    std::string out = route.path;
    std::string object = object_of(route, trainee);
    if (route.object == Object::trial) object = trial_of(trainee);
    const std::map<std::string, std::string> values{{"{" + route.object_parameter + "}", object},
                                                    {"{trial_id}", std::string(32, 'a')},
                                                    {"{account_id}", trainee},
                                                    {"{trial}", "none"},
                                                    {"{name}", "volume.tvol"}};
    for (const auto& [key, value] : values)
      if (const auto at = out.find(key); at != std::string::npos)
        out.replace(at, key.size(), value);
    return std::regex_replace(out, std::regex("\\{[^}]+\\}"), "none");
  }
  http::Response call(const RouteInfo& route, Role role, const std::string& trainee) {
    ++cells_;
    mend();
    const auto headers = role == Role::station ? station("token-1") : as(someone(role));
    // Each role's own token; of other objects, what is tom's is also theirs who teach him.
    const bool own = route.object == Object::api_token && trainee == "tom";
    return ask(request(route.method, address(route, own ? someone(role) : trainee), headers));
  }
  /// What a call before changed of accounts, cohorts and invitations.
  void mend() {
    const auto mended = store_.write([](store::Writing& tx) -> core::Result<void> {
      TRY(tx.query("update accounts set must_change = 0, state = 'active' where must_change = 1"));
      for (const char* who : {"tom", "fay"}) TRY(store::invite(tx, {"c-inv", who}));
      for (const char* who : {"tom", "tia"})
        TRY(store::put_into_cohort(tx, std::string("c-") + who, who, store::CohortPart::trainee,
                                   0));
      return {};
    });
    EXPECT_TRUE(mended);
  }
  int cells_ = 0;
};

TEST_F(Access, EveryCellOfRolesTimesRoutesIsAsTheCatalogueSays) {
  for (const RouteInfo& route : routes()) {
    if (route.open) continue;
    for (const Role role : kRoles) {
      const std::string cell = route.id + " by " + std::string(name(role));
      const auto of = granted(route, role);
      const http::Response mine = call(route, role, "tom"), other = call(route, role, "tia");
      if (!of) {
        EXPECT_EQ(mine.status, 403) << cell << ": " << text(mine);
        EXPECT_EQ(other.status, 403) << cell << ": " << text(other);
        continue;
      }
      EXPECT_NE(mine.status, 401) << cell;
      const std::string refused = mine.status < 400 ? "" : text(mine);  // the trail tells of them
      EXPECT_EQ(refused.find("not allowed for the role"), std::string::npos) << cell;
      EXPECT_EQ(refused.find(kNotYours), std::string::npos) << cell;
      const bool shared = route.object == Object::none || route.object == Object::published_case;
      if (*of != Scope::all && !shared) {
        EXPECT_EQ(other.status, 404) << cell << " of another: " << text(other);
        EXPECT_NE(text(other).find(kNotYours), std::string::npos) << cell << text(other);
      }
    }
  }
  std::printf("cells of roles x routes x {own, other}: %d\n", cells_);
  EXPECT_GT(cells_, 700);
}

TEST_F(Access, WhoseAccountIsSwitchedOffIsNobody) {
  for (const RouteInfo& route : routes()) {
    if (route.open) continue;
    const auto headers = as("rex");
    ASSERT_TRUE(store_.write([](store::Writing& tx) {
      return tx.query("update accounts set state = 'disabled' where id = 'rex'");
    }));
    EXPECT_EQ(ask(request(route.method, address(route, "tom"), headers)).status, 401) << route.id;
  }
}

TEST_F(Access, WhoMustChooseAPasswordMayDoNothingElse) {
  std::set<std::string> free;
  for (const RouteInfo& route : routes()) {
    if (route.open || !granted(route, Role::admin)) continue;
    const auto headers = as("ann");
    ASSERT_TRUE(store_.write([](store::Writing& tx) {
      return tx.query("update accounts set must_change = 1 where id = 'ann'");
    }));
    const int status = ask(request(route.method, address(route, "tom"), headers)).status;
    if (status != 403) free.insert(route.id);
  }
  EXPECT_EQ(free, (std::set<std::string>{"changePassword", "setLanguage", "signOut", "whoAmI"}));
}

/// Blinding: what a trainee and a station can reach at all is this, by hand; a route that is new to
/// them is written here after somebody thought about what it tells.
TEST_F(Access, ATraineeAndAStationReachTheseRoutesAlone) {
  std::map<Role, std::set<std::string>> reach;
  for (const RouteInfo& route : routes())
    for (const Grant& grant : route.who)
      reach[grant.role].insert(
          route.id + (grant.of == Scope::all ? "" : " of " + std::string(name(grant.of))));
  EXPECT_EQ(reach[Role::trainee], (std::set<std::string>{"whoAmI",
                                                         "signOut",
                                                         "changePassword",
                                                         "setLanguage",
                                                         "beginCodes",
                                                         "confirmCodes",
                                                         "endCodes",
                                                         "description",
                                                         "metrics",
                                                         "trials of own",
                                                         "trial of own",
                                                         "trialSignals of own",
                                                         "trialPath of own",
                                                         "trialForceDepth of own",
                                                         "casePreview of own",
                                                         "cohorts of own",
                                                         "curriculaOfAccount of own",
                                                         "assignments of own",
                                                         "assignment of own",
                                                         "trainee of own",
                                                         "trialComments of own",
                                                         "trialRatings of own",
                                                         "ownInvitations of own",
                                                         "acceptInvitation of own",
                                                         "declineInvitation of own",
                                                         "trialReferences of own",
                                                         "referenceWay of own",
                                                         "ownConsent",
                                                         "ownData",
                                                         "sayConsent",
                                                         "savedViews",
                                                         "saveView",
                                                         "removeView",
                                                         "ownNotifications",
                                                         "setNotifications",
                                                         "testNotification",
                                                         "apiTokens",
                                                         "makeApiToken",
                                                         "revokeApiToken of own"}));
  EXPECT_EQ(reach[Role::station], (std::set<std::string>{"whoAmI",
                                                         "description",
                                                         "metrics",
                                                         "cases",
                                                         "case",
                                                         "casePart",
                                                         "casePreview",
                                                         "announceUpload",
                                                         "uploadState",
                                                         "appendUpload",
                                                         "commitUpload",
                                                         "takeTrials",
                                                         "signInAtStation",
                                                         "nextTrial",
                                                         "trialResultAtStation",
                                                         "signOutAtStation",
                                                         "serverMetrics",
                                                         "stationModels",
                                                         "stationModelFile",
                                                         "stationModelThere",
                                                         "time",
                                                         "liveStation",
                                                         "reportStation"}));
  EXPECT_EQ(reach[Role::technician],
            (std::set<std::string>{"whoAmI",           "signOut",
                                   "changePassword",   "beginCodes",
                                   "confirmCodes",     "endCodes",
                                   "description",      "metrics",
                                   "stations",         "makeEnrolmentCode",
                                   "revokeStation",    "serverMetrics",
                                   "backups",          "makeBackup",
                                   "verifyBackup",     "sendModel",
                                   "recallModel",      "sentModel",
                                   "ownConsent",       "sayConsent",
                                   "station",          "live",
                                   "stopStation",      "limitStation",
                                   "ownNotifications", "setNotifications",
                                   "testNotification", "apiTokens",
                                   "makeApiToken",     "revokeApiToken of own",
                                   "ownData",          "setLanguage"}));
}

TEST_F(Access, ARouteThatNamesNobodyIsRefusedToAll) {
  std::vector<RouteInfo> table{
      {.method = "GET",
       .path = "/api/v1/forgotten",
       .id = "forgotten",
       .summary = "",
       .who = {},
       .parameters = {},
       .body = "",
       .answer = "",
       .schemas = {},
       .handle = [](const Call&) -> core::Result<http::Response> { return http::Response{}; }}};
  for (const Role role : kRoles) {
    const auto headers = role == Role::station ? station("token-1") : as(someone(role));
    EXPECT_EQ(answer(backend_, table, request("GET", "/api/v1/forgotten", headers)).status, 403);
  }
}

/// An object grant needs an object, or a handler that answers by Call::of: those are these, and the
/// tests below look at what they answer.
TEST_F(Access, GrantsOfSomeObjectsNameTheObject) {
  std::set<std::string> lists;
  for (const RouteInfo& route : routes())
    for (const Grant& grant : route.who) {
      if (grant.of == Scope::all) continue;
      if (route.object == Object::none) {
        lists.insert(route.id);
        continue;
      }
      EXPECT_TRUE(std::ranges::any_of(route.parameters, [&](const Parameter& p) {
        return p.name == route.object_parameter;
      })) << route.id;
    }
  EXPECT_EQ(lists,
            (std::set<std::string>{
                "trials", "cohorts", "addCohort", "assignments", "addAssignment", "trainees",
                "trainee", "ownInvitations",
                // criteria_test.cpp, assignments_test.cpp and progress_test.cpp look at these
                "addCriteria", "casePassing", "cohortProgress", "curriculumProgress", "expertBound",
                "giveCurriculum", "releaseManyResults", "repeatCurriculumStep",
                // ratings_test.cpp at these
                "ratingAgreement", "ratingRequests"}));
}

TEST_F(Access, ListsHoldWhatOneMaySee) {
  const auto ids = [&](const http::Response& response, const char* list, const char* id) {
    std::set<std::string> out;
    const core::Json answer = json(response);
    for (const auto& entry : answer[list]) out.insert(entry[id].get<std::string>());
    return out;
  };
  using Ids = std::set<std::string>;
  const std::string toms = trial_of("tom"), tias = trial_of("tia");
  EXPECT_EQ(ids(get("tom", "/trials"), "trials", "id"), Ids{toms});
  EXPECT_EQ(ids(get("fay", "/trials"), "trials", "id"), Ids{toms});
  EXPECT_EQ(ids(get("flo", "/trials"), "trials", "id"), Ids{tias});
  EXPECT_EQ(ids(get("dora", "/trials"), "trials", "id"), (Ids{toms, tias}));
  EXPECT_EQ(ids(get("fay", "/cohorts"), "cohorts", "id"), Ids{"c-tom"});
  EXPECT_EQ(ids(get("tia", "/cohorts"), "cohorts", "id"), Ids{"c-tia"});
  EXPECT_EQ(ids(get("fay", "/assignments"), "assignments", "id"), Ids{"a-tom"});
  EXPECT_EQ(ids(get("tia", "/assignments"), "assignments", "id"), Ids{"a-tia"});
  EXPECT_EQ(ids(get("dora", "/cohorts"), "cohorts", "id"), (Ids{"c-inv", "c-tia", "c-tom"}));
}

TEST_F(Access, ATraineeSeesNothingOfATrialWhoseResultsAreHeld) {
  ASSERT_TRUE(store_.write([](store::Writing& tx) {
    return tx.query("update assignments set release = 'held' where study_id = 'a-tom'");
  }));
  EXPECT_EQ(json(get("tom", "/trials"))["trials"].size(), 0u);
  for (const char* tail : {"", "/signals", "/path", "/force-depth"})
    EXPECT_EQ(get("tom", "/trials/" + trial_of("tom") + tail).status, 404) << tail;
  EXPECT_EQ(get("tom", "/cases/" + kCase + "/preview").status, 404);
  EXPECT_EQ(json(get("fay", "/trials"))["trials"].size(), 1u) << "those who teach do";
}

}  // namespace
}  // namespace api
}  // namespace tractus
