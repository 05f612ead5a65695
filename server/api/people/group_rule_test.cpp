/// The rule from groups to roles, and what it does to accounts. Expected outcomes are by hand from
/// the rule below.
#include "server/api/people/group_rule.hpp"

#include "core/try.hpp"
#include "db/store/people/group_rules.hpp"
#include "db/store/people/people.hpp"
#include "db/store/people/subjects.hpp"
#include "server/api/people/group_admission.hpp"
#include "server/api/people/people_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using core::Json;
using store::AccountState;
using testing::PeopleTest;

constexpr const char* kIssuer = "https://hospital.example";
constexpr std::int64_t kOneDay_us = 86'400'000'000;

Json rule_json() {
  return {{"format", "tractus-groups/1"},
          {"absent_days", 30},
          {"lines",
           {{{"group", "surgery-faculty"}, {"role", "faculty"}, {"cohorts", {"c-tom"}}},
            {{"group", "pgy1"}, {"role", "trainee"}, {"cohorts", {"c-tom"}}, {"level", "PGY-1"}},
            {{"group", "pgy2"}, {"role", "trainee"}, {"cohorts", {"c-tia"}}, {"level", "PGY-2"}}}}};
}

TEST(GroupRule, TheFirstLineThatFitsDecidesAndNoLineGivesNothing) {
  const auto rule = GroupRule::from_json(rule_json(), "rule");
  ASSERT_TRUE(rule) << rule.error().what;
  EXPECT_FALSE(rule->grant({}));
  EXPECT_FALSE(rule->grant({"pgy", "pgy11", "PGY1"})) << "a name fits whole and as it is written";
  const auto both = rule->grant({"pgy2", "pgy1"});
  ASSERT_TRUE(both);
  EXPECT_EQ(both->role, Role::trainee);
  EXPECT_EQ(both->level, "PGY-1");
  EXPECT_EQ(both->cohorts, (std::set<std::string>{"c-tom", "c-tia"}));
  EXPECT_EQ(rule->grant({"pgy1", "surgery-faculty"})->role, Role::faculty);
  EXPECT_EQ(rule->grant({"pgy2", "surgery-faculty"})->cohorts, std::set<std::string>{"c-tom"})
      << "a trainee's cohorts are not for the faculty";
}

TEST(GroupRule, IsRefusedByTheFieldThatIsWrong) {
  const auto refused = [](const Json& change, const std::string& says) {
    Json json = rule_json();
    json.merge_patch(change);
    const auto rule = GroupRule::from_json(json, "rule");
    ASSERT_FALSE(rule) << change;
    EXPECT_NE(rule.error().what.find(says), std::string::npos) << rule.error().what;
  };
  refused({{"format", "tractus-groups/2"}}, "format");
  refused({{"more", 1}}, "more");
  refused({{"absent_days", 0}}, "absent_days");
  refused({{"lines", {{{"group", "it"}, {"role", "admin"}}}}}, "administrators are made by hand");
  refused({{"lines", {{{"group", "it"}, {"role", "boss"}}}}}, "/lines/0");
  refused({{"lines", {{{"group", " "}, {"role", "trainee"}}}}}, "group");
  refused({{"lines", {{{"group", "it"}, {"role", "technician"}, {"cohorts", {"c-tom"}}}}}},
          "cohort");
  refused(
      {{"lines", {{{"group", "a"}, {"role", "trainee"}}, {{"group", "a"}, {"role", "trainee"}}}}},
      "a line above");
}

class GroupAdmission : public PeopleTest {
 protected:
  void state_rule(const Json& rule = rule_json()) {
    const auto answer = post("ann", "/group-rules", {{"rule", rule}, {"reason", "a test"}});
    EXPECT_EQ(answer.status, 200) << text(answer);
  }
  core::Result<void> signs_in(const std::string& subject, std::vector<std::string> groups,
                              const std::string& name = "") {
    return store_.write([&](store::Writing& tx) {
      return admit_by_groups(
          tx, {kIssuer, {subject, "", name.empty() ? subject : name, std::move(groups)}, now_});
    });
  }
  std::optional<store::Account> account(const std::string& subject) {
    const auto found = store_.read(
        [&](store::Reading& tx) { return store::account_of_subject(tx, kIssuer, subject); });
    EXPECT_TRUE(found);
    return found ? *found : std::nullopt;
  }
  bool is_in(const std::string& subject, const std::string& cohort) {
    const std::string id = account(subject)->id;
    const auto found =
        store_.read([&](store::Reading& tx) { return store::is_in_cohort(tx, id, cohort); });
    return found && *found;
  }
};

