#include "server/api/cohort/analysis_file_schemas.hpp"

#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

using namespace schema;
using core::Json;

Json lock_schema() {
  return object({{"who", text("Name of the person who locked the plan")},
                 {"utc", text("Time of the lock, UTC, ISO 8601")},
                 {"data_seen", truth("True if the data were known when the plan was locked")},
                 {"sha256", text("SHA-256 of the plan without its lock")}});
}

Json planned_analysis_schema() {
  return object(
      {{"id", text("Id of the analysis within the plan")},
       {"question", optional(text("What the analysis answers, one sentence"))},
       {"family",
        optional(text("Tests of a family are corrected together; empty: described, not tested"))},
       {"method", text("Statistical method of `tractus stats`")},
       {"formula", optional(text("Formula with columns of the cohort table"))},
       {"where", optional(text("Condition on the rows that are used"))},
       {"options", optional(method_options_schema())},
       {"term", optional(text("Term whose test counts; empty: all tests of the method"))}});
}

Json planned_comparison_schema() {
  const Json place = object({{"analysis", text("Id of an analysis of the plan")},
                             {"at", text("JSON pointer to a number in its report")}});
  return object(
      {{"where", text("Place in the publication, for example Table 3")},
       {"says", optional(text("What is printed there"))},
       {"remark", optional(text("Remark; {0}, {1}, … stand for the numbers"))},
       {"analysis", optional(text("Id of the analysis that computes the number"))},
       {"at", optional(text("JSON pointer to the number in its report"))},
       {"printed", optional(number("the number's", "The printed number"))},
       {"within", optional(number("the number's", "Largest difference that counts as equal"))},
       {"numbers", optional(array(place, "Numbers that the remark names"))}});
}

/// A number, a word or nothing.
Json cell_schema() {
  return {{"type", Json::array({"number", "string", "boolean", "null"})},
          {"x-unit", "the column's"},
          {"description", "A number, a word, true or false; null: it does not exist"}};
}

/// The members that every method writes, then blocks and tables of its own.
Json report_schema() {
  Json out = object({{"method", text("Statistical method of `tractus stats`")},
                     {"formula", optional(text("Formula"))},
                     {"rows", optional(integer("1", "Number of rows that were used"))},
                     {"rows_left_out", optional(integer("1", "Rows with an empty cell"))},
                     {"notes", optional(array(text("One sentence"), "Remarks on the result"))}});
  const Json list = array(cell_schema(), "Several values");
  const Json row =
      map(any_of({cell_schema(), list}, "Value, or several"), "A block, or a row of a table");
  out["additionalProperties"] = any_of(
      {cell_schema(), row,
       array(any_of({row, cell_schema()}, "Row of a table, or a value"), "A table, row by row")},
      "Block or table of the method");
  return out;
}

Json panel_schema() {
  const Json numbers = array(nullable(number("the axis'", "Coordinate")), "Coordinates");
  const Json line = object({{"label", text("Name in the legend; may be empty")},
                            {"x", numbers},
                            {"y", numbers},
                            {"points", truth("True if points are drawn, no line")}});
  const Json ribbon = object({{"label", text("Name in the legend; may be empty")},
                              {"x", numbers},
                              {"low", numbers},
                              {"high", numbers}});
  const Json mark = object({{"at", number("the axis'", "Place on the axis")},
                            {"label", text("Text beside the mark; may be empty")}});
  return object({{"title", text("Title of the panel")},
                 {"x_label", text("Label of the horizontal axis")},
                 {"y_label", text("Label of the vertical axis")},
                 {"group_names",
                  array(text("Name of a group"), "Names of x = 1, 2, …; empty: x is a number")},
                 {"lines", array(line, "Curves and points")},
                 {"ribbons", array(ribbon, "Bands between two curves")},
                 {"marks", array(mark, "Marked places")}});
}

Json test_schema() {
  const Json figure = nullable(number("the statistic's", "Value; null: it does not exist"));
  const Json p = nullable(number("1", "Probability; null: it does not exist"));
  return object({{"analysis", text("Id of the analysis")},
                 {"term", text("Term that was tested")},
                 {"p", p},
                 {"p_adjusted", p},
                 {"holds", truth("True if the adjusted p is at most alpha")},
                 {"note", optional(text("Why there is no test"))},
                 {"statistic", optional(text("Name of the statistic: t, F, z, chi2 or exact"))},
                 {"value", optional(figure)},
                 {"df1", optional(figure)},
                 {"df2", optional(figure)},
                 {"effect", optional(text("What size is: slope, Cohen's d, …"))},
                 {"size", optional(figure)},
                 {"ci95_low", optional(figure)},
                 {"ci95_high", optional(figure)}});
}

Json result_plan_schema() {
  return object(
      {{"title", text("Title of the plan")},
       {"question", text("Question of the plan")},
       {"endpoint", text("Endpoint; may be empty")},
       {"subject", text("Column that names the subjects; may be empty")},
       {"alpha", number("1", "Level of significance")},
       {"correction", text("Correction for multiplicity")},
       {"sha256", text("SHA-256 of the plan without its lock")},
       {"lock", optional(object({{"who", text("Name of the person who locked it")},
                                 {"utc", text("Time of the lock, UTC, ISO 8601")},
                                 {"data_seen", truth("True if the data were known")}}))}});
}

