/// No route of studies acts on an assignment, and none of assignments on a study.
#include <regex>

#include "core/try.hpp"
#include "server/api/people/people_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using testing::PeopleTest;

class StudyKinds : public PeopleTest {
 protected:
  StudyKinds() {
    const auto made = store_.write([](store::Writing& tx) -> core::Result<void> {
      const store::Study study{.id = "a-study", .title = "", .ordering = store::CaseOrder::random};
      const store::AuditStamp stamp{"rex", 1};
      auto id = TRY(store::add_study(tx, study, {testing::kCase}, stamp));
      return store::add_participant(tx, id, {.name = "P-tom"}, {testing::kCase}, stamp);
    });
    EXPECT_TRUE(made);
  }

  /// A body that the route takes.
  static std::string body_of(const RouteInfo& route) {
    const std::map<std::string, core::Json> bodies{
        {"StateChange", {{"state", "paused"}}}, {"Reason", {{"reason", "phone rang"}}},
        {"Nothing", core::Json::object()},      {"NewParticipant", {{"name", "P9"}}},
        {"Release", {{"release", "released"}}}, {"Due", {{"due_utc_us", nullptr}}},
        {"PersonNamed", {{"name", "tia"}}},
    };
    const auto found = bodies.find(route.body);
    EXPECT_TRUE(route.body.empty() || found != bodies.end()) << route.id << " takes " << route.body;
    return found == bodies.end() ? "" : found->second.dump();
  }
  http::Response call(const RouteInfo& route, const std::string& series) {
    std::string path = std::regex_replace(route.path, std::regex("\\{id\\}"), series);
    path = std::regex_replace(path, std::regex("\\{name\\}"), "P-tom");
    path = std::regex_replace(path, std::regex("\\{account_id\\}"), "tom");
    path = std::regex_replace(path, std::regex("\\{trial_id\\}"), trial_of("tom"));
    const bool by_station = route.who.front().role == Role::station;
    return ask(
        request(route.method, path, by_station ? station("token-1") : as("ann"), body_of(route)));
  }
  /// Everything that the tables of studies hold.
  std::string state() {
    std::string out;
    const auto read = store_.read([&](store::Reading& tx) -> core::Result<void> {
      for (const char* sql : {"select id, state from studies order by id",
                              "select name, state from study_participants order by study_id, name",
                              "select id, state from study_slots order by id",
                              "select trial_id, state from study_trials order by trial_id"}) {
        auto rows = TRY(tx.query(sql));
        for (const auto& row : rows) out += row.text(0) + " " + row.text(1) + "\n";
      }
      return {};
    });
    EXPECT_TRUE(read);
    return out;
  }
  void expect_not_found(const std::string& under, const std::string& series, int at_least) {
    int routes_seen = 0;
    const std::string before = state();
    for (const RouteInfo& route : routes()) {
      if (route.path.find("/" + under + "/{id}") == std::string::npos) continue;
      const http::Response response = call(route, series);
      EXPECT_EQ(response.status, 404) << route.id << ": " << text(response);
      ++routes_seen;
    }
    EXPECT_GE(routes_seen, at_least);
    EXPECT_EQ(state(), before);
  }
};

TEST_F(StudyKinds, ARouteOfStudiesFindsNoAssignment) { expect_not_found("studies", "a-tom", 8); }

TEST_F(StudyKinds, ARouteOfAssignmentsFindsNoStudy) {
  expect_not_found("assignments", "a-study", 6);
}

TEST_F(StudyKinds, AConsentFormIsOfAParticipantOfAStudyAlone) {
  const core::Json form{
      {"study", "a-tom"}, {"participant", "P-tom"}, {"tier", "full"}, {"basis", "folder 3"}};
  EXPECT_EQ(post("rex", "/consents", form).status, 404);
  core::Json of_study = form;
  of_study["study"] = "a-study";
  EXPECT_EQ(post("rex", "/consents", of_study).status, 204);
}

TEST_F(StudyKinds, TheProtocolOfAnAssignmentIsAStudy) {
  const core::Json plan{{"title", "x"}, {"people", {"tom"}}, {"protocol", "a-tia"}};
  EXPECT_EQ(post("ann", "/assignments", plan).status, 404);
}

}  // namespace
}  // namespace api
}  // namespace tractus
