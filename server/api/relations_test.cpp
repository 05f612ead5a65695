/// Who may bring what together: every route that makes or changes a relation, every role, every end
/// of it, the caller's own and a stranger's.
#include <cstdio>
#include <set>

#include "core/try.hpp"
#include "db/store/people/invitations.hpp"
#include "server/api/access.hpp"
#include "server/api/people/people_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using core::Json;
using testing::kCase;
using testing::PeopleTest;

constexpr const char* kNotYours = "this object does not exist, or you may not access it";

/// How a route is called with a value at one of its ends.
struct Example {
  std::string field;          ///< of the End
  std::string path;           ///< $ stands for the value
  Json body;                  ///< "$" likewise; null: none
  std::string own, stranger;  ///< to those who hold anything: fay of the faculty, tom the trainee
};
using Examples = std::map<std::string, std::vector<Example>>;

Json filled(const Json& body, const std::string& value) {
  std::string text = body.dump();
  for (auto at = text.find('$'); at != std::string::npos; at = text.find('$'))
    text.replace(at, 1, value);
  return Json::parse(text);
}

class Relations : public PeopleTest {
 protected:
  Relations() {
    const auto made = store_.write([](store::Writing& tx) -> core::Result<void> {
      TRY(store::add_cohort(tx, {"c-inv", "inviting", 0, "ann"}));
      for (const char* id : {"through", "running"}) {
        const store::Study study{.id = id, .title = "", .ordering = store::CaseOrder::random};
        auto added = TRY(store::add_study(tx, study, {kCase}, {"rex", 1}));
        TRY(store::add_participant(tx, added, {.name = "P1"}, {kCase}, {"rex", 1}));
      }
      auto done = tx.query("update study_slots set state = 'recorded' where study_id = 'through'");
      return done ? core::Result<void>() : done.error();
    });
    EXPECT_TRUE(made) << made.error().what;
  }
  /// As PeopleTest made it, whatever was brought together since.
  void mend() {
    const auto mended = store_.write([](store::Writing& tx) -> core::Result<void> {
      for (const char* sql : {"delete from cohort_people", "delete from cohort_invitations"})
        TRY(tx.query(sql));
      for (const auto& [cohort, who, part] :
           std::vector<std::tuple<const char*, const char*, store::CohortPart>>{
               {"c-tom", "fay", store::CohortPart::faculty},
               {"c-tom", "tom", store::CohortPart::trainee},
               {"c-tia", "flo", store::CohortPart::faculty},
               {"c-tia", "tia", store::CohortPart::trainee}})
        TRY(store::put_into_cohort(tx, cohort, who, part, 0));
      for (const char* who : {"tom", "fay"}) TRY(store::invite(tx, {"c-inv", who}));
      return {};
    });
    EXPECT_TRUE(mended);
  }
  Examples examples() const {
    const Json name{{"name", "$"}}, cases = {{{"case", kCase}}};
    const Json to_tom{{"title", "x"}, {"people", {"tom"}}, {"cases", cases}};
    const auto assignment = [&](const std::string& field, const Json& value) {
      Json out = to_tom;
      out[field] = value;
      return out;
    };
    Json protocol = assignment("protocol", "$");
    protocol.erase("cases");
    const std::string bound = "/criteria/bound?metric=path_length&side=at_most&method=youden&";
    return {
        {"putIntoCohort", {{"/name", "/cohorts/c-tom/people", name, "tom", "tia"}}},
        {"takeFromCohort", {{"account_id", "/cohorts/c-tom/people/$", {}, "tom", "tia"}}},
        {"inviteIntoCohort", {{"/name", "/cohorts/c-tom/invitations", name, "tom", "tia"}}},
        {"withdrawInvitation", {{"name", "/cohorts/c-tom/invitations/$", {}, "tom", "tia"}}},
        {"acceptInvitation", {{"cohort", "/session/invitations/$/accept", {}, "c-inv", "c-tia"}}},
        {"declineInvitation", {{"cohort", "/session/invitations/$/decline", {}, "c-inv", "c-tia"}}},
        {"assignPerson", {{"/name", "/assignments/a-tom/people", name, "tom", "tia"}}},
        {"freeAssignedPerson",
         {{"account_id", "/assignments/a-tom/people/$/free", Json::object(), "tom", "tia"}}},
        {"addAssignment",
         {{"/cohort", "/assignments", assignment("cohort", "$"), "c-tom", "c-tia"},
          {"/people/*", "/assignments", assignment("people", {"$"}), "tom", "tia"},
          {"/cases/*/case", "/assignments", assignment("cases", {{{"case", "$"}}}), kCase, kCase},
          {"/protocol", "/assignments", protocol, "through", "running"}}},
        {"sayConsent",
         {{"/study", "/session/consent", {{"study", "$"}, {"tier", "none"}}, "a-tom", "a-tia"}}},
        {"noteConsent",
         {{"/account",
           "/consents",
           {{"account", "$"}, {"tier", "none"}, {"basis", "x"}},
           "tom",
           "tia"},
          {"/study",
           "/consents",
           {{"study", "$"}, {"participant", "P1"}, {"tier", "none"}, {"basis", "x"}},
           "through",
           "running"}}},
        {"sendModel",
         {{"id", "/lab/models/$/send", {{"all", true}}, "m1", "m2"},
          {"/stations/*", "/lab/models/m1/send", {{"stations", {"$"}}}, "s1", "s2"}}},
        {"recallModel",
         {{"id", "/lab/models/$/stations/s1", {}, "m1", "m2"},
          {"station_id", "/lab/models/m1/stations/$", {}, "s1", "s2"}}},
        {"importAccounts",
         {{"/cohort",
           "/accounts/import",
           {{"csv", "name\nx"}, {"cohort", "$"}},
           "c-tom",
           "c-tia"}}},
        {"setGroupRule",
         {{"/rule/lines/*/cohorts/*",
           "/group-rules",
           {{"rule",
             {{"format", "tractus-groups/1"},
              {"lines", {{{"group", "g"}, {"role", "trainee"}, {"cohorts", {"$"}}}}}}},
            {"reason", "r"}},
           "c-tom",
           "c-tia"}}},
        {"changeAccounts",
         {{"/accounts/*/id",
           "/accounts/change",
           {{"accounts", {{{"id", "$"}}}}, {"level", "x"}},
           "tom",
           "tia"},
          {"/cohort",
           "/accounts/change",
           {{"accounts", {{{"id", "flo"}}}}, {"cohort", "$"}},
           "c-tom",
           "c-tia"}}},
        {"releaseManyResults",
         {{"/assignments/*",
           "/assignment-releases",
           {{"assignments", {"$"}}, {"release", "released"}},
           "a-tom",
           "a-tia"}}},
        {"addCriteria",
         {{"/case", "/criteria", {{"case", "$"}, {"criteria", "none"}}, kCase, kCase},
          {"/assignment",
           "/criteria",
           {{"assignment", "$"}, {"criteria", "none"}},
           "a-tom",
           "a-tia"}}},
        {"expertBound",
         {{"experts", bound + "experts=$", {}, "c-tom", "c-tia"},
          {"novices", bound + "experts=c-tom&novices=$", {}, "c-tom", "c-tia"}}},
        {"addCurriculum",
         {{"/steps/*/cases/*/case",
           "/curricula",
           {{"title", "x"}, {"steps", {{{"cases", {{{"case", "$"}}}}}}}},
           kCase,
           kCase}}},
        {"giveCurriculum",
         {{"/cohort", "/curricula/none/cohorts", {{"cohort", "$"}}, "c-tom", "c-tia"}}},
        {"repeatCurriculumStep",
         {{"account_id", "/curricula/none/people/$/again", {{"step", "a"}}, "tom", "tia"}}},
        {"linkLtiPerson",
         {{"/account", "/lti/platforms/none/people", {{"account", "$"}}, "tom", "tia"}}},
        {"referenceWay",
         {{"reference",
           "/trials/" + trial_of("tom") + "/references/$",
           {},
           trial_of("tom"),
           trial_of("tia")}}},
    };
  }
  /// The policy, by hand: what is whose. Everything else is a stranger's.
  static bool holds(Role role, Scope of, Object object, const std::string& name) {
    // Faculty leads assignments and is assigned none.
    if (role == Role::faculty && object == Object::assignment)
      return of == Scope::cohort && name == "a-tom";
    using Held = std::set<std::pair<Object, std::string>>;
    static const std::map<Role, Held> held{
        {Role::faculty,
         {{Object::person, "tom"},
          {Object::account, "tom"},
          {Object::cohort, "c-tom"},
          {Object::study, "through"},
          {Object::invitation, "c-inv"}}},
        {Role::trainee, {{Object::assignment, "a-tom"}, {Object::invitation, "c-inv"}}}};
    const auto found = held.find(role);
    return found != held.end() && found->second.contains({object, name});
  }
  static std::string someone(Role role) {
    const std::map<Role, std::string> names{{Role::admin, "ann"},      {Role::director, "dora"},
                                            {Role::faculty, "fay"},    {Role::researcher, "rex"},
                                            {Role::technician, "ted"}, {Role::trainee, "tom"}};
    return names.at(role);
  }
  http::Response call(const RouteInfo& route, Role role, const Example& example,
                      const std::string& value) {
    mend();
    std::string path = "/api/v1" + example.path;
    if (const auto at = path.find('$'); at != std::string::npos) path.replace(at, 1, value);
    return ask(request(route.method, path,
                       role == Role::station ? station("token-1") : as(someone(role)),
                       example.body.is_null() ? "" : filled(example.body, value).dump()));
  }
  /// 403: the role may not; 404: a stranger's; 0: it may.
  static int refusal_due(const RouteInfo& route, Role role, const End& end,
                         const std::string& value) {
    const auto of = granted(route, role), at_end = granted(end.who, role);
    if (!of) return 403;
    const bool object_too = route.object != Object::none && route.object_parameter == end.field;
    if (object_too && *of != Scope::all && !holds(role, *of, route.object, value)) return 404;
    if (!at_end) return 403;
    return *at_end == Scope::all || holds(role, *at_end, end.object, value) ? 0 : 404;
  }
  void check_cell(const RouteInfo& route, Role role, const End& end, const Example& example,
                  const std::string& value) {
    const http::Response response = call(route, role, example, value);
    const int due = refusal_due(route, role, end, value);
    const std::string cell =
        route.id + " by " + std::string(name(role)) + ", " + end.field + " = " + value;
    if (due != 0) {
      EXPECT_EQ(response.status, due) << cell << ": " << text(response);
      if (due == 404) {
        EXPECT_NE(text(response).find(kNotYours), std::string::npos) << cell << text(response);
      }
      return;
    }
    const std::string said = response.status < 400 ? "" : text(response);
    EXPECT_EQ(said.find(kNotYours), std::string::npos) << cell << ": " << said;
    EXPECT_EQ(said.find("not allowed for the role"), std::string::npos) << cell << ": " << said;
    EXPECT_NE(response.status, 401) << cell;
  }
};

