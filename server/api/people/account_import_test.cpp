/// Accounts of a class from one CSV.
#include "server/api/people/people_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using core::Json;
using testing::PeopleTest;

class AccountImport : public PeopleTest {
 protected:
  Json import(const std::string& csv, bool apply, const std::string& cohort = "",
              int status = 200) {
    Json body{{"csv", csv}, {"apply", apply}};
    if (!cohort.empty()) body["cohort"] = cohort;
    const auto answer = post("ann", "/accounts/import", body);
    EXPECT_EQ(answer.status, status) << text(answer);
    return json(answer);
  }
  std::size_t accounts() { return json(get("ann", "/accounts"))["accounts"].size(); }
  std::string error_of(const std::string& row) {
    const Json rows = import("name,role,badge,pin\n" + row, false)["rows"];
    return rows[0]["error"].is_null() ? "" : rows[0]["error"].get<std::string>();
  }
};

TEST_F(AccountImport, ShowsWhatItWouldMakeAndMakesNothing) {
  const std::size_t before = accounts();
  const Json shown = import("name,badge\r\n\"Berg, Ida\",B-1\r\nUlf,\r\n\r\n", false);
  EXPECT_EQ(shown["applied"], false);
  ASSERT_EQ(shown["rows"].size(), 2u);
  EXPECT_EQ(shown["rows"][0]["name"], "Berg, Ida");
  EXPECT_EQ(shown["rows"][0]["role"], "trainee");
  EXPECT_EQ(shown["rows"][0]["line"], 2);
  EXPECT_TRUE(shown["rows"][0]["error"].is_null());
  EXPECT_TRUE(shown["rows"][0]["password"].is_null());
  EXPECT_TRUE(shown["rows"][1]["badge"].is_null());
  EXPECT_EQ(accounts(), before);
}

TEST_F(AccountImport, MakesAllAccountsInTheCohortAndEachCanSignIn) {
  const Json made = import("name,pin\nIda,1234\nUlf,\n", true, "c-tom", 201);
  EXPECT_EQ(made["applied"], true);
  for (const Json& row : made["rows"]) {
    const auto in = sign_in_as(row["name"], row["password"]);
    EXPECT_EQ(in.status, 200) << row["name"];
    EXPECT_EQ(json(in)["must_change"], true);
  }
  // fay leads the cohort, whose assignment the two have now beside tom.
  EXPECT_EQ(json(get("fay", "/assignments/a-tom"))["people"], 3);
}

TEST_F(AccountImport, TakesTheLevelOfTraining) {
  const Json made = import("level,name\nPGY-2,Ida\n", true, "c-tom", 201)["rows"][0];
  EXPECT_EQ(made["level"], "PGY-2");
  const Json list = json(get("ann", "/accounts"))["accounts"];
  const auto ida =
      std::ranges::find(list, Json("Ida"), [](const Json& one) { return one["name"]; });
  ASSERT_NE(ida, list.end());
  EXPECT_EQ((*ida)["level"], "PGY-2");
  EXPECT_EQ((*ida)["id"], made["id"]);
  const auto levels = store_.read([](store::Reading& tx) {
    return tx.query(
        "select level from study_participants where study_id = 'a-tom' and level <> ''");
  });
  ASSERT_EQ(levels->size(), 1u) << "the cohort's assignment has taken it";
  EXPECT_EQ(levels->front().text(0), "PGY-2");
}

TEST_F(AccountImport, OneFaultyRowKeepsAllOthersOut) {
  const std::size_t before = accounts();
  const Json shown = import("name,pin\nIda,1234\nUlf,12\n", true);
  EXPECT_EQ(shown["applied"], false);
  EXPECT_TRUE(shown["rows"][0]["error"].is_null());
  EXPECT_NE(shown["rows"][1]["error"].get<std::string>().find("4 to 12 digits"), std::string::npos);
  EXPECT_EQ(accounts(), before);
}

TEST_F(AccountImport, SaysOfEachRowWhatIsWrong) {
  EXPECT_NE(error_of(",,,\n").find("name"), std::string::npos);
  EXPECT_NE(error_of("Ida,surgeon,,\n").find("role"), std::string::npos);
  EXPECT_NE(error_of("Ida,station,,\n").find("role"), std::string::npos);
  EXPECT_NE(error_of("Ida,,a badge,\n").find("badge"), std::string::npos);
  EXPECT_NE(error_of("Ida,,,12a4\n").find("4 to 12 digits"), std::string::npos);
  EXPECT_EQ(error_of("Ida,trainee\n"), "has 2 cells, the first line has 4");
  EXPECT_EQ(error_of("tom,,,\n"), "an account has this name already");
  const Json twice = import("name,badge\nIda,B1\nIda,B2\nUlf,B1\n", false)["rows"];
  EXPECT_EQ(twice[1]["error"], "this name stands in an earlier row");
  EXPECT_EQ(twice[2]["error"], "this badge stands in an earlier row");
  const Json rex = import("name,role\nR,researcher\n", false, "c-tom")["rows"];
  EXPECT_EQ(rex[0]["error"], "only trainees and faculty can join a cohort");
}

TEST_F(AccountImport, RefusesAListThatIsNone) {
  for (const char* csv :
       {"", "name\n", "badge\nB1\n", "name,colour\nIda,1\n", "name,name\na,b\n", "name\n\"Ida\n"})
    import(csv, true, "", 400);
  EXPECT_EQ(post("ann", "/accounts/import", {{"csv", "name\nIda"}, {"apply", "yes"}}).status, 400);
}

TEST_F(AccountImport, IsForAdministratorsAndOfTraineesForDirectors) {
  for (const char* other : {"fay", "rex", "ted", "tom"})
    EXPECT_EQ(post(other, "/accounts/import", {{"csv", "name\nIda"}}).status, 403) << other;
  const std::size_t before = accounts();
  for (const char* role : {"admin", "director", "faculty", "researcher", "technician"}) {
    const auto shown =
        post("dora", "/accounts/import",
             {{"csv", std::string("name,role\nIda,\nUlf,") + role + "\n"}, {"apply", true}});
    ASSERT_EQ(shown.status, 200) << text(shown);
    EXPECT_TRUE(json(shown)["rows"][0]["error"].is_null()) << role;
    EXPECT_FALSE(json(shown)["rows"][1]["error"].is_null()) << role;
  }
  EXPECT_EQ(accounts(), before);
  const Json cohort = json(post("dora", "/cohorts", {{"name", "Residents 2027"}}));
  const auto made = post("dora", "/accounts/import",
                         {{"csv", "name\nIda\n"}, {"apply", true}, {"cohort", cohort["id"]}});
  EXPECT_EQ(made.status, 201) << text(made);
  EXPECT_EQ(accounts(), before + 1);
  EXPECT_EQ(json(get("ann", "/cohorts/" + cohort["id"].get<std::string>()))["trainees"], 1);
}

}  // namespace
}  // namespace api
}  // namespace tractus
