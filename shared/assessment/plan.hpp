/// An analysis plan: what will be asked of the data, written down and locked before they are seen.
///
///     {"format":"tractus-plan/1","title":"…","question":"…","endpoint":"…","subject":"surgeon",
///      "alpha":0.05,"correction":"holm",
///      "exclusions":[{"where":"operation_time_s > 300","reason":"interrupted"}],
///      "analyses":[{"id":"learning","question":"…","family":"primary","method":"rm-anova",
///                   "formula":"v ~ repetition + (1|surgeon)","where":"scenario = lateral",
///                   "options":{},"term":"repetition"}],
///      "published":[{"where":"Table 3","says":"…","printed":0.1588,"within":1e-4,
///                    "analysis":"learning","at":"/coefficients/1/estimate"}],
///      "lock":{"who":"…","utc":"…","data_seen":false,"sha256":"…"}}
///
/// The hash is of the plan without its lock, written compactly with its members in their order, so
/// that layout may change and a word may not. See shared/doc/formats.md.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "assessment/filter.hpp"
#include "core/json.hpp"
#include "statistics/summary/p_adjust.hpp"

namespace tractus::assessment {

struct Exclusion {
  Filter filter;
  std::string where, reason;
};

struct PlannedAnalysis {
  std::string id;        ///< unique: letters, digits, "-"
  std::string question;  ///< what it answers, one sentence
  std::string family;    ///< tests of a family are corrected together; "" : described, not tested
  std::string method, formula;
  std::map<std::string, std::string> options;
  std::string term;              ///< the one test that counts; empty: all it gives
  std::optional<Filter> filter;  ///< of "where": the rows it is of
  std::string where;
};

/// Something that was printed elsewhere, held against what is computed here.
struct Published {
  std::string where;              ///< "section 6.2"
  std::string says;               ///< what is printed there
  std::string remark;             ///< what is to be known; {0} {1} … stand for `numbers`
  std::string analysis, at;       ///< where our number is: an analysis and a JSON pointer
  std::optional<double> printed;  ///< absent: a remark alone
  double within = 0.0;
  std::vector<std::pair<std::string, std::string>> numbers;  ///< analysis, pointer
};

struct Lock {
  std::string who, utc;
  bool data_seen = false;  ///< the data were known to whoever locked it: no confirmation
  std::string sha256;
};

struct Plan {
  std::string title, question, endpoint, subject;
  double alpha = 0.05;
  std::string correction = "holm";  ///< of the primary families
  std::vector<Exclusion> exclusions;
  std::vector<PlannedAnalysis> analyses;
  std::vector<Published> published;
  std::optional<Lock> lock;
  std::string sha256;  ///< of what was read, without its lock

  /// Errors: bad_input naming `name` and the field: an unknown method, option or formula, an id
  /// used twice, a published number of an analysis that is not there.
  static core::Result<Plan> from_json(const core::Json& json, const std::string& name);
};

/// The hash that a lock holds.
std::string plan_sha256(core::Json plan);

/// The plan with its lock. Errors: as Plan::from_json; conflict when it is locked already;
/// bad_input for an empty name.
core::Result<core::Json> locked(const core::Json& plan, const std::string& name, const Lock& by);

/// Errors: conflict when it is not locked, or was changed after that.
core::Result<void> check_lock(const Plan& plan, const std::string& name);

/// A plan to start from.
core::Json example_plan();

/// "holm" … as an adjustment; nothing for "none" and unknown words.
std::optional<statistics::Adjustment> adjustment_named(const std::string& name);

}  // namespace tractus::assessment
