/// What becomes of every table when a person leaves. A new table is decided here; erasure_test.cpp names those that are not.
#include "db/store/people/erasure.hpp"

namespace tractus::store {
namespace {

using enum Fate;

constexpr const char* kNobody = "about nobody";
constexpr const char* kNameOfMaker =
    "work for others; the name of who made it gives way to the alias";
constexpr const char* kOthers = "assessment of others; the name gives way to the alias";
constexpr const char* kPseudonym = "by a pseudonym that nothing links to the person any more";

}  // namespace

const std::vector<TableDecision>& table_decisions() {
  static const std::vector<TableDecision> kDecisions{
      {"people", "accounts", changed, changed, "account",
       "an empty row without name, password, badge and pseudonym, on which others' rows rest"},
      {"people", "sessions", removed, removed, "sessions", ""},
      {"people", "known_origins", removed, removed, "networks of sign-ins", ""},
      {"people", "sign_in_failures", removed, removed, "failed sign-ins", ""},
      {"people", "oidc_subjects", removed, removed, "link to the identity provider",
       "of links that the person made for others, the name gives way to the alias"},
      {"people", "group_rules", changed, changed, "rules of groups that the person made",
       kNameOfMaker},
      {"people", "group_accounts", removed, removed, "link to the groups of the provider", ""},
      {"people", "cohorts", changed, changed, "cohorts that the person made", kNameOfMaker},
      {"people", "cohort_people", removed, removed, "memberships of cohorts", ""},
      {"people", "cohort_invitations", removed, removed, "invitations into cohorts",
       "of invitations that the person sent, the name gives way to the alias"},
      {"people", "consents", removed, changed, "consents",
       "for trials that stay, the consent stays with the pseudonym, without samples: motion "
       "identifies people"},
      {"people", "pseudonym_keys", none, none, "", kNobody},
      {"people", "api_tokens", removed, removed, "API tokens", ""},
      {"people", "api_token_uses", removed, removed, "last uses of API tokens", ""},
      {"people", "retention_notices", removed, removed, "retention notices", ""},
      {"people", "retention_rules", changed, changed, "retention rules that the person made",
       kNameOfMaker},
      {"people", "erasures", kept, kept, "the erasure itself",
       "a number and the account's opaque id, so that a restored backup is erased again"},
      {"people", "erased_trials", kept, kept, "ids of erased trials",
       "opaque ids, so that no station hands them over again"},
      {"people", "erased_slots", kept, kept, "ids of slots that were not done",
       "opaque ids, so that a station that still has one is told so"},
      {"finding", "trial_entries", removed, changed, "trials in lists", kPseudonym},
      {"finding", "assignment_entries", changed, changed, "assignments in lists", kNameOfMaker},
      {"finding", "assigned_progress", removed, removed, "progress in assignments", ""},
      {"finding", "saved_views", removed, removed, "saved views", ""},
      {"stations", "stations", none, none, "", kNobody},
      {"stations", "enrolment_codes", none, none, "", kNobody},
      {"stations", "station_states", none, none, "", "replaced by the station's next state"},
      {"stations", "station_reports", none, none, "", kNobody},
      {"stations", "station_models", changed, changed, "models that the person sent", kNameOfMaker},
      {"volumes", "objects", removed, kept, "recordings", kPseudonym},
      {"volumes", "volumes", changed, changed, "volumes that the person brought in or released",
       kNameOfMaker},
      {"volumes", "pacs_imports", removed, removed, "imports from the PACS", ""},
      {"cases", "cases", none, none, "", kNobody},
      {"cases", "case_parts", none, none, "", kNobody},
      {"cases", "case_makings", changed, changed, "cases that the person had made", kNameOfMaker},
      {"cases", "scenario_versions", changed, changed, "scenarios that the person wrote",
       kNameOfMaker},
      {"trials", "uploads", removed, kept, "uploads", kPseudonym},
      {"trials", "trials", removed, kept, "trials", kPseudonym},
      {"trials", "trial_metrics", removed, kept, "scores", kPseudonym},
      {"trials", "trial_clocks", removed, kept, "clocks of trials", kPseudonym},
      {"trials", "trial_comments", removed, removed, "comments on the person's trials",
       "of comments that the person wrote on others' trials, the name gives way to the alias"},
      {"trials", "reference_trials", removed, changed, "trials offered as examples", kPseudonym},
      {"trials", "rubrics", changed, changed, "rubrics that the person wrote", kNameOfMaker},
      {"trials", "rating_requests", removed, changed, "requests for ratings", kPseudonym},
      {"trials", "ratings", removed, changed, "ratings of the person's trials",
       "ratings that the person gave to others stay, by the alias; of ratings that stay, the "
       "comment is removed"},
      {"studies", "studies", changed, changed, "studies and assignments that the person made",
       kNameOfMaker},
      {"studies", "study_scenarios", none, none, "", kNobody},
      {"studies", "study_participants", removed, kept, "places in assignments", kPseudonym},
      {"studies", "study_slots", removed, changed, "trials to be done or done in assignments",
       kPseudonym},
      {"studies", "study_trials", removed, kept, "trials' places in assignments", kPseudonym},
      {"studies", "study_events", changed, changed, "changes in assignments",
       "by a pseudonym or the alias; the reasons, which are free text, are removed"},
      {"studies", "assignments", kept, kept, "assignments that the person made", kOthers},
      {"studies", "assignment_people", removed, removed, "assignments of the person", ""},
      {"studies", "assignment_names", none, none, "", kNobody},
      {"studies", "criteria", changed, changed, "criteria that the person made", kNameOfMaker},
      {"studies", "curricula", changed, changed, "curricula that the person made", kNameOfMaker},
      {"studies", "curriculum_steps", none, none, "", kNobody},
      {"cohort", "analysis_plans", changed, changed, "analysis plans that the person locked",
       "locked plans stay; who locked it gives way to the alias in the records, not in the locked "
       "file"},
      {"cohort", "analyses", changed, changed, "analyses that the person ran",
       "a locked analysis keeps its frozen data by pseudonym; they are handed out no more when a "
       "trial of them is gone"},
      {"lab", "models", changed, changed, "models that the person made", kNameOfMaker},
      {"lab", "measurement_sets", changed, changed, "measurement sets that the person brought in",
       kNameOfMaker},
      {"lab", "lab_runs", changed, changed, "runs of the lab that the person began", kNameOfMaker},
      {"operations", "jobs", removed, kept, "scoring jobs", kPseudonym},
      {"operations", "audit", changed, changed, "rows of the audit trail",
       "the trail stays; the name gives way to the alias"},
      {"operations", "notification_addresses", removed, removed, "address for notifications", ""},
      {"operations", "notification_choices", removed, removed, "choices of notifications", ""},
      {"operations", "webhooks", changed, changed, "webhooks that the person stated", kNameOfMaker},
      {"operations", "notification_events", kept, kept, "events that were told", "opaque ids"},
      {"operations", "deliveries", removed, removed, "messages to the person", ""},
      {"operations", "delivery_events", removed, removed, "what the messages were about", ""},
      {"learning", "lti_platforms", changed, changed, "learning platforms that the person stated",
       kNameOfMaker},
      {"learning", "lti_nonces", none, none, "", kNobody},
      {"learning", "lti_line_items", removed, removed,
       "places in the gradebooks of learning platforms", ""},
      {"learning", "lti_keys", none, none, "", kNobody},
      {"learning", "record_stores", changed, changed,
       "learning record stores that the person stated", kNameOfMaker},
      {"learning", "record_statements", removed, kept, "statements of trials to a record store",
       kPseudonym},
      {"operations", "redactions", kept, kept, "digests of rows of the audit trail", kNobody},
      {"operations", "schema_versions", none, none, "", kNobody}};
  return kDecisions;
}

}  // namespace tractus::store
