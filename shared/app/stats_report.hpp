/// An analysis as a report: made once as JSON, printed from that for people.
#pragma once

#include "app/stats_formula.hpp"
#include "core/json.hpp"

namespace commands {

/// What a method is run on.
struct Analysis {
  const Formula& formula;
  const Table& table;
  const std::string& formula_text;
};

/// Members of the report: "method", "file", "formula", "rows", "rows_left_out", then blocks
/// (objects of numbers), tables (arrays of objects) and "notes" (sentences). Numbers that do not
/// exist are null. Errors: bad_input, out_of_range, one line.
core::Result<core::Json> ols_report(const Analysis& of);
core::Result<core::Json> robust_report(const Analysis& of);
core::Result<core::Json> anova_report(const Analysis& of);
core::Result<core::Json> rm_anova_report(const Analysis& of);
core::Result<core::Json> lmm_report(const Analysis& of);
core::Result<core::Json> logistic_report(const Analysis& of);

/// The members every report begins with.
core::Json report_head(const Analysis& of, const char* method);
/// One row per coefficient: "name", then the given columns.
core::Json coefficient_table(
    const std::vector<std::string>& names,
    const std::vector<std::pair<const char*, const statistics::Vector*>>& columns);

/// The report for a terminal: blocks as lines, tables aligned (the first 40 rows).
std::string printed(const core::Json& report);

}  // namespace commands
