/// What the methods share: the parts of a report, and a report as text.
#pragma once

#include <optional>

#include "assessment/method.hpp"
#include "assessment/pictures.hpp"
#include "statistics/anova/anova.hpp"

namespace tractus::assessment {

/// The members every report begins with.
core::Json report_head(const Analysis& of, const char* method);

/// One row per coefficient: "name", then the given columns.
core::Json coefficient_table(
    const std::vector<std::string>& names,
    const std::vector<std::pair<const char*, const statistics::Vector*>>& columns);

/// One test of a report's "tests": what a plan corrects for multiplicity and writes sentences of.
struct Test {
  std::string term;       ///< what was tested: "experience_years", "repetition"
  std::string statistic;  ///< "t", "F", "z", "chi2", "exact"
  double value = 0.0;
  double df1 = 0.0, df2 = 0.0;  ///< 0: it has none
  double p = 0.0;
  std::string effect = {};                   ///< what `size` is: "slope", "Cohen's d"; may be empty
  double size = 0.0, low = 0.0, high = 0.0;  ///< with 95 % interval, NaN where there is none

  core::Json to_json() const;
};

/// One entry of "checks": an assumption, what was found, what to do.
core::Json check_row(const std::string& assumption, const std::string& found, double p,
                     const std::string& advice);
/// Normality of residuals, by Shapiro–Wilk for 3 to 5000 of them, with a note for more.
core::Json normality_check(const statistics::Vector& residuals);

/// The error with the file's name in front.
core::Error located(const Analysis& of, const core::Error& error);
/// Design and response of a regression. Errors: bad_input for (1|group) unless `grouped`, for
/// successes/trials, and as model_matrix().
struct Problem {
  ModelMatrix model;
  statistics::Vector y;
  const statistics::Design& design() const { return model.design; }
};
core::Result<Problem> problem_of(const Analysis& of, bool grouped);

/// The response against the one predictor of the formula: its groups (means of persons where the
/// formula has (1|group)), or the points with `lines` for a number. Nothing for other formulas.
std::optional<plot::Figure> predictor_picture(const Analysis& of, const Problem& problem,
                                              const std::vector<RegressionLine>& lines);

/// Labels of (1|group), one per row.
std::vector<std::string> group_labels(const Analysis& of);

/// The one column whose levels are compared. Errors: bad_input for any other shape of formula.
core::Result<std::string> single_column(const Analysis& of, const char* method);

/// The response by level, in the order of levels_of().
statistics::Groups groups_in_order(const Table& table, const std::string& column,
                                   const statistics::Vector& y);

/// The mean of each label of (1|group) within each level of the column: one value per person.
statistics::Groups group_means(const Analysis& of, const std::string& column,
                               const statistics::Vector& y);

/// Subjects by cells (combinations of the within-subject levels), every cell exactly once.
struct Cells {
  std::vector<std::string> subjects;
  std::vector<std::vector<std::string>> levels;  ///< per factor
  std::vector<std::string> names;                ///< per cell: "lateral, 2"
  statistics::Matrix values;                     ///< [subject][cell], the last factor fastest
};
/// Errors: bad_input naming the subject and the cell that has no row, or more than one.
core::Result<Cells> cells_of(const Analysis& of, const std::vector<std::string>& within,
                             const statistics::Vector& y);

/// The rows of each label of a column, labels in the order of levels_of().
struct Parts {
  std::vector<std::string> names;
  std::vector<std::vector<std::size_t>> rows;
};
Parts parts_of(const Table& table, const std::string& column);

/// The report for a terminal: blocks as lines, tables aligned (the first 40 rows); "tests" repeats
/// what stands there and is left out.
std::string printed(const core::Json& report);

}  // namespace tractus::assessment
