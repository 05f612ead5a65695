#include "assessment/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/try.hpp"
#include "statistics/summary/shapiro_wilk.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;

constexpr std::size_t kShownRows = 40;

std::string printed_cell(const Json& value) {
  if (value.is_null()) return "-";
  if (value.is_number_integer()) return fmt::format("{}", value.get<long>());
  if (value.is_number()) {
    const double number = value.get<double>();
    if (number != number) return "-";
    return fmt::format("{:.6g}", number);
  }
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string table_text(const std::string& title, const Json& rows) {
  std::vector<std::string> keys;
  for (const auto& [key, _] : rows[0].items()) keys.push_back(key);
  const std::size_t shown = std::min(rows.size(), kShownRows);
  std::string out = "\n" + title + "\n";
  std::vector<std::size_t> widths;
  for (const auto& key : keys) {
    std::size_t width = key.size();
    for (std::size_t i = 0; i < shown; ++i)
      width = std::max(width, printed_cell(rows[i][key]).size());
    widths.push_back(width);
  }
  const auto line = [&](const std::function<std::string(const std::string&)>& text_of) {
    for (std::size_t j = 0; j < keys.size(); ++j)
      out += j == 0 ? fmt::format("  {:<{}}", text_of(keys[j]), widths[j])
                    : fmt::format("  {:>{}}", text_of(keys[j]), widths[j]);
    out += "\n";
  };
  line([](const std::string& key) { return key; });
  for (std::size_t i = 0; i < shown; ++i)
    line([&](const std::string& key) { return printed_cell(rows[i][key]); });
  if (shown < rows.size()) out += fmt::format("  … and {} more (--json)\n", rows.size() - shown);
  return out;
}

std::string block_text(const std::string& title, const Json& block) {
  std::string out = "\n" + title + "\n";
  std::size_t width = 28;
  for (const auto& [key, value] : block.items()) width = std::max(width, key.size() + 2);
  for (const auto& [key, value] : block.items())
    out += fmt::format("  {:<{}}{}\n", key, width, printed_cell(value));
  return out;
}

}  // namespace

Json report_head(const Analysis& of, const char* method) {
  return {{"method", method},
          {"file", of.table.name()},
          {"formula", of.formula_text},
          {"rows", of.table.rows()},
          {"rows_left_out", of.table.dropped()}};
}

Json coefficient_table(
    const std::vector<std::string>& names,
    const std::vector<std::pair<const char*, const statistics::Vector*>>& columns) {
  Json out = Json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    Json row = {{"name", names[i]}};
    for (const auto& [key, values] : columns) row[key] = (*values)[static_cast<Eigen::Index>(i)];
    out.push_back(std::move(row));
  }
  return out;
}

Json Test::to_json() const {
  Json out = {{"term", term}, {"statistic", statistic}, {"value", value}};
  if (df1 > 0.0) out["df1"] = df1;
  if (df2 > 0.0) out["df2"] = df2;
  out["p"] = p;
  if (effect.empty()) return out;
  out["effect"] = effect;
  out["size"] = size;
  if (std::isfinite(low) || std::isfinite(high)) {
    out["ci95_low"] = low;
    out["ci95_high"] = high;
  }
  return out;
}

Json check_row(const std::string& assumption, const std::string& found, double p,
               const std::string& advice) {
  return {{"assumption", assumption}, {"found", found}, {"p", p}, {"advice", advice}};
}

Json normality_check(const statistics::Vector& residuals) {
  const char* name = "residuals are normal";
  if (residuals.size() > 5000)
    return check_row(name, fmt::format("{} residuals: see the picture", residuals.size()),
                     std::nan(""), "with so many, means are normal whatever the residuals are");
  const auto test = statistics::shapiro_wilk(residuals);
  if (!test) return check_row(name, test.error().what, std::nan(""), "not judged");
  return check_row(name, fmt::format("Shapiro-Wilk W = {:.4f}", test->w), test->p,
                   test->p < 0.05 ? "compare with the robust or the rank test"
                                  : "nothing against it, which in few rows says little");
}

core::Error located(const Analysis& of, const core::Error& error) {
  return {error.code, of.table.name() + ": " + error.what};
}

core::Result<Problem> problem_of(const Analysis& of, bool grouped) {
  if (!grouped && !of.formula.group.empty())
    return core::bad_input("(1|" + of.formula.group + ") needs 'lmm': this method knows no groups");
  if (!of.formula.trials.empty() || of.formula.trials_number != 1)
    return core::bad_input("successes/trials on the left is for counts, as 'logistic' takes them");
  auto model = TRY(model_matrix(of.formula, of.table));
  auto y = TRY(of.table.numbers(of.formula.response));
  return Problem{std::move(model), std::move(y)};
}

std::vector<std::string> group_labels(const Analysis& of) {
  const auto& cells = of.table.texts(of.formula.group);
  return {cells.begin(), cells.end()};
}

core::Result<std::string> single_column(const Analysis& of, const char* method) {
  if (of.formula.terms.size() != 1 || of.formula.terms[0].variables.size() != 1 ||
      !of.formula.trials.empty() || of.formula.trials_number != 1 || !of.formula.intercept)
    return core::bad_input(
        fmt::format("{} compares the levels of one column: write y ~ column", method));
  return of.formula.terms[0].variables[0].column;
}

Parts parts_of(const Table& table, const std::string& column) {
  Parts out{levels_of(table, column), {}};
  out.rows.resize(out.names.size());
  const auto places = places_of(table, column, out.names);
  for (std::size_t i = 0; i < places.size(); ++i) out.rows[places[i]].push_back(i);
  return out;
}

