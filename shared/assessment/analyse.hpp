/// Runs a plan on a table: exclusions, every analysis, corrections for multiplicity, sentences.
///
/// The result is a pure function of plan and data: no time, no path, no randomness in it, so a
/// second run gives the same bytes.
#pragma once

#include "assessment/method.hpp"
#include "assessment/plan.hpp"

namespace tractus::assessment {

/// Where the data come from, for the report; what is not known stays empty.
struct Provenance {
  std::string name, sha256, frozen_utc, source;
  bool simulated = false;
};

/// `result` ("tractus-result/1"):
///
///     {"format","plan":{title, question, endpoint, sha256, lock},"data":{name, sha256, rows,
///      rows_used, subjects, exclusions:[{where, reason, rows}]},
///      "analyses":[{id, question, method, formula, where, report and figures | error}],
///      "families":[{name, correction, alpha, tests:[{analysis, term, …, p, p_adjusted, holds}]}],
///      "published":[{where, says, printed, computed, agrees, remark}],
///      "methods":["sentence", …],"results":["sentence", …]}
struct Analysed {
  core::Json result;
  std::vector<std::vector<plot::Figure>> figures;  ///< per analysis
  std::vector<std::string> excluded_because;       ///< per row of the table; "" for rows used
};

/// @param table  every column the plan needs, empty cells kept (Missing::keep). Rows with an empty
///   cell in a column that an analysis uses are left out of that analysis and counted.
/// An analysis that cannot be done is an "error" in the result, and its tests count in the
/// correction as if p were 1. Errors: bad_input where an exclusion cannot be read off the table, or
/// leaves no row; cancelled where `progress` asked to stop.
core::Result<Analysed> analyse(const Plan& plan, const Table& table,
                               const Provenance& provenance = {},
                               const core::Progress& progress = {});

/// "F(1.94, 17.5) = 5.97, p = 0.011, generalised eta squared 0.214" of a test's JSON.
std::string worded(const core::Json& test);
/// "p = 0.0231", "p < 0.001".
std::string worded_p(double p);

}  // namespace tractus::assessment