Json result_data_schema() {
  const Json exclusion = object({{"where", text("Condition on the rows")},
                                 {"reason", text("Reason of the exclusion")},
                                 {"rows", integer("1", "Rows that it leaves out")}});
  return object({{"name", text("Name of the data")},
                 {"sha256", text("SHA-256 of the data")},
                 {"frozen_utc", text("Time of freezing, UTC, ISO 8601; may be empty")},
                 {"source", text("Origin of the data; may be empty")},
                 {"simulated", truth("True if some of the data are simulated")},
                 {"rows", integer("1", "Number of rows")},
                 {"rows_used", integer("1", "Number of rows after the exclusions")},
                 {"subjects", integer("1", "Number of subjects; 0: not known")},
                 {"exclusions", array(exclusion, "Exclusions of the plan")}});
}

Json analysed_schema() {
  return object({{"id", text("Id of the analysis")},
                 {"question", text("What it answers; may be empty")},
                 {"family", text("Family of its tests; may be empty")},
                 {"method", text("Statistical method")},
                 {"formula", text("Formula; may be empty")},
                 {"where", text("Condition on the rows; may be empty")},
                 {"options", map(text("A word or a number"), "Options of the method by name")},
                 {"report", optional(ref("AnalysisReport"))},
                 {"figures", optional(array(ref("AnalysisFigure"), "Figures of the method"))},
                 {"error", optional(text("Why the analysis could not be done"))}});
}

Json compared_schema() {
  return object(
      {{"where", text("Place in the publication")},
       {"says", text("What is printed there; may be empty")},
       {"remark", text("Remark; may be empty")},
       {"printed", optional(number("the number's", "The printed number"))},
       {"computed", optional(nullable(number("the number's", "Our number; null: none")))},
       {"agrees", optional(truth("True if both are equal within the plan's tolerance"))}});
}

Json column_schema() {
  return object({{"name", text("Name of the column")},
                 {"kind", one_of({"number", "text"}, "What its cells are")},
                 {"unit", optional(text("Unit"))},
                 {"meaning", optional(text("Meaning of the column"))},
                 {"missing", integer("1", "Number of empty cells")},
                 {"lowest", optional(number("the column's", "Smallest number"))},
                 {"highest", optional(number("the column's", "Largest number"))},
                 {"levels", optional(array(text("A value"), "Values of a column of texts"))},
                 {"different_values", optional(integer("1", "Number of values if over 50"))}});
}

}  // namespace

Json method_options_schema() {
  return map(any_of({text("A word"), number("the option's", "A number")}, "Value of the option"),
             "Options of the method by name, as `tractus stats METHOD --help` lists them");
}

std::vector<NamedSchema> plan_file_schemas() {
  const Json exclusion = object(
      {{"where", text("Condition on the rows")}, {"reason", text("Reason of the exclusion")}});
  return {
      {"PlannedAnalysis", planned_analysis_schema()},
      {"PlanFile",
       object({{"format", file_format("tractus-plan/1")},
               {"title", text("Title of the plan")},
               {"question", text("Question of the plan")},
               {"endpoint", optional(text("Endpoint"))},
               {"subject", optional(text("Column that names the subjects"))},
               {"alpha", optional(number("1", "Level of significance; default 0.05"))},
               {"correction", optional(one_of({"holm", "hommel", "hochberg", "bonferroni",
                                               "benjamini-hochberg", "benjamini-yekutieli", "none"},
                                              "Correction for multiplicity; default holm"))},
               {"exclusions", optional(array(exclusion, "Rows that are left out"))},
               {"analyses", array(ref("PlannedAnalysis"), "Analyses, one at least")},
               {"published", optional(array(planned_comparison_schema(),
                                            "Published numbers that are compared"))},
               {"lock", optional(lock_schema())}})}};
}

std::vector<NamedSchema> analysis_file_schemas() {
  const Json count = integer("1", "Number of trials");
  const Json family = object({{"name", text("Name of the family")},
                              {"correction", text("Correction for multiplicity")},
                              {"alpha", number("1", "Level of significance")},
                              {"tests", array(test_schema(), "Tests of the family")}});
  const Json sentences = array(text("One sentence"), "Sentences for a publication");
  return {
      {"AnalysisReport", report_schema()},
      {"AnalysisFigure", object({{"note", text("Note below the figure; may be empty")},
                                 {"panels", array(panel_schema(), "Panels, side by side")}})},
      {"AnalysisResult", object({{"format", file_format("tractus-result/1")},
                                 {"plan", result_plan_schema()},
                                 {"data", result_data_schema()},
                                 {"analyses", array(analysed_schema(), "Analyses of the plan")},
                                 {"families", array(family, "Tests, corrected by family")},
                                 {"published", array(compared_schema(), "Published numbers")},
                                 {"methods", sentences},
                                 {"results", sentences}})},
      {"Snapshot", object({{"format", file_format("tractus-snapshot/1")},
                           {"name", text("Name of the data")},
                           {"frozen_utc", text("Time of freezing, UTC, ISO 8601")},
                           {"simulated", truth("True if some of the data are simulated")},
                           {"source", text("Origin of the data")},
                           {"file", text("Name of the file with the rows")},
                           {"sha256", text("SHA-256 of the rows")},
                           {"rows", integer("1", "Number of rows")},
                           {"rows_simulated", integer("1", "Number of rows of simulated trials")},
                           {"left_out", object({{"invalid", count},
                                                {"unscored", count},
                                                {"without_consent", count},
                                                {"blind", count}})},
                           {"dictionary", array(column_schema(), "Columns, in order")}})}};
}

}  // namespace api
}  // namespace tractus