TEST_F(Relations, EveryCellOfRoutesTimesRolesTimesEndsIsAsThePolicySays) {
  int cells = 0;
  const Examples all = examples();
  for (const RouteInfo& route : routes()) {
    if (route.ends.empty()) continue;
    const auto found = all.find(route.id);
    ASSERT_NE(found, all.end()) << route.id << " has no example here";
    for (const End& end : route.ends) {
      const auto example = std::ranges::find(found->second, end.field, &Example::field);
      ASSERT_NE(example, found->second.end()) << route.id << " has no example of " << end.field;
      for (const Role role : kRoles)
        for (const std::string& value : {example->own, example->stranger}) {
          check_cell(route, role, end, *example, value);
          ++cells;
        }
    }
  }
  std::printf("cells of relation routes x ends x roles x {own, stranger's}: %d\n", cells);
  EXPECT_EQ(cells, 33 * 7 * 2);
}

/// A route that is new and changes something names the other ends of what it brings together, or is
/// written here after somebody thought about it: it is of its caller and of its one object alone,
/// or of things that everybody who may call it may have all of.
TEST_F(Relations, ARouteThatChangesSomethingNamesEveryEndOrIsOfOneObject) {
  const std::set<std::string> of_one_object{
      // the caller's own session, password, codes and language
      "signIn", "signOut", "changePassword", "beginCodes", "confirmCodes", "endCodes",
      "setLanguage",
      // the caller's own saved views
      "saveView", "removeView",
      // the caller's own API tokens; an administrator revokes others'
      "makeApiToken", "revokeApiToken",
      // what the caller is told of, and the server's webhooks, by administrators
      "setNotifications", "testNotification", "addWebhook", "removeWebhook", "testWebhook",
      // learning platforms, by administrators; a launch is of the person whom it names
      "addLtiPlatform", "removeLtiPlatform", "ltiLoginForm", "ltiLaunch",
      // the learning record store, by administrators
      "setRecordStore", "removeRecordStore",
      // an account, by administrators; a badge also by those who teach its bearer
      "eraseAccount", "addAccount", "setAccountState", "setAccountRole", "resetPassword",
      "setBadge", "linkSubject",
      // a cohort that its maker leads
      "addCohort",
      // an assignment, and a trial that must be one of it
      "releaseResults", "setDue", "markAssignedTrialInvalid",
      // a study and its own participants and trials, by researchers, who have all studies
      "makeStudy", "enrolParticipant", "setStudyState", "setParticipantState", "releaseParticipant",
      "markTrialInvalid",
      // a trial and its caller; as an example of its own case
      "addComment", "removeComment", "setReference", "askForRating", "withdrawRatingRequest",
      "addRating",
      // a station, by itself or by those who have all stations
      "takeTrials", "signInAtStation", "nextTrial", "trialResultAtStation", "signOutAtStation",
      "announceUpload", "appendUpload", "commitUpload", "reportStation", "stationModelThere",
      "makeEnrolmentCode", "enrolStation", "revokeStation", "stopStation", "limitStation",
      // what all who may call these have all of: volumes, cases, scenarios, models, measurements,
      // rubrics
      "addVolume", "storeSeries", "findPacsStudies", "pacsSeries", "importPacsSeries",
      "releaseVolume", "refuseVolume", "planTract", "certifyTract", "makeCase", "retireCase",
      "checkScenario", "addScenario", "publishScenario", "addModel", "addMeasurements",
      "checkEffect", "startDiagnosis", "startComparison", "startFit", "stopLabRun", "publishLabRun",
      "addRubric",
      // released trials alone (db/store/cohort/released.hpp)
      "lockAnalysisPlan", "analyseCohort", "stopCohortAnalysis",
      // the server's own
      "previewRetention", "setRetention", "makeBackup", "verifyBackup"};
  std::set<std::string> unnamed;
  for (const RouteInfo& route : routes())
    if (route.method != "GET" && route.ends.empty()) unnamed.insert(route.id);
  EXPECT_EQ(unnamed, of_one_object);
}

