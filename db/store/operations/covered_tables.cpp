/// Adding a column to one of these tables is adding it here, or to the test's list of those that
/// are left out (coverage_test.cpp).
#include "db/store/operations/coverage.hpp"

namespace tractus::store {

const std::vector<CoveredTable>& covered_tables() {
  static const std::vector<CoveredTable> kTables{
      {"accounts",
       {"id"},
       {"name", "role", "password_hash", "made_utc_us", "state", "pseudonym", "badge", "pin_hash",
        "totp_secret", "totp_confirmed", "must_change", "level"}},
      {"oidc_subjects", {"issuer", "subject"}, {"account_id", "linked_utc_us", "linked_by"}},
      {"stations", {"id"}, {"name", "token_hash", "enrolled_utc_us", "revoked_utc_us"}},
      {"cohorts", {"id"}, {"name", "made_utc_us", "made_by"}},
      {"cohort_people", {"cohort_id", "account_id"}, {"part", "since_utc_us"}},
      {"cohort_invitations", {"cohort_id", "account_name"}, {"made_utc_us", "made_by"}},
      {"consents",
       {"account_id", "study_id", "participant"},
       {"tier", "basis", "noted_utc_us", "noted_by"}},
      {"pseudonym_keys", {"fingerprint"}, {"since_utc_us"}},
      {"cases",
       {"id"},
       {"title", "source", "made_utc_us", "published_utc_us", "kind", "retired_utc_us", "planned",
        "felt"}},
      {"case_parts", {"case_id", "name"}, {"sha256", "size_bytes", "secret"}},
      {"studies",
       {"id"},
       {"title", "state", "ordering", "repeats", "seed", "on_invalid", "made_utc_us", "made_by",
        "kind"}},
      {"study_scenarios", {"study_id", "position"}, {"case_id"}},
      {"study_participants",
       {"study_id", "name"},
       {"position", "state", "level", "experience_years", "simulated", "enrolled_utc_us"}},
      {"study_slots",
       {"id"},
       {"study_id", "participant", "position", "attempt", "case_id", "state", "station_id",
        "repeat_of", "changed_utc_us"}},
      {"study_trials", {"trial_id"}, {"slot_id", "state", "reason", "changed_utc_us", "tool"}},
      {"study_events",
       {"study_id", "number"},
       {"at_utc_us", "who", "what", "participant", "slot_id", "trial_id", "reason"}},
      {"assignments", {"study_id"}, {"cohort_id", "due_utc_us", "release", "made_by_id"}},
      {"assignment_people", {"study_id", "account_id"}, {"participant"}},
      {"trials",
       {"id"},
       {"case_id", "station_id", "sha256", "operator_name", "simulated", "started_utc_us",
        "received_utc_us", "duration_s", "samples", "complete", "late_ticks", "not_converged",
        "skipped_ticks", "header", "events", "state", "failure", "correct", "coverage"}},
      {"trial_metrics", {"trial_id"}, {"metric_id", "position", "value", "note"}},
      {"rubrics", {"id", "version"}, {"title", "definition", "reason", "made_utc_us", "made_by"}},
      {"rating_requests",
       {"trial_id", "rubric_id"},
       {"version", "blind", "raters", "made_utc_us", "made_by"}},
      {"ratings",
       {"trial_id", "rubric_id", "rater_id", "number"},
       {"scores", "comment", "reason", "independent", "made_utc_us"}},
      {"criteria",
       {"kind", "subject", "version"},
       {"definition", "reason", "made_utc_us", "made_by"}},
      {"curricula", {"id", "version"}, {"title", "definition", "reason", "made_utc_us", "made_by"}},
      {"curriculum_steps", {"study_id"}, {"curriculum_id", "version", "step_id"}},
      {"analysis_plans",
       {"id"},
       {"title", "study", "plan", "data_seen", "trials_then", "made_utc_us", "made_by"}}};
  return kTables;
}

}  // namespace tractus::store
