#include "db/store/operations/coverage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/json.hpp"
#include "core/try.hpp"
#include "tests/support/database/database.hpp"

namespace tractus {
namespace store {
namespace {

/// A row in every covered table, each value different from null.
constexpr const char* kRows[] = {
    "insert into objects (sha256, size_bytes, made_utc_us) values ('o', 1, 1)",
    "insert into accounts (id, name, role, password_hash, made_utc_us, state, pseudonym, badge, "
    "pin_hash, totp_secret, totp_confirmed, must_change, level) values ('a', 'tom', 'trainee', "
    "'h', 1, "
    "'active', 'p', '4711', 'pin', 'secret', 1, 0, 'PGY-2')",
    "insert into oidc_subjects (issuer, subject, account_id, linked_utc_us, linked_by) values "
    "('i', 's', 'a', 1, 'ada')",
    "insert into api_tokens (id, account_id, name, token_hash, scopes, made_utc_us, "
    "expires_utc_us, revoked_utc_us, revoked_by) values ('z', 'a', 'script', 'h', 'trials:read', "
    "1, 2, 1, 'ada')",
    "insert into notification_addresses (account_id, address) values ('a', 'a@example.org')",
    "insert into webhooks (id, url, kinds, secret, made_utc_us, made_by) values ('w', "
    "'https://example.org/', 'due', 's', 1, 'ada')",
    "insert into lti_platforms (id, issuer, client_id, deployments, authorization_url, token_url, "
    "keys_url, match_email, made_utc_us, made_by) values ('f', 'https://lms.example.org', 'c', "
    "'[\"1\"]', 'u', 'u', 'u', 0, 1, 'ada')",
    "insert into record_stores (id, endpoint, key, secret, made_utc_us, made_by) values ('e', "
    "'https://lrs.example.org', 'k', 's', 1, 'ada')",
    "insert into group_rules (version, definition, reason, made_utc_us, made_by) values (1, '{}', "
    "'r', 1, 'ada')",
    "insert into group_accounts (account_id, version, seen_utc_us, left_utc_us) values ('a', 1, 2, "
    "3)",
    "insert into stations (id, name, token_hash, enrolled_utc_us, revoked_utc_us) values ('s', "
    "'station', 't', 1, 2)",
    "insert into cohorts (id, name, made_utc_us, made_by) values ('c', 'year 1', 1, 'ada')",
    "insert into cohort_people (cohort_id, account_id, part, since_utc_us) values ('c', 'a', "
    "'trainee', 1)",
    "insert into cohort_invitations (cohort_id, account_name, made_utc_us, made_by) values ('c', "
    "'tim', 1, 'ada')",
    "insert into consents (account_id, study_id, participant, tier, basis, noted_utc_us, noted_by) "
    "values ('a', '', '', 'full', 'signed', 1, 'ada')",
    "insert into pseudonym_keys (fingerprint, since_utc_us) values ('f', 1)",
    "insert into cases (id, title, source, made_utc_us, published_utc_us, kind, retired_utc_us, "
    "planned, felt) values ('k', 'L3', 'made', 1, 1, 'palpation', 2, 0, 'told')",
    "insert into case_parts (case_id, name, sha256, size_bytes, secret) values ('k', 'truth.json', "
    "'o', 1, 1)",
    "insert into studies (id, title, state, ordering, repeats, seed, on_invalid, made_utc_us, "
    "made_by, kind) values ('y', 'study', 'open', 'latin', 1, 7, 'repeat', 1, 'ada', 'study')",
    "insert into study_scenarios (study_id, position, case_id) values ('y', 1, 'k')",
    "insert into study_participants (study_id, name, position, state, level, experience_years, "
    "simulated, enrolled_utc_us) values ('y', 'P1', 1, 'enrolled', 'resident', 2.5, 0, 1)",
    "insert into study_slots (id, study_id, participant, position, attempt, case_id, state, "
    "station_id, repeat_of, changed_utc_us) values ('l', 'y', 'P1', 1, 1, 'k', 'open', 's', 'l', "
    "1)",
    "insert into uploads (trial_id, station_id, case_id, size_bytes, sha256, state, "
    "announced_utc_us) values ('t', 's', 'k', 1, 'o', 'complete', 1)",
    "insert into study_trials (trial_id, slot_id, state, reason, changed_utc_us, tool) values "
    "('t', 'l', 'done', 'none', 1, 'probe')",
    "insert into study_events (study_id, number, at_utc_us, who, what, participant, slot_id, "
    "trial_id, reason) values ('y', 1, 1, 'ada', 'begun', 'P1', 'l', 't', 'why')",
    "insert into assignments (study_id, cohort_id, due_utc_us, release, made_by_id) values ('y', "
    "'c', 5, 'at once', 'a')",
    "insert into assignment_people (study_id, account_id, participant) values ('y', 'a', 'P1')",
    "insert into trials (id, case_id, station_id, sha256, operator_name, simulated, "
    "started_utc_us, received_utc_us, duration_s, samples, complete, late_ticks, not_converged, "
    "skipped_ticks, header, events, state, failure, correct, coverage) values ('t', 'k', 's', 'o', "
    "'tom', 0, 1, 2, 3.5, 4, 1, 0, 0, 0, '{}', '[]', 'assessed', 'none', 1, '{}')",
    "insert into trial_metrics (trial_id, metric_id, position, value, note) values ('t', "
    "'duration', 0, 3.5, 'n')",
    "insert into trial_metrics (trial_id, metric_id, position, value, note) values ('t', 'force', "
    "1, 0.1, 'n')",
    "insert into rubrics (id, version, title, definition, reason, made_utc_us, made_by) values "
    "('r', 1, 'rating', '{}', 'why', 1, 'ada')",
    "insert into rating_requests (trial_id, rubric_id, version, blind, raters, made_utc_us, "
    "made_by) values ('t', 'r', 1, 0, 2, 1, 'ada')",
    "insert into ratings (trial_id, rubric_id, rater_id, number, scores, comment, reason, "
    "independent, made_utc_us) values ('t', 'r', 'a', 1, '[3]', 'good', 'why', 1, 1)",
    "insert into criteria (kind, subject, version, definition, reason, made_utc_us, made_by) "
    "values "
    "('case', 'k', 1, '{}', 'why', 1, 'ada')",
    "insert into curricula (id, version, title, definition, reason, made_utc_us, made_by) values "
    "('q', 1, 'year 1', '{}', 'why', 1, 'ada')",
    "insert into curriculum_steps (study_id, curriculum_id, version, step_id) values ('y', 'q', 1, "
    "'s1')",
    "insert into erasures (number, account_id, mode, cause, state, name, badge, begun_utc_us, "
    "done_utc_us) values (1, 'a', 'erase', 'asked', 'done', '', '', 1, 2)",
    "insert into redactions (number, digest) values (1, 'd')",
    "insert into retention_rules (version, definition, reason, made_utc_us, made_by) values (1, "
    "'{}', 'why', 1, 'ada')",
    "insert into analysis_plans (id, title, study, plan, data_seen, trials_then, made_utc_us, "
    "made_by) values ('n', 'plan', 'y', 'o', 0, 0, 1, 'ada')"};

/// Another value of the same type.
Value other(const Value& value) {
  struct Changing {
    Value operator()(std::monostate) const { return std::string("x"); }
    Value operator()(std::int64_t v) const { return v + 1; }
    Value operator()(double v) const { return v + 0.5; }
    Value operator()(const std::string& v) const { return v + "x"; }
    Value operator()(const core::Bytes&) const { return core::Bytes(); }
  };
  return std::visit(Changing{}, value);
}

class Coverage : public test_support::BothDatabases {
 protected:
  Coverage() {
    EXPECT_TRUE(begin_coverage(store_).value());
    const auto written = store_.write([](Writing& tx) -> core::Result<void> {
      for (const char* row : kRows) TRY(tx.query(row));
      return {};
    });
    EXPECT_TRUE(written) << written.error().what;
    // By hand, as somebody who has the database's password and not the server's key.
    hand_ = database_.connection(Access::write);
    by_hand(GetParam() == test_support::DatabaseKind::postgresql
                ? "set session_replication_role = replica"
                : "pragma foreign_keys = off",
            Within::none);
  }