/// A relation has two ends: the route's object or the caller, and what it declares.
TEST_F(Relations, EveryEndIsAnArgumentOrAFieldOfTheBody) {
  for (const RouteInfo& route : routes())
    for (const End& end : route.ends) {
      const bool in_body = end.field.starts_with('/');
      EXPECT_TRUE(
          in_body ? !route.body.empty()
                  : std::ranges::any_of(route.parameters,
                                        [&](const Parameter& p) { return p.name == end.field; }))
          << route.id << " " << end.field;
      EXPECT_NE(end.object, Object::none) << route.id;
      EXPECT_FALSE(end.who.empty()) << route.id;
    }
}

TEST_F(Relations, FacultyReachesNoStrangerByPuttingThemIntoACohort) {
  EXPECT_EQ(post("fay", "/cohorts/c-tom/people", {{"name", "tia"}}).status, 404);
  EXPECT_EQ(get("fay", "/trials/" + trial_of("tia") + "/comments").status, 404);
  EXPECT_EQ(post("fay", "/accounts/tia/badge", {{"badge", "1"}, {"pin", "2468"}}).status, 404);
  const std::string answer = text(post("fay", "/cohorts/c-tom/people", {{"name", "tia"}}));
  EXPECT_EQ(text(post("fay", "/cohorts/c-tom/people", {{"name", "nobody"}})), answer)
      << "whether there is such an account is not told";
}