TEST_F(GroupAdmission, MakesAnAccountChangesItAndDisablesALeaver) {
  EXPECT_TRUE(signs_in("una", {"pgy1"}));
  EXPECT_FALSE(account("una")) << "without a rule nobody gets an account";
  state_rule();
  EXPECT_TRUE(signs_in("una", {"cooks"}));
  EXPECT_FALSE(account("una")) << "no line fits";
  EXPECT_TRUE(signs_in("una", {"pgy1"}));
  ASSERT_TRUE(account("una"));
  EXPECT_EQ(account("una")->role, Role::trainee);
  EXPECT_EQ(account("una")->level, "PGY-1");
  EXPECT_FALSE(account("una")->pseudonym.empty());
  EXPECT_TRUE(is_in("una", "c-tom"));

  EXPECT_TRUE(signs_in("una", {"pgy2"}));
  EXPECT_EQ(account("una")->level, "PGY-2");
  EXPECT_FALSE(is_in("una", "c-tom"));
  EXPECT_TRUE(is_in("una", "c-tia"));
  EXPECT_TRUE(signs_in("una", {"surgery-faculty"}));
  EXPECT_EQ(account("una")->role, Role::faculty);
  EXPECT_TRUE(is_in("una", "c-tom"));

  EXPECT_TRUE(signs_in("una", {}));
  EXPECT_EQ(account("una")->state, AccountState::disabled);
  EXPECT_TRUE(signs_in("una", {"pgy1"}));
  EXPECT_EQ(account("una")->state, AccountState::active) << "she came back";
}

TEST_F(GroupAdmission, LeavesAloneWhatAnAdministratorDecided) {
  state_rule();
  EXPECT_TRUE(signs_in("una", {"pgy1"}));
  EXPECT_EQ(
      post("ann", "/accounts/" + account("una")->id + "/state", {{"state", "disabled"}}).status,
      200);
  EXPECT_TRUE(signs_in("una", {"pgy1"}));
  EXPECT_EQ(account("una")->state, AccountState::disabled);
  EXPECT_EQ(post("ann", "/accounts/" + account("una")->id + "/state", {{"state", "active"}}).status,
            200);
  EXPECT_EQ(post("ann", "/accounts/" + account("una")->id + "/role", {{"role", "admin"}}).status,
            200);
  EXPECT_TRUE(signs_in("una", {}));
  EXPECT_EQ(account("una")->state, AccountState::active);
  EXPECT_EQ(account("una")->role, Role::admin);

  const auto linked = store_.write([&](store::Writing& tx) {
    return store::link_subject(tx, {kIssuer, "tom@hospital", "tom", now_, "ann"});
  });
  ASSERT_TRUE(linked);
  EXPECT_TRUE(signs_in("tom@hospital", {}));
  EXPECT_EQ(account("tom@hospital")->state, AccountState::active) << "linked by hand";
}

TEST_F(GroupAdmission, TakesOverNoAccountOfTheSameName) {
  state_rule();
  const auto refused = signs_in("somebody", {"surgery-faculty"}, "tom");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Errc::conflict);
  EXPECT_FALSE(account("somebody"));
}

TEST_F(GroupAdmission, ABadgeOpensNothingOnceTheProviderHasNotVouchedForTooLong) {
  state_rule();
  EXPECT_TRUE(signs_in("una", {"pgy1"}));
  const std::string path = "/accounts/" + account("una")->id + "/badge";
  EXPECT_EQ(post("ann", path, {{"badge", "77"}, {"pin", "2468"}}).status, 200);
  const auto badge = [&] {
    return ask(request("POST", "/api/v1/work/sign-in", station("token-1"),
                       Json{{"badge", "77"}, {"pin", "2468"}}.dump()))
        .status;
  };
  now_ += 30 * kOneDay_us;
  EXPECT_EQ(badge(), 200);
  now_ += 1;
  EXPECT_EQ(badge(), 401);
  EXPECT_EQ(account("una")->state, AccountState::disabled);
}

TEST_F(GroupAdmission, TheRuleIsTheAdministratorsInVersionsAndInTheTrail) {
  EXPECT_EQ(post("dora", "/group-rules", {{"rule", rule_json()}, {"reason", "r"}}).status, 403);
  state_rule();
  state_rule({{"format", "tractus-groups/1"}, {"lines", Json::array()}});
  const Json versions = json(get("ann", "/group-rules"))["versions"];
  ASSERT_EQ(versions.size(), 2u);
  EXPECT_EQ(versions[0]["version"], 2);
  EXPECT_EQ(versions[1]["rule"]["lines"].size(), 3u);
  const Json trail = json(get("ann", "/audit?limit=5"))["rows"];
  EXPECT_EQ(trail[0]["what"], "setGroupRule");
  EXPECT_EQ(trail[0]["who"], "ann");
  Json unknown = rule_json();
  unknown["lines"][0]["cohorts"] = {"no-such-cohort"};
  EXPECT_EQ(post("ann", "/group-rules", {{"rule", unknown}, {"reason", "r"}}).status, 404);
}

}  // namespace
}  // namespace api
}  // namespace tractus