  enum class Within { transaction, none };
  Rows by_hand(const std::string& sql, Within within = Within::transaction,
               const std::vector<Value>& values = {}) {
    if (within == Within::none && GetParam() == test_support::DatabaseKind::sqlite) {
      EXPECT_TRUE(hand_->script(sql));
      return {};
    }
    EXPECT_TRUE(hand_->begin(Access::write));
    auto rows = hand_->query(sql, values);
    EXPECT_TRUE(rows) << sql << ": " << rows.error().what;
    EXPECT_TRUE(hand_->commit());
    return rows ? *rows : Rows();
  }
  /// What is found, a line each.
  std::vector<std::string> findings() {
    std::vector<std::string> out;
    const auto read = store_.read([&](Reading& tx) -> core::Result<void> {
      TrailDigests digests;
      TRY(verify_chain(tx, store_.audit_key(), [&](const AuditRow& row) { digests.add(row); }));
      return digests.compare(tx, store_.audit_key(), out);
    });
    EXPECT_TRUE(read) << read.error().what;
    return out;
  }
  void expect_one_finding(const std::string& table, const std::string& words) {
    const auto found = findings();
    ASSERT_EQ(found.size(), 1u) << table << fmt::format(": {}", fmt::join(found, "; "));
    EXPECT_TRUE(found[0].starts_with("table " + table + ": ")) << found[0];
    EXPECT_NE(found[0].find(words), std::string::npos) << found[0];
  }

