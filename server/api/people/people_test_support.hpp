/// Two cohorts of one trainee each, their faculty, one account of every other role, and a trial of
/// each trainee in an assignment of its cohort.
#pragma once

#include "core/try.hpp"
#include "db/store/people/api_tokens.hpp"
#include "db/store/studies/assignments.hpp"
#include "db/store/trials/trials.hpp"
#include "db/store/trials/uploads.hpp"
#include "server/api/api_test_support.hpp"

namespace tractus::api::testing {

class PeopleTest : public ApiTest {
 protected:
  static constexpr store::Release kRelease = store::Release::released;

  PeopleTest() {
    const auto furnished = store_.write([&](store::Writing& tx) -> core::Result<void> {
      for (const auto& [name, role] :
           std::vector<std::pair<std::string, Role>>{{"dora", Role::director},
                                                     {"fay", Role::faculty},
                                                     {"flo", Role::faculty},
                                                     {"rex", Role::researcher},
                                                     {"ted", Role::technician},
                                                     {"tom", Role::trainee},
                                                     {"tia", Role::trainee},
                                                     {"ann", Role::admin}}) {
        store::Account account{
            .id = name, .name = name, .role = role, .password_hash = quick_hash()};
        account.pseudonym = "P-" + name;
        TRY(store::add_account(tx, account, 0));
        constexpr auto kScopes = core::values<store::TokenScope>();
        TRY(add_token(tx, name, {kScopes.begin(), kScopes.end()}));
      }
      TRY(furnish_cohort(tx, "c-tom", "fay", "tom"));
      return furnish_cohort(tx, "c-tia", "flo", "tia");
    });
    EXPECT_TRUE(furnished) << furnished.error().what;
  }

  /// The API token "tractus_NAME" with the id "t-NAME".
  static core::Result<void> add_token(store::Writing& tx, const std::string& account,
                                      std::vector<store::TokenScope> scopes) {
    return store::add_api_token(tx,
                                {.id = "t-" + account,
                                 .account_id = account,
                                 .name = "script",
                                 .scopes = std::move(scopes),
                                 .expires_utc_us = 2'000'000'000'000'000},
                                token_hash("tractus_" + account));
  }
  static std::map<std::string, std::string> by_token(const std::string& account) {
    return {{"authorization", "Bearer tractus_" + account}};
  }

  /// A cohort, its assignment "a-NAME" of one case, and the trial that its trainee did.
  static core::Result<void> furnish_cohort(store::Writing& tx, const std::string& cohort,
                                           const std::string& leader, const std::string& trainee) {
    TRY(store::add_cohort(tx, {cohort, cohort, 0, leader}));
    TRY(store::put_into_cohort(tx, cohort, leader, store::CohortPart::faculty, 0));
    TRY(store::put_into_cohort(tx, cohort, trainee, store::CohortPart::trainee, 0));
    const store::AuditStamp stamp{leader, 1};
    const std::string study = "a-" + trainee, who = "P-" + trainee;
    auto assigned = TRY(store::add_assignment(
        tx,
        {.study = {.id = study, .title = "", .ordering = store::CaseOrder::random},
         .cohort_id = cohort,
         .release = kRelease,
         .made_by_id = leader},
        {kCase}, stamp));
    TRY(store::add_participant(tx, assigned, {.name = who}, {kCase}, stamp));
    TRY(store::add_assigned_person(tx, assigned, trainee, who));
    auto slots = TRY(store::study_slots(tx, assigned));
    return furnish_trial(tx, trial_of(trainee), slots.front().id);
  }

  static core::Result<void> furnish_trial(store::Writing& tx, const std::string& id,
                                          const std::string& slot, const store::Tool& tool = {}) {
    const std::string sha = core::sha256(core::bytes_of(id));
    store::TrialRecord trial;
    trial.summary.id = id;
    trial.summary.case_id = kCase;
    trial.summary.started_utc_us = 10;
    trial.station_id = "s1";
    trial.sha256 = sha;
    trial.complete = true;
    trial.header = trial.events = "{}";
    TRY(store::add_upload(tx, {id, "s1", kCase, 1, sha, store::UploadPhase::receiving}, 1));
    TRY(store::announce_for_slot(tx, id, slot, 1));
    TRY(store::add_object(tx, sha, 1, 1));
    TRY(store::add_trial(tx, trial, 1));
    return store::record_for_slot(tx, id, true, {"s1", 1}, tool);
  }

  static std::string trial_of(const std::string& trainee) {
    return core::sha256(core::bytes_of(trainee)).substr(0, 32);
  }

  /// Headers of a new session, without the time that a password takes.
  std::map<std::string, std::string> as(const std::string& account) {
    const std::string token = "session-" + std::to_string(++sessions_);
    const auto added = store_.write([&](store::Writing& tx) {
      return store::add_session(tx, token_hash(token), account, now_);
    });
    EXPECT_TRUE(added);
    return {{"cookie", std::string(kSessionCookie) + "=" + token},
            {"x-tractus", "1"},
            {"content-type", "application/json"}};
  }
  http::Response get(const std::string& account, const std::string& path) {
    return ask(request("GET", "/api/v1" + path, as(account)));
  }
  http::Response post(const std::string& account, const std::string& path,
                      const core::Json& body = core::Json::object()) {
    return ask(request("POST", "/api/v1" + path, as(account), body.dump()));
  }

  int sessions_ = 0;
};

}  // namespace tractus::api::testing