TEST_F(Relations, DirectorsAndAdministratorsPutAnybody) {
  EXPECT_EQ(post("dora", "/cohorts/c-tom/people", {{"name", "tia"}}).status, 200);
  EXPECT_EQ(post("ann", "/cohorts/c-tia/people", {{"name", "tom"}}).status, 200);
  EXPECT_EQ(get("fay", "/trials/" + trial_of("tia") + "/comments").status, 200);
}

TEST_F(Relations, WhoIsInvitedDecides) {
  const auto invited = [&](const char* who) {
    return json(get(who, "/session/invitations"))["invitations"];
  };
  const auto says = [&](const char* who, const std::string& stamp) {
    return ask(request("POST", "/api/v1/session/invitations/c-tom/" + stamp, as(who))).status;
  };
  const auto sees = [&] {
    return get("fay", "/trials/" + trial_of("tia") + "/comments").status == 200;
  };
  const auto asked = post("fay", "/cohorts/c-tom/invitations", {{"name", "tia"}});
  ASSERT_EQ(asked.status, 201) << text(asked);
  EXPECT_EQ(json(asked)["invitations"][0]["name"], "tia");
  EXPECT_FALSE(sees()) << "an invitation alone opens nothing";
  ASSERT_EQ(invited("tia").size(), 1u);
  EXPECT_EQ(invited("tia")[0]["cohort_id"], "c-tom");
  EXPECT_EQ(invited("tia")[0]["made_by"], "fay");
  EXPECT_EQ(invited("tom").size(), 0u);
  EXPECT_EQ(says("tom", "accept"), 404) << "it is tia's";

  EXPECT_EQ(says("tia", "decline"), 200);
  EXPECT_EQ(says("tia", "accept"), 404);
  EXPECT_FALSE(sees());

  EXPECT_EQ(post("fay", "/cohorts/c-tom/invitations", {{"name", "tia"}}).status, 201);
  EXPECT_EQ(says("tia", "accept"), 200);
  EXPECT_TRUE(sees());
  EXPECT_EQ(invited("tia").size(), 0u);
  const Json assignments = json(get("tia", "/assignments"))["assignments"];
  EXPECT_EQ(assignments.size(), 2u) << "the cohort's too: " << assignments.dump();
}

