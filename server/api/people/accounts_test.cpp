#include "core/try.hpp"
#include "db/store/operations/audit.hpp"
#include "server/api/people/oidc.hpp"
#include "server/api/people/people_test_support.hpp"
#include "server/api/people/totp.hpp"

namespace tractus {
namespace api {
namespace {
using testing::kPassword;
using testing::PeopleTest;

class Accounts : public PeopleTest {
 protected:
  http::Response sign_in_with_code(const std::string& name, const std::string& code) {
    return ask(request("POST", "/api/v1/session", {{"content-type", "application/json"}},
                       core::Json{{"name", name}, {"password", kPassword}, {"code", code}}.dump()));
  }
  std::string code_of(const std::string& secret, std::int64_t ahead) {
    return hotp(core::bytes_of(secret),
                static_cast<std::uint64_t>(now_ / 1'000'000 / kTotpStep_s + ahead));
  }
  /// The secret of codes that are asked for from now on.
  std::string codes_of(const std::string& id) {
    const std::string secret = "12345678901234567890";  // of RFC 6238, appendix B
    EXPECT_TRUE(store_.write([&](store::Writing& tx) -> core::Result<void> {
      auto account = TRY(store::account_of(tx, id));
      account->totp_secret = backend_.secrets.sealed(secret);
      account->totp_confirmed = true;
      return store::set_account(tx, *account);
    }));
    return secret;
  }
};

TEST_F(Accounts, AreMadeWithAPasswordThatMustBeChangedAtOnce) {
  const auto made = post("ann", "/accounts", {{"name", "new"}, {"role", "trainee"}});
  ASSERT_EQ(made.status, 201) << text(made);
  const std::string password = json(made)["password"];
  EXPECT_GE(password.size(), 16u);
  const auto in = sign_in_as("new", password);
  ASSERT_EQ(in.status, 200);
  EXPECT_EQ(json(in)["must_change"], true);
  const std::string set(in.header("Set-Cookie"));
  const std::map<std::string, std::string> own{{"cookie", set.substr(0, set.find(';'))},
                                               {"x-tractus", "1"}};
  EXPECT_EQ(ask(request("GET", "/api/v1/trials", own)).status, 403);
  const auto change = [&](const std::string& to) {
    return ask(request("POST", "/api/v1/session/password", own,
                       core::Json{{"old", password}, {"new", to}}.dump()))
        .status;
  };
  EXPECT_EQ(change("short"), 400);
  EXPECT_EQ(change(password), 400) << "the same again";
  EXPECT_EQ(change("a longer password"), 204);
  EXPECT_EQ(ask(request("GET", "/api/v1/trials", own)).status, 200);
  EXPECT_EQ(sign_in_as("new", password).status, 401);
}

TEST_F(Accounts, ALanguageIsOfThePersonInEveryBrowser) {
  EXPECT_TRUE(json(get("tom", "/session"))["language"].is_null());
  EXPECT_EQ(post("tom", "/session/language", {{"language", "fr"}}).status, 204);
  EXPECT_EQ(json(get("tom", "/session"))["language"], "fr");
  const auto elsewhere =
      ask(request("POST", "/api/v1/session", {{"content-type", "application/json"}},
                  core::Json{{"name", "tom"}, {"password", kPassword}}.dump()));
  EXPECT_EQ(json(elsewhere)["language"], "fr");
  EXPECT_TRUE(json(get("tia", "/session"))["language"].is_null());
  for (const char* none : {"", "it", "de-CH", "FR"})
    EXPECT_EQ(post("tom", "/session/language", {{"language", none}}).status, 400) << none;
  EXPECT_EQ(json(get("tom", "/session"))["language"], "fr");
}

TEST_F(Accounts, ANameOrABadgeIsOneAccountsAlone) {
  EXPECT_EQ(post("ann", "/accounts", {{"name", "tom"}, {"role", "trainee"}}).status, 409);
  EXPECT_EQ(post("ann", "/accounts/tom/badge", {{"badge", "77"}, {"pin", "1234"}}).status, 200);
  EXPECT_EQ(post("ann", "/accounts/tia/badge", {{"badge", "77"}, {"pin", "1234"}}).status, 409);
}

TEST_F(Accounts, RubbishIsRefusedByField) {
  for (const core::Json& bad :
       {core::Json{{"name", ""}, {"role", "trainee"}}, core::Json{{"name", "x"}, {"role", "king"}},
        core::Json{{"name", "x"}, {"role", "station"}}, core::Json{{"role", "trainee"}},
        core::Json{{"name", "x"}, {"role", "trainee"}, {"password", "short"}},
        core::Json{{"name", "x"}, {"role", "trainee"}, {"pin", "12"}},
        core::Json{{"name", "x"}, {"role", "trainee"}, {"pin", "12a4"}},
        core::Json{{"name", "x"}, {"role", "trainee"}, {"extra", 1}}})
    EXPECT_EQ(post("ann", "/accounts", bad).status, 400) << bad;
}

TEST_F(Accounts, SwitchingOneOffEndsItsSessions) {
  const auto own = as("rex");
  EXPECT_EQ(ask(request("GET", "/api/v1/session", own)).status, 200);
  EXPECT_EQ(post("ann", "/accounts/rex/state", {{"state", "disabled"}}).status, 200);
  EXPECT_EQ(ask(request("GET", "/api/v1/session", own)).status, 401);
  EXPECT_EQ(sign_in_as("rex", kPassword).status, 401);
  EXPECT_EQ(post("ann", "/accounts/rex/state", {{"state", "active"}}).status, 200);
  EXPECT_EQ(ask(request("GET", "/api/v1/session", own)).status, 401)
      << "the old session stays over";
  EXPECT_EQ(sign_in_as("rex", kPassword).status, 200);
}

TEST_F(Accounts, TheLastAdministratorStays) {
  EXPECT_EQ(post("ann", "/accounts/1/state", {{"state", "disabled"}}).status, 200);  // ada
  EXPECT_EQ(post("ann", "/accounts/ann/state", {{"state", "disabled"}}).status, 409);
  EXPECT_EQ(post("ann", "/accounts/ann/role", {{"role", "trainee"}}).status, 409);
}

TEST_F(Accounts, AResetEndsTheLockOutAndTheCodes) {
  for (int i = 0; i < 10; ++i) EXPECT_EQ(sign_in_as("rex", "guess").status, 401);
  EXPECT_EQ(sign_in_as("rex", kPassword).status, 429);
  const auto reset = post("ann", "/accounts/rex/password");
  ASSERT_EQ(reset.status, 200);
  EXPECT_EQ(sign_in_as("rex", json(reset)["password"]).status, 200);
}

TEST_F(Accounts, OneTimeCodesAreAskedForOnceConfirmedAndTakenOnce) {
  EXPECT_EQ(post("rex", "/session/codes/confirm", {{"code", "123456"}}).status, 409);
  EXPECT_EQ(post("rex", "/session/codes", {{"password", "guess"}}).status, 403);
  ASSERT_EQ(post("rex", "/session/codes", {{"password", kPassword}}).status, 200);
  EXPECT_EQ(sign_in_as("rex", kPassword).status, 200) << "not asked for before a code was shown";
  auto rex = store_.read([](store::Reading& tx) { return store::account_of(tx, "rex"); });
  const std::string sealed = (*rex.value()).totp_secret;
  const std::string secret = backend_.secrets.opened(sealed).value();
  EXPECT_EQ(sealed.find(core::hex(core::bytes_of(secret))), std::string::npos);
  const auto code = [&](std::int64_t ahead) {
    return hotp(core::bytes_of(secret),
                static_cast<std::uint64_t>(now_ / 1'000'000 / kTotpStep_s + ahead));
  };
  EXPECT_EQ(post("rex", "/session/codes/confirm", {{"code", code(-5)}}).status, 403);
  EXPECT_EQ(post("rex", "/session/codes/confirm", {{"code", code(-1)}}).status, 204);
  const auto needed = sign_in_as("rex", kPassword);
  EXPECT_EQ(needed.status, 401);
  EXPECT_EQ(json(needed)["code"], "code_needed");
  EXPECT_EQ(json(sign_in_as("rex", "guess"))["code"], "unauthorised") << "says nothing of codes";
  EXPECT_EQ(sign_in_with_code("rex", code(-1)).status, 401) << "used at confirming";
  EXPECT_EQ(sign_in_with_code("rex", code(0)).status, 200);
  EXPECT_EQ(sign_in_with_code("rex", code(0)).status, 401);
  now_ += kTotpStep_s * 1'000'000;
  EXPECT_EQ(sign_in_with_code("rex", code(0)).status, 200);
}

TEST_F(Accounts, WithCodesThePasswordAndTheCodesAreChangedByPasswordAndCodeAlone) {
  const std::string secret = codes_of("rex");
  const auto own = as("rex"), other = as("rex");
  const auto tell = [&](const std::string& path, const core::Json& body) {
    return ask(request("POST", "/api/v1/session/" + path, own, body.dump()));
  };
  const std::string next = "a longer password";
  const auto needed = tell("password", {{"old", kPassword}, {"new", next}});
  EXPECT_EQ(needed.status, 403) << "401 would say that the session is over";
  EXPECT_EQ(json(needed)["code"], "code_needed");
  EXPECT_EQ(tell("password", {{"old", kPassword}, {"new", next}, {"code", "000000"}}).status, 403);
  EXPECT_EQ(
      tell("password", {{"old", "guess"}, {"new", next}, {"code", code_of(secret, 0)}}).status,
      403);
  EXPECT_EQ(
      tell("password", {{"old", kPassword}, {"new", next}, {"code", code_of(secret, 0)}}).status,
      204);
  EXPECT_EQ(ask(request("GET", "/api/v1/session", other)).status, 401) << "the other session ends";
  now_ += kTotpStep_s * 1'000'000;
  EXPECT_EQ(tell("codes/end", {{"code", code_of(secret, 0)}}).status, 400);
  EXPECT_EQ(tell("codes/end", {{"password", kPassword}, {"code", code_of(secret, 0)}}).status, 403);
  EXPECT_EQ(tell("codes/end", {{"password", next}, {"code", "000000"}}).status, 403);
  const auto third = as("rex");
  EXPECT_EQ(tell("codes/end", {{"password", next}, {"code", code_of(secret, 0)}}).status, 204);
  EXPECT_EQ(ask(request("GET", "/api/v1/session", third)).status, 401);
  EXPECT_EQ(ask(request("GET", "/api/v1/session", own)).status, 200) << "who asked stays";
}

TEST_F(Accounts, AnAdministratorResetsTheOwnPasswordByTheOldOneAlone) {
  const std::string secret = codes_of("ann");
  const auto own = as("ann");
  const auto reset = ask(request("POST", "/api/v1/accounts/ann/password", own, "{}"));
  EXPECT_EQ(reset.status, 403) << text(reset);
  EXPECT_EQ(sign_in_with_code("ann", code_of(secret, 0)).status, 200) << "nothing was changed";
  const auto rex = as("rex");
  EXPECT_EQ(ask(request("POST", "/api/v1/accounts/rex/password", own, "{}")).status, 200);
  EXPECT_EQ(ask(request("GET", "/api/v1/session", rex)).status, 401) << "another's sessions end";
}

TEST_F(Accounts, SessionsEndWhenTheLinkWithTheProviderIsTakenAwayOrChanged) {
  OidcSettings settings;
  settings.issuer = "https://provider";
  const Oidc oidc(settings);
  backend_.oidc = &oidc;
  for (const char* subject : {"rex at the clinic", "another", ""}) {
    const auto own = as("rex");
    EXPECT_EQ(post("ann", "/accounts/rex/subject", {{"subject", subject}}).status, 204);
    EXPECT_EQ(ask(request("GET", "/api/v1/session", own)).status, 401) << subject;
  }
}

TEST_F(Accounts, AStationComesInByACodeOnceAndGoesForGood) {
  const std::string key(64, 'k');
  const auto code = post("ted", "/stations/codes", {{"name", "room 3"}});
  ASSERT_EQ(code.status, 201) << text(code);
  const auto enrol = [&](const std::string& with) {
    return ask(request("POST", "/api/v1/stations/enrol", {{"content-type", "application/json"}},
                       core::Json{{"code", with}, {"token_sha256", token_hash(key)}}.dump()));
  };
  EXPECT_EQ(enrol("wrong").status, 401);
  const auto in = enrol(json(code)["code"]);
  ASSERT_EQ(in.status, 201) << text(in);
  EXPECT_EQ(json(in)["name"], "room 3");
  EXPECT_EQ(enrol(json(code)["code"]).status, 401) << "used up";
  const auto who = [&] { return ask(request("GET", "/api/v1/session", station(key))); };
  EXPECT_EQ(json(who())["role"], "station");
  EXPECT_EQ(post("ted", "/stations/" + json(in)["id"].get<std::string>() + "/revoke").status, 204);
  EXPECT_EQ(who().status, 401);
  EXPECT_EQ(ask(request("GET", "/api/v1/session", station("token-1"))).status, 200)
      << "others stay";
}

TEST_F(Accounts, AnOldCodeAndGuessedOnesLetNobodyIn) {
  const auto code = post("ted", "/stations/codes", {{"name", "room 3"}});
  const auto enrol = [&](const std::string& with) {
    return ask(request("POST", "/api/v1/stations/enrol", {{"content-type", "application/json"}},
                       core::Json{{"code", with}, {"token_sha256", std::string(64, 'a')}}.dump()))
        .status;
  };
  now_ += 3601ll * 1'000'000;
  EXPECT_EQ(enrol(json(code)["code"]), 401);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(enrol("guess"), 401);
  EXPECT_EQ(enrol("guess"), 429) << "throttled";
}

TEST_F(Accounts, CohortsAreLedByWhoMadeThem) {
  const auto made = post("fay", "/cohorts", {{"name", "2026"}});
  ASSERT_EQ(made.status, 201) << text(made);
  const std::string path = "/cohorts/" + json(made)["id"].get<std::string>();
  EXPECT_EQ(post("dora", path + "/people", {{"name", "tia"}}).status, 200);
  EXPECT_EQ(json(get("fay", path))["people"].size(), 2u);
  EXPECT_EQ(json(get("fay", "/trials"))["trials"].size(), 2u) << "tia's trial too, from now on";
  EXPECT_EQ(post("dora", path + "/people", {{"name", "rex"}}).status, 400) << "no trainee";
  EXPECT_EQ(get("flo", path).status, 404);
  EXPECT_EQ(ask(request("DELETE", "/api/v1" + path + "/people/tia", as("fay"))).status, 200);
  EXPECT_EQ(json(get("fay", "/trials"))["trials"].size(), 1u);
}

class Audited : public PeopleTest {
 protected:
  /// Of what people did.
  std::vector<store::AuditRow> rows() {
    auto all =
        store_.read([](store::Reading& tx) { return store::audit_before(tx, 1'000'000, 100); })
            .value();
    std::erase_if(all, [](const auto& row) { return row.act.role == store::kServer; });
    return all;
  }
};

TEST_F(Audited, EveryChangeIsARowWithWhoAndWhatAndNoSecret) {
  ASSERT_EQ(
      post(
          "ann", "/accounts",
          {{"name", "new"}, {"role", "trainee"}, {"password", "planted-password"}, {"pin", "9876"}})
          .status,
      201);
  const auto all = rows();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].act.who, "ann");
  EXPECT_EQ(all[0].act.role, "admin");
  EXPECT_EQ(all[0].act.what, "addAccount");
  EXPECT_EQ(all[0].act.peer, "127.0.0.1");
  EXPECT_NE(all[0].act.detail.find("\"name\":\"new\""), std::string::npos);
  EXPECT_EQ(all[0].act.detail.find("planted-password"), std::string::npos);
  EXPECT_EQ(all[0].act.detail.find("9876"), std::string::npos);
}

TEST_F(Audited, ANameThatIsNobodysIsNotKept) {
  EXPECT_EQ(sign_in_as("a password in the wrong field", "guess").status, 401);
  const auto all = rows();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].act.what, "signIn");
  EXPECT_EQ(all[0].act.detail.find("wrong field"), std::string::npos) << all[0].act.detail;
}