statistics::Groups groups_in_order(const Table& table, const std::string& column,
                                   const statistics::Vector& y) {
  auto names = levels_of(table, column);
  const auto places = places_of(table, column, names);
  return statistics::grouped(places, std::move(names), y);
}

statistics::Groups group_means(const Analysis& of, const std::string& column,
                               const statistics::Vector& y) {
  const Parts levels = parts_of(of.table, column);
  const auto persons = levels_of(of.table, of.formula.group);
  const auto who = places_of(of.table, of.formula.group, persons);
  std::vector<double> means;
  std::vector<std::size_t> places;
  for (std::size_t level = 0; level < levels.names.size(); ++level) {
    std::vector<double> sums(persons.size(), 0.0), numbers(persons.size(), 0.0);
    for (const std::size_t row : levels.rows[level]) {
      sums[who[row]] += y[static_cast<Eigen::Index>(row)];
      numbers[who[row]] += 1.0;
    }
    for (std::size_t k = 0; k < persons.size(); ++k) {
      if (numbers[k] == 0.0) continue;
      means.push_back(sums[k] / numbers[k]);
      places.push_back(level);
    }
  }
  return statistics::grouped(places, levels.names,
                             Eigen::Map<const statistics::Vector>(means.data(), std::ssize(means)));
}

std::optional<plot::Figure> predictor_picture(const Analysis& of, const Problem& problem,
                                              const std::vector<RegressionLine>& lines) {
  if (of.formula.terms.size() != 1 || of.formula.terms[0].variables.size() != 1) return {};
  const Variable& variable = of.formula.terms[0].variables[0];
  const std::string& response = of.formula.response;
  if (variable.as == Variable::As::factor || !of.table.is_numeric(variable.column)) {
    const bool repeated = !of.formula.group.empty();
    return group_picture(variable.column,
                         repeated ? group_means(of, variable.column, problem.y)
                                  : groups_in_order(of.table, variable.column, problem.y),
                         repeated ? response + ", mean of each " + of.formula.group : response);
  }
  if (problem.design().columns.cols() != 2 || !problem.design().intercept) return {};
  return scatter_picture(problem.design().names[1], problem.design().columns.col(1), response,
                         problem.y, lines);
}

namespace {

/// Names of all combinations, the last factor fastest.
std::vector<std::string> combinations(const std::vector<std::vector<std::string>>& levels) {
  std::vector<std::string> out{""};
  for (const auto& own : levels) {
    std::vector<std::string> next;
    for (const auto& before : out)
      for (const auto& level : own) next.push_back(before.empty() ? level : before + ", " + level);
    out = std::move(next);
  }
  return out;
}

}  // namespace

core::Result<Cells> cells_of(const Analysis& of, const std::vector<std::string>& within,
                             const statistics::Vector& y) {
  Cells out;
  const std::string& group = of.formula.group;
  out.subjects = levels_of(of.table, group);
  std::vector<std::size_t> place(of.table.rows(), 0);
  std::size_t cells = 1;
  for (const auto& column : within) {
    out.levels.push_back(levels_of(of.table, column));
    const auto own = places_of(of.table, column, out.levels.back());
    cells *= out.levels.back().size();
    for (std::size_t i = 0; i < place.size(); ++i)
      place[i] = place[i] * out.levels.back().size() + own[i];
    if (out.subjects.size() * cells > 2 * of.table.rows())
      return core::bad_input(
          fmt::format("{}: {} subjects × {} levels, but {} rows: most cells are empty",
                      of.table.name(), out.subjects.size(), cells, of.table.rows()));
  }
  out.names = combinations(out.levels);
  const auto who = places_of(of.table, group, out.subjects);
  out.values.setConstant(std::ssize(out.subjects), std::ssize(out.names), std::nan(""));
  for (std::size_t i = 0; i < who.size(); ++i) {
    double& cell =
        out.values(static_cast<Eigen::Index>(who[i]), static_cast<Eigen::Index>(place[i]));
    if (!std::isnan(cell))
      return core::bad_input(
          fmt::format("{}: {} '{}' has more than one row for '{}': average them first, or use lmm",
                      of.table.name(), group, out.subjects[who[i]], out.names[place[i]]));
    cell = y[static_cast<Eigen::Index>(i)];
  }
  for (Eigen::Index i = 0; i < out.values.rows(); ++i)
    for (Eigen::Index j = 0; j < out.values.cols(); ++j)
      if (std::isnan(out.values(i, j)))
        return core::bad_input(fmt::format(
            "{}: {} '{}' has no row for '{}' (lmm takes such data)", of.table.name(), group,
            out.subjects[static_cast<std::size_t>(i)], out.names[static_cast<std::size_t>(j)]));
  return out;
}

std::string printed(const Json& report) {
  std::string out = report["method"].get<std::string>();
  if (report.contains("file"))
    out += fmt::format(": {}\n{}, {} rows", report["formula"].get<std::string>(),
                       report["file"].get<std::string>(), report["rows"].get<long>());
  if (const long dropped = report.value("rows_left_out", 0L); dropped > 0)
    out += fmt::format(", {} left out for missing values", dropped);
  out += "\n";
  for (const auto& [key, value] : report.items()) {
    std::string title = key;
    std::ranges::replace(title, '_', ' ');
    if (key == "notes" || key == "tests") continue;
    const bool head = key == "method" || key == "file" || key == "formula";
    if (value.is_string() && !head) out += fmt::format("\n{}: {}\n", title, printed_cell(value));
    if (value.is_object()) out += block_text(title, value);
    if (value.is_array() && !value.empty()) out += table_text(title, value);
  }
  if (!report.contains("notes")) return out;
  for (const auto& note : report["notes"]) out += "\nNote: " + note.get<std::string>() + "\n";
  return out;
}

}  // namespace assessment
}  // namespace tractus
