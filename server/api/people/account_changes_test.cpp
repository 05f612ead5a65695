/// Many accounts changed at once.
#include "server/api/people/people_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using core::Json;
using testing::PeopleTest;

class AccountChanges : public PeopleTest {
 protected:
  static Json both() { return {{{"id", "tom"}}, {{"id", "tia"}}}; }
  Json change(const Json& body, int status = 200) {
    const auto answer = post("ann", "/accounts/change", body);
    EXPECT_EQ(answer.status, status) << text(answer);
    return json(answer);
  }
  Json account(const std::string& id) {
    const Json list = json(get("ann", "/accounts"))["accounts"];
    for (const Json& one : list)
      if (one["id"] == id) return one;
    return {};
  }
};

TEST_F(AccountChanges, SetsLevelRoleAndCohortOfAll) {
  change({{"accounts", both()}, {"level", "PGY-3"}, {"cohort", "c-tom"}});
  EXPECT_EQ(account("tom")["level"], "PGY-3");
  EXPECT_EQ(account("tia")["level"], "PGY-3");
  EXPECT_EQ(json(get("ann", "/cohorts/c-tom"))["trainees"], 2);
  EXPECT_EQ(json(get("tia", "/assignments"))["assignments"].size(), 2u) << "the cohort's too";
  change({{"accounts", both()}, {"role", "researcher"}});
  EXPECT_EQ(account("tia")["role"], "researcher");
}

TEST_F(AccountChanges, SetsABadgeAndAPinOfEachAndKeepsWhatIsNotNamed) {
  change({{"accounts",
           {{{"id", "tom"}, {"badge", "B1"}, {"pin", "2468"}}, {{"id", "tia"}, {"badge", "B2"}}}}});
  EXPECT_EQ(account("tom")["badge"], "B1");
  EXPECT_EQ(account("tom")["has_pin"], true);
  EXPECT_EQ(account("tia")["badge"], "B2");
  change({{"accounts", {{{"id", "tom"}}}}, {"level", "x"}});
  EXPECT_EQ(account("tom")["badge"], "B1");
  EXPECT_EQ(account("tom")["has_pin"], true);
}

TEST_F(AccountChanges, GivesFirstPasswordsWhichMustBeChanged) {
  const Json made = change({{"accounts", both()}, {"new_passwords", true}})["accounts"];
  ASSERT_EQ(made.size(), 2u);
  for (const Json& one : made) {
    const auto in = sign_in_as(one["account"]["name"], one["password"]);
    EXPECT_EQ(in.status, 200) << text(in);
    EXPECT_EQ(json(in)["must_change"], true);
  }
}

TEST_F(AccountChanges, OneRefusalChangesNobody) {
  const Json answer = change(
      {{"accounts", {{{"id", "tom"}, {"badge", "B1"}}, {{"id", "tia"}, {"badge", "B1"}}}}}, 409);
  EXPECT_NE(answer["error"].get<std::string>().find("tia: badge"), std::string::npos) << answer;
  EXPECT_TRUE(account("tom")["badge"].is_null());
  change({{"accounts", {{{"id", "tom"}}, {{"id", "nobody"}}}}, {"level", "x"}}, 404);
  EXPECT_EQ(account("tom")["level"], "");
  change({{"accounts", {{{"id", "dora"}}}}, {"cohort", "c-tom"}}, 400);
}

TEST_F(AccountChanges, RefusesWhatLocksTheCallerOut) {
  for (const Json& body : {Json{{"role", "trainee"}}, Json{{"new_passwords", true}}}) {
    Json asked = body;
    asked["accounts"] = {{{"id", "ann"}}};
    change(asked, 403);
  }
  EXPECT_EQ(account("ann")["role"], "admin");
}

TEST_F(AccountChanges, RefusesAListThatIsNone) {
  for (const Json& body : {Json{{"accounts", Json::array()}}, Json{{"accounts", "tom"}},
                           Json{{"level", "x"}}, Json{{"accounts", both()}, {"role", "station"}},
                           Json{{"accounts", both()}, {"new_passwords", 1}},
                           Json{{"accounts", {{{"id", "tom"}, {"pin", "12"}}}}}})
    change(body, 400);
}

}  // namespace
}  // namespace api
}  // namespace tractus