TEST_F(Audited, NeitherTheTicketNorThePinOfAStationIsKept) {
  ASSERT_EQ(post("fay", "/accounts/tom/badge", {{"badge", "4711"}, {"pin", "2468"}}).status, 200);
  const auto work = [&](const std::string& tail, const core::Json& body) {
    return ask(request("POST", "/api/v1/work/" + tail, station("token-1"), body.dump()));
  };
  const std::string ticket = json(work("sign-in", {{"badge", "4711"}, {"pin", "2468"}}))["ticket"];
  ASSERT_EQ(work("next", {{"ticket", ticket}}).status, 200);
  ASSERT_EQ(work("sign-out", {{"ticket", ticket}}).status, 204);
  const auto all = rows();
  ASSERT_EQ(all.size(), 4u);
  for (const auto& row : all) {
    EXPECT_EQ(row.act.detail.find(ticket), std::string::npos) << row.act.detail;
    EXPECT_EQ(row.act.detail.find("2468"), std::string::npos) << row.act.detail;
  }
  EXPECT_NE(all.back().act.detail.find("4711"), std::string::npos) << "whose badge is kept";
}

TEST_F(Audited, WhatFailsOrIsOnlyReadLeavesNoRowAndWhatIsRefusedIsCalledSo) {
  EXPECT_EQ(post("ann", "/accounts", {{"name", "tom"}, {"role", "trainee"}}).status, 409);
  EXPECT_EQ(get("ann", "/accounts").status, 200);
  EXPECT_TRUE(rows().empty());
  EXPECT_EQ(post("tom", "/accounts", {{"name", "x"}, {"role", "admin"}}).status, 403);
  const auto all = rows();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].act.what, "refused: addAccount");
  EXPECT_EQ(all[0].act.who, "tom");
}

