#include "tests/bench/lists/rows.hpp"

#include <fmt/format.h>

#include "core/try.hpp"

namespace tractus {
namespace bench {
namespace {

/// Statements with {n}: the number of rows; "n" has the rows 0 … n - 1 in its column i.
constexpr const char* kStatements[] = {
    "insert into accounts (id, name, role, password_hash, made_utc_us, level) select 'u' || i, "
    "'Surgeon ' || i, case when "
    "i % 50 = 0 then 'faculty' else 'trainee' end, 'h', 1000000 + i * 7919 % 1000003, 'PGY-' || (i "
    "% 7) from n",
    "insert into accounts (id, name, role, password_hash, made_utc_us) values ('big', 'Big', "
    "'faculty', 'h', 1), ('small', "
    "'Small', 'faculty', 'h', 1)",
    "insert into stations (id, name, token_hash, enrolled_utc_us) select 't' || i, 'station ' || "
    "i, 't' || i, 1 from n "
    "where i < 100",
    "insert into objects (sha256, size_bytes, made_utc_us) values ('o', 1, 1)",
    "insert into cases (id, title, source, made_utc_us, published_utc_us, planned, felt) select "
    "'k' || i, 'L' || (i % 5 + 1) "
    "|| ' pedicle ' || i, 'hospital ' || (i % 50), i * 7919 % 1000003, i * 104729 % 1000003, i % "
    "2, 'told' from n",
    "insert into cohorts (id, name, made_utc_us, made_by) select 'c' || i, 'Year ' || i, 1, 'ada' "
    "from n where i < 1000",
    "insert into cohort_people (cohort_id, account_id, part, since_utc_us) select 'c' || (i % "
    "1000), 'u' || i, 'trainee', 1 "
    "from n",
    "insert into cohort_people (cohort_id, account_id, part, since_utc_us) select 'c' || i, 'big', "
    "'faculty', 1 from n where "
    "i < 500",
    "insert into cohort_people (cohort_id, account_id, part, since_utc_us) values ('c7', 'small', "
    "'faculty', 1)",
    "insert into studies (id, title, state, ordering, repeats, seed, on_invalid, made_utc_us, "
    "made_by, kind) select 'a' || "
    "i, 'Week ' || (i % 52) || ' of task ' || i, 'running', 'fixed', 1, 1, 'at_end', i * 7919 % "
    "1000003, 'ada', "
    "'assignment' from n",
    "insert into assignments (study_id, cohort_id, due_utc_us, release, made_by_id) select 'a' || "
    "i, 'c' || (i % 1000), case "
    "when i % 10 = 0 then null else i * 104729 % 1000003 end, 'released', 'u0' from n",
    "insert into study_participants (study_id, name, position, state, level, simulated, "
    "enrolled_utc_us) select 'a' || i, "
    "'P' || p.v, p.v, 'running', '', 0, 1 from n cross join (select 0 as v union all select 1 as "
    "v) p",
    "insert into assignment_people (study_id, account_id, participant) select 'a' || i, 'u' || ((i "
    "+ p.v * 1000) % {n}), 'P' "
    "|| p.v from n cross join (select 0 as v union all select 1 as v) p",
    "insert into study_slots (id, study_id, participant, position, attempt, case_id, state, "
    "changed_utc_us) select 's' || i "
    "|| '-' || p.v || '-' || q.v, 'a' || i, 'P' || p.v, q.v, 0, 'k' || i, case when i % 5 = 0 and "
    "q.v = 3 then 'waiting' else "
    "'recorded' end, 1 from n cross join (select 0 as v union all select 1 as v) p cross join "
    "(select 0 as v union all "
    "select 1 as v union all select 2 as v union all select 3 as v) q",
    "insert into uploads (trial_id, station_id, case_id, size_bytes, sha256, state, "
    "announced_utc_us) select 'r' || i, 't' || "
    "(i % 100), 'k' || i, 1, 'o', 'complete', 1 from n",
    "insert into study_trials (trial_id, slot_id, state, reason, changed_utc_us) select 'r' || i, "
    "'s' || i || '-0-0', "
    "'counts', '', 1 from n",
    "insert into trials (id, case_id, station_id, sha256, operator_name, simulated, "
    "started_utc_us, received_utc_us, "
    "duration_s, samples, complete, late_ticks, not_converged, skipped_ticks, header, events, "
    "state, failure, correct) select "
    "'r' || i, 'k' || i, 't' || (i % 100), 'o', 'P' || i, 0, i * 7919 % 1000003, 1, (i * 31 % "
    "1009) * 0.5, 1, 1, 0, 0, 0, "
    "'{{}}', '[]', 'assessed', '', i % 2 from n",
    "insert into audit (number, at_utc_us, who, role, peer, what, object, detail, hash, changes) "
    "select i + 1, i, 'Surgeon ' "
    "|| (i % 400), 'trainee', '10.0.0.1', case when i % 3 = 0 then 'signIn' else 'commitUpload' "
    "end, 'trial_id=r' || i, "
    "'{{\"name\":\"Surgeon ' || (i % 400) || '\",\"reason\":\"as was agreed in the meeting of the "
    "week ' || i || '\"}}', "
    "'h0123456789012345678901234567890123456789012345678901234567890123', "
    "'[[\"trials\",[\"r' || i || "
    "'\"],\"0123456789012345678901234567890123456789012345678901234567890123\"]]' from n"};

/// As migration 0022 fills the lists.
constexpr const char* kEntries[] = {
    "insert into trial_entries (trial_id, started_utc_us, duration_s, case_title, station, person, "
    "correct, state, study_id, "
    "participant, account_id, words) select t.id, t.started_utc_us, t.duration_s, c.title, s.name, "
    "u.name, t.correct, "
    "t.state, k.study_id, k.participant, p.account_id, c.title || ' ' || s.name || ' ' || "
    "t.operator_name || ' ' || u.name "
    "from trials t join cases c on c.id = t.case_id join stations s on s.id = t.station_id join "
    "study_trials x on x.trial_id = "
    "t.id join study_slots k on k.id = x.slot_id join assignment_people p on p.study_id = "
    "k.study_id and p.participant = "
    "k.participant join accounts u on u.id = p.account_id",
    "insert into assignment_entries (study_id, finished, due_utc_us, made_utc_us, title, "
    "cohort_name, release, made_by_id, "
    "cohort_id, words) select a.study_id, case when exists (select 1 from study_slots k where "
    "k.study_id = a.study_id and "
    "k.state in ('waiting', 'taken')) then 0 else 1 end, coalesce(a.due_utc_us, 9000000000000000), "
    "s.made_utc_us, s.title, "
    "c.name, a.release, a.made_by_id, a.cohort_id, s.title || ' ' || c.name || ' ' || s.made_by "
    "from assignments a join "
    "studies s on s.id = a.study_id join cohorts c on c.id = a.cohort_id",
    "insert into assigned_progress (account_id, study_id, participant, finished) select "
    "p.account_id, p.study_id, "
    "p.participant, case when exists (select 1 from study_slots k where k.study_id = p.study_id "
    "and k.participant = "
    "p.participant and k.state in ('waiting', 'taken')) then 0 else 1 end from assignment_people "
    "p"};

}  // namespace

core::Result<void> add_rows(store::Connection& connection, int rows) {
  TRY(connection.begin(store::Access::write));
  const std::string numbers = fmt::format(
      "with recursive n(i) as (select 0 union all select i + 1 from n where i < {}) ", rows - 1);
  for (const char* statement : kStatements) {
    const std::string sql = fmt::format(fmt::runtime(statement), fmt::arg("n", rows));
    TRY(connection.query(
        sql.ends_with(" n") || sql.find(" from n ") != std::string::npos ? numbers + sql : sql,
        {}));
  }
  for (const char* statement : kEntries) TRY(connection.query(statement, {}));
  return connection.commit();
}

}  // namespace bench
}  // namespace tractus