  test_support::TestDatabase database_{GetParam()};
  Store store_ = database_.open();
  std::unique_ptr<Connection> hand_;
};
TRACTUS_ON_BOTH_DATABASES(Coverage);

TEST_P(Coverage, WhatTheServerWroteIsAsTheTrailHasIt) { EXPECT_TRUE(findings().empty()); }

TEST_P(Coverage, EveryColumnOfACoveredTableIsCoveredOrLeftOutOnPurpose) {
  // The last one-time code's step changes with every sign-in. A language opens nothing.
  // Name and badge stand only until the person is taken out of the trail.
  const std::vector<std::string> left_out{"accounts.totp_step", "accounts.language",
                                          "erasures.name", "erasures.badge"};
  const auto tables = store_.read([](Reading& tx) { return tx.tables(); });
  ASSERT_TRUE(tables);
  for (const CoveredTable& covered : covered_tables()) {
    const auto table = std::ranges::find(*tables, covered.name, &Table::name);
    ASSERT_NE(table, tables->end()) << covered.name;
    for (const std::string& column : table->columns) {
      const bool known = std::ranges::count(covered.keys, column) > 0 ||
                         std::ranges::count(covered.columns, column) > 0 ||
                         std::ranges::count(left_out, covered.name + "." + column) > 0;
      EXPECT_TRUE(known) << covered.name << "." << column;
    }
  }
}

TEST_P(Coverage, AnEditOfAnyCoveredColumnIsSeen) {
  for (const CoveredTable& table : covered_tables())
    for (const std::string& column : table.columns) {
      SCOPED_TRACE(table.name + "." + column);
      const Rows before = by_hand(fmt::format("select {} from {}", column, table.name));
      ASSERT_FALSE(before.empty());
      by_hand(fmt::format("create table kept as select * from {}", table.name));
      const Value was = before.front().value(0);
      by_hand(fmt::format("update {} set {} = ? where {} = ?", table.name, column, column),
              Within::transaction, {other(was), was});
      expect_one_finding(table.name, "was changed");
      by_hand("delete from " + table.name);
      by_hand(fmt::format("insert into {} select * from kept", table.name));
      by_hand("drop table kept");
    }
  EXPECT_TRUE(findings().empty());
}

TEST_P(Coverage, ADeletedRowOfAnyCoveredTableIsSeen) {
  for (const CoveredTable& table : covered_tables()) {
    SCOPED_TRACE(table.name);
    by_hand(fmt::format("create table kept as select * from {}", table.name));
    by_hand("delete from " + table.name);
    expect_one_finding(table.name, "was deleted");
    by_hand(fmt::format("insert into {} select * from kept", table.name));
    by_hand("drop table kept");
  }
  EXPECT_TRUE(findings().empty());
}

TEST_P(Coverage, AnInsertedRowIsSeen) {
  by_hand(
      "insert into accounts (id, name, role, password_hash, made_utc_us) values ('e', 'eve', "
      "'admin', 'h', 1)");
  expect_one_finding("accounts", "[\"e\"] was inserted");
}

TEST_P(Coverage, AScoreAddedToATrialIsSeen) {
  by_hand(
      "insert into trial_metrics (trial_id, metric_id, position, value, note) values ('t', "
      "'third', "
      "2, 1.0, '')");
  expect_one_finding("trial_metrics", "was changed");
}

/// The same row as before its last change: each row was once right by itself.
TEST_P(Coverage, AnOlderStateOfARowIsSeen) {
  by_hand("create table kept as select * from accounts");
  ASSERT_TRUE(store_.write([](Writing& tx) {
    return tx.query("update accounts set state = 'disabled' where id = 'a'");
  }));
  EXPECT_TRUE(findings().empty());
  by_hand("update accounts set state = (select state from kept)");
  expect_one_finding("accounts", "was changed");
}

TEST_P(Coverage, ChangesOfTheServerStayRight) {
  ASSERT_TRUE(store_.write([](Writing& tx) -> core::Result<void> {
    for (const char* sql : {"update trials set state = 'failed' where id = ?",
                            "delete from trial_metrics where trial_id = ?"})
      TRY(tx.query(sql, {"t"}));
    return {};
  }));
  EXPECT_TRUE(findings().empty());
}

TEST_P(Coverage, AStatementThatReturnsColumnsStillReturnsThemFirst) {
  const auto rows = store_.write([](Writing& tx) {
    return tx.query("update stations set name = ? where id = ? returning token_hash",
                    {"another", "s"});
  });
  ASSERT_TRUE(rows) << rows.error().what;
  ASSERT_EQ(rows->size(), 1u);
  EXPECT_EQ(rows->front().text(0), "t");
  EXPECT_TRUE(findings().empty());
}

TEST_P(Coverage, AWriteThatFailsLeavesTheTrailAsItWas) {
  const auto before = store_.read([](Reading& tx) { return chain_end(tx); });
  EXPECT_FALSE(store_.write([](Writing& tx) -> core::Result<void> {
    TRY(tx.query("update cohorts set name = 'x'"));
    return core::Error{core::Errc::conflict, "thought better of it"};
  }));
  const auto after = store_.read([](Reading& tx) { return chain_end(tx); });
  EXPECT_EQ(before.value().number, after.value().number);
  EXPECT_TRUE(findings().empty());
}

TEST_P(Coverage, BeginsOnce) { EXPECT_FALSE(begin_coverage(store_).value()); }

/// What an older program covered: names of cohorts alone.
core::Result<void> cover_less(Writing& tx, const AuditKey& key) {
  const core::Json detail{{"tables", {{"cohorts", {{"keys", {"id"}}, {"columns", {"name"}}}}}},
                          {"differences", 0}};
  return add_act(tx, key, {.who = kServer, .what = kBeginCoverage, .detail = detail.dump()});
}

TEST_P(Coverage, BeginsAgainWhenMoreIsCovered) {
  by_hand("delete from cohorts");
  ASSERT_TRUE(store_.write([&](Writing& tx) { return cover_less(tx, store_.audit_key()); }));
  EXPECT_TRUE(findings().empty()) << "there is no cohort, and the other tables are not compared";
  EXPECT_TRUE(begin_coverage(store_).value());
  EXPECT_TRUE(findings().empty());
  by_hand("update accounts set role = 'admin'");
  expect_one_finding("accounts", "was changed");
}

TEST_P(Coverage, WhatDifferedWhenItBeganAgainStaysAFinding) {
  ASSERT_TRUE(store_.write([&](Writing& tx) { return cover_less(tx, store_.audit_key()); }));
  ASSERT_EQ(findings().size(), 1u) << "a cohort that this trail does not have";
  EXPECT_TRUE(begin_coverage(store_).value());
  const auto found = findings();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].find("1 rows differed"), std::string::npos) << found[0];
}

}  // namespace
}  // namespace store
}  // namespace tractus