TEST_F(Audited, SigningInNamesWhoAndAFailureDoesToo) {
  EXPECT_EQ(sign_in_as("ann", "guess").status, 401);
  EXPECT_EQ(sign_in_as("ann", kPassword).status, 200);
  const auto all = rows();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].act.who, "ann");
  EXPECT_EQ(all[0].act.role, "admin");
  EXPECT_EQ(all[1].act.who, "");
  EXPECT_NE(all[1].act.detail.find("\"name\":\"ann\""), std::string::npos);
}

TEST_F(Audited, AdministratorsReadTheTrailAndItsCheck) {
  ASSERT_EQ(post("fay", "/cohorts", {{"name", "2026"}}).status, 201);
  const auto listed = json(get("ann", "/audit"));
  ASSERT_GE(listed["rows"].size(), 1u);
  EXPECT_EQ(listed["rows"][0]["what"], "addCohort");
  EXPECT_EQ(listed["rows"][0]["detail"]["name"], "2026");
  EXPECT_EQ(json(get("ann", "/audit/check"))["holds"], true);
  const auto is_by = [&](const char* who) {
    return bool(store_.write([&](store::Writing& tx) {
      return tx.query("update audit set who = ? where what = 'addCohort'", {who});
    }));
  };
  ASSERT_TRUE(is_by("flo"));
  const auto check = json(get("ann", "/audit/check"));
  EXPECT_EQ(check["holds"], false);
  EXPECT_NE(check["failure"].get<std::string>().find("row " + listed["rows"][0]["number"].dump()),
            std::string::npos);
  ASSERT_TRUE(is_by("fay"));
}

}  // namespace
}  // namespace api
}  // namespace tractus
