#include "db/store/people/erasure_steps.hpp"

namespace tractus::store {
namespace {

constexpr auto kErase = ErasureMode::erase;
constexpr auto kAnonymise = ErasureMode::anonymise;

/// Trials that go with the person.
const std::string kGone = "(select trial_id from erased_trials where erasure = :number)";
/// Trials of the person that stay.
const std::string kOwn =
    "(select t.trial_id from study_trials t join study_slots k on k.id = t.slot_id join "
    "assignment_people p on p.study_id = k.study_id and p.participant = k.participant where "
    "p.account_id = :account)";
const std::string kArriving =
    "exists (select 1 from study_trials x where x.slot_id = study_slots.id and x.state = "
    "'arriving')";

/// Rows of a table with a study and, in `column`, the person's participant in it.
std::string as_participant(const std::string& table, const std::string& column) {
  return "exists (select 1 from assignment_people p where p.account_id = :account and p.study_id "
         "= " +
         table + ".study_id and p.participant = " + table + "." + column + ") ";
}

/// The name of who made something gives way to the alias.
ErasureStep renamed(const std::string& table, const std::string& column) {
  return {
      table, {}, "update " + table + " set " + column + " = :alias where " + column + " = :name"};
}

/// What lets the person in, and what is theirs alone.
std::vector<ErasureStep> account_steps() {
  return {
      {"erased_trials", kErase,
       "insert into erased_trials (trial_id, erasure, sha256, deleted) select u.trial_id, "
       "cast(:number as bigint), u.sha256, 0 from uploads u where u.trial_id in " +
           kOwn},
      {"erased_slots", kErase,
       "insert into erased_slots (slot_id, erasure) select study_slots.id, cast(:number as bigint) "
       "from study_slots where " +
           as_participant("study_slots", "participant")},
      {"erased_slots", kAnonymise,
       "insert into erased_slots (slot_id, erasure) select study_slots.id, cast(:number as bigint) "
       "from study_slots where state in ('waiting', 'taken') and not " +
           kArriving + " and " + as_participant("study_slots", "participant")},
      {"sessions", {}, "delete from sessions where account_id = :account"},
      {"known_origins", {}, "delete from known_origins where account_id = :account"},
      {"sign_in_failures",
       {},
       "delete from sign_in_failures where name in (:name, :badge) and name <> ''"},
      {"oidc_subjects", {}, "delete from oidc_subjects where account_id = :account"},
      {"group_accounts", {}, "delete from group_accounts where account_id = :account"},
      {"saved_views", {}, "delete from saved_views where account_id = :account"},
      {"pacs_imports", {}, "delete from pacs_imports where account_id = :account"},
      {"api_token_uses",
       {},
       "delete from api_token_uses where token_id in (select id from api_tokens where account_id = "
       ":account)"},
      {"api_tokens", {}, "delete from api_tokens where account_id = :account"},
      {"notification_addresses",
       {},
       "delete from notification_addresses where account_id = :account"},
      {"notification_choices", {}, "delete from notification_choices where account_id = :account"},
      {"delivery_events",
       {},
       "delete from delivery_events where delivery_id in (select id from deliveries where "
       "recipient "
       "= :account)"},
      {"deliveries",
       {},
       "delete from deliveries where recipient = :account or id in (select delivery_id from "
       "lti_line_items where account_id = :account)"},
      {"lti_line_items", {}, "delete from lti_line_items where account_id = :account"},
      {"cohort_invitations", {}, "delete from cohort_invitations where account_name = :name"},
      {"cohort_people", {}, "delete from cohort_people where account_id = :account"},
      {"retention_notices", {}, "delete from retention_notices where account_id = :account"}};
}

std::vector<ErasureStep> erased_trial_steps() {
  std::vector<ErasureStep> out;
  out.push_back({"deliveries", kErase,
                 "delete from deliveries where id in (select delivery_id from record_statements "
                 "where trial_id in " +
                     kGone + ")"});
  for (const char* table :
       {"record_statements", "ratings", "rating_requests", "reference_trials", "trial_comments",
        "trial_clocks", "trial_metrics", "trial_entries", "study_trials"})
    out.push_back(
        {table, kErase, std::string("delete from ") + table + " where trial_id in " + kGone});
  out.push_back(
      {"jobs", kErase, "delete from jobs where kind = 'metrics' and subject in " + kGone});
  out.push_back({"trials", kErase, "delete from trials where id in " + kGone});
  out.push_back({"objects", kErase,
                 "delete from objects where sha256 in (select sha256 from erased_trials where "
                 "erasure = :number) and not exists (select 1 from trials t where t.sha256 = "
                 "objects.sha256)"});
  out.push_back({"uploads", kErase, "delete from uploads where trial_id in " + kGone});
  return out;
}

std::vector<ErasureStep> kept_trial_steps() {
  return {
      {"trial_comments", kAnonymise, "delete from trial_comments where trial_id in " + kOwn},
      {"ratings", kAnonymise, "update ratings set comment = '' where trial_id in " + kOwn},
      {"trial_entries", kAnonymise,
       "update trial_entries set account_id = null, person = (select t.operator_name from trials t "
       "where t.id = trial_entries.trial_id), words = case_title || ' ' || station || ' ' || "
       "(select "
       "t.operator_name from trials t where t.id = trial_entries.trial_id) where account_id = "
       ":account"}};
}

std::vector<ErasureStep> assignment_steps() {
  return {
      {"study_events",
       {},
       "update study_events set reason = '' where reason <> '' and " +
           as_participant("study_events", "participant")},
      {"study_slots",
       {},
       "delete from study_slots where id in (select slot_id from erased_slots where erasure = "
       ":number) "
       "and not exists (select 1 from study_trials t where t.slot_id = study_slots.id)"},
      {"study_slots", kAnonymise,
       "update study_slots set state = 'invalid' where id in (select slot_id from erased_slots "
       "where "
       "erasure = :number)"},
      {"assigned_progress", {}, "delete from assigned_progress where account_id = :account"},
      {"assignment_entries",
       {},
       "update assignment_entries set finished = case when exists (select 1 from study_slots k "
       "where "
       "k.study_id = assignment_entries.study_id and k.state in ('waiting', 'taken')) then 0 else "
       "1 "
       "end where study_id in (select study_id from assignment_people where account_id = "
       ":account)"},
      {"consents", kAnonymise,
       "insert into consents (account_id, study_id, participant, tier, basis, noted_utc_us, "
       "noted_by) "
       "select '', p.study_id, p.participant, case when c.tier in ('reduced', 'full') then "
       "'metrics' "
       "else c.tier end, 'own word, before the person left', c.noted_utc_us, cast(:alias as text) "
       "from assignment_people p join consents c on c.account_id = p.account_id and c.participant "
       "= '' "
       "and c.study_id = (select max(d.study_id) from consents d where d.account_id = p.account_id "
       "and "
       "d.study_id in ('', p.study_id)) where p.account_id = :account"},
      {"consents", {}, "delete from consents where account_id = :account"},
      {"study_participants", kErase,
       "delete from study_participants where " + as_participant("study_participants", "name")},
      {"assignment_people", {}, "delete from assignment_people where account_id = :account"}};
}

/// Last, since the name is looked for until then.
std::vector<ErasureStep> name_steps() {
  std::vector<ErasureStep> out;
  for (const auto& [table, column] : std::initializer_list<std::pair<const char*, const char*>>{
           {"cohorts", "made_by"},          {"cohort_invitations", "made_by"},
           {"consents", "noted_by"},        {"oidc_subjects", "linked_by"},
           {"retention_rules", "made_by"},  {"station_models", "asked_by"},
           {"volumes", "made_by"},          {"volumes", "decided_by"},
           {"case_makings", "made_by"},     {"scenario_versions", "made_by"},
           {"reference_trials", "made_by"}, {"rubrics", "made_by"},
           {"rating_requests", "made_by"},  {"studies", "made_by"},
           {"criteria", "made_by"},         {"curricula", "made_by"},
           {"analysis_plans", "made_by"},   {"analyses", "made_by"},
           {"models", "made_by"},           {"measurement_sets", "made_by"},
           {"lab_runs", "made_by"},         {"webhooks", "made_by"},
           {"lti_platforms", "made_by"},    {"record_stores", "made_by"},
           {"group_rules", "made_by"}})
    out.push_back(renamed(table, column));
  out.push_back({"study_events",
                 {},
                 "update study_events set who = :alias where who = :name and not exists (select 1 "
                 "from stations s where s.name = study_events.who)"});
  out.push_back(
      {"trial_comments", {}, "update trial_comments set by_name = :alias where by_id = :account"});
  out.push_back(
      {"assignment_entries",
       {},
       "update assignment_entries set words = title || ' ' || cohort_name || ' ' || :alias "
       "where made_by_id = :account"});
  out.push_back(
      {"accounts",
       {},
       "update accounts set name = :alias, password_hash = '', state = 'disabled', "
       "pseudonym = null, badge = null, pin_hash = null, totp_secret = null, totp_confirmed "
       "= 0, totp_step = 0, must_change = 0, level = '', language = '' where id = :account"});
  return out;
}

}  // namespace

const std::vector<ErasureStep>& erasure_steps() {
  static const std::vector<ErasureStep> kSteps = [] {
    std::vector<ErasureStep> out;
    for (auto part : {account_steps(), erased_trial_steps(), kept_trial_steps(), assignment_steps(),
                      name_steps()})
      out.insert(out.end(), part.begin(), part.end());
    return out;
  }();
  return kSteps;
}

}  // namespace tractus::store