TEST_F(Relations, AnInvitationTellsNotWhetherThereIsSuchAnAccount) {
  EXPECT_EQ(post("fay", "/cohorts/c-tom/invitations", {{"name", "nobody"}}).status, 201);
  EXPECT_EQ(post("fay", "/cohorts/c-tom/invitations", {{"name", "nobody"}}).status, 201);
  const auto gone = ask(request("DELETE", "/api/v1/cohorts/c-tom/invitations/nobody", as("fay")));
  EXPECT_EQ(gone.status, 200);
  EXPECT_EQ(json(gone)["invitations"].size(), 0u);
  EXPECT_EQ(post("fay", "/cohorts/c-tia/invitations", {{"name", "tom"}}).status, 404)
      << "another's cohort";
}

/// An example is shown to all who did a trial on its case; whose it is, to those who may see them.
TEST_F(Relations, AnExampleNamesNobodyToStrangers) {
  ASSERT_TRUE(store_.write([](store::Writing& tx) {
    return tx.query("update trials set operator_name = 'Tia Doe' where id = ?", {trial_of("tia")});
  }));
  ASSERT_EQ(post("flo", "/trials/" + trial_of("tia") + "/reference", {{"reference", true}}).status,
            200);
  const auto told = [&](const char* who) {
    return json(get(who, "/trials/" + trial_of("tom") + "/references"))["trials"][0]["operator"];
  };
  EXPECT_EQ(told("fay"), "");
  EXPECT_EQ(told("tom"), "");
  EXPECT_EQ(told("dora"), "Tia Doe");
}

}  // namespace
}  // namespace api
}  // namespace tractus
