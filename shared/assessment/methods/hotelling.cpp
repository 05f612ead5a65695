/// Several responses at once: two groups, or the levels of a repeated measure.
#include "statistics/anova/hotelling.hpp"

#include <fmt/format.h>

#include "assessment/pictures.hpp"
#include "assessment/report.hpp"
#include "core/try.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using statistics::Hotelling;
using statistics::Matrix;
using statistics::Vector;

Findings found(const Analysis& of, const char* head, const std::string& term, const Hotelling& fit,
               const std::vector<std::string>& names) {
  Json out = report_head(of, head);
  out["analysis"] = {{"T_squared", fit.t_squared},
                     {"F", fit.f},
                     {"df1", fit.df1},
                     {"df2", fit.df2},
                     {"p", fit.p},
                     {"mahalanobis", fit.mahalanobis}};
  out["differences"] = coefficient_table(names, {{"mean_difference", &fit.means}});
  out["tests"] =
      Json::array({Test{term, "F", fit.f, fit.df1, fit.df2, fit.p, "Mahalanobis distance",
                        fit.mahalanobis, std::nan(""), std::nan("")}
                       .to_json()});
  return {std::move(out), {}};
}

/// The formula's variables as columns, each a number.
core::Result<Matrix> responses_of(const Analysis& of, const std::vector<std::string>& columns) {
  Matrix out(static_cast<Eigen::Index>(of.table.rows()), std::ssize(columns));
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const auto values = TRY(of.table.numbers(columns[j]));
    out.col(static_cast<Eigen::Index>(j)) = values;
  }
  return out;
}

core::Result<Findings> two_groups(const Analysis& of) {
  std::vector<std::string> columns;
  for (const auto& term : of.formula.terms) {
    if (term.variables.size() != 1 || term.variables[0].as != Variable::As::itself)
      return core::bad_input("hotelling takes plain columns: write group ~ response + response");
    columns.push_back(term.variables[0].column);
  }
  if (columns.empty())
    return core::bad_input("hotelling needs responses: group ~ response + response");
  const Parts parts = parts_of(of.table, of.formula.response);
  if (parts.names.size() != 2)
    return core::bad_input(fmt::format("{}: column '{}' has {} values; two groups are compared",
                                       of.table.name(), of.formula.response, parts.names.size()));
  const auto values = TRY(responses_of(of, columns));
  const auto fit = statistics::hotelling(Matrix(values(parts.rows[1], Eigen::all)),
                                         Matrix(values(parts.rows[0], Eigen::all)), columns);
  if (!fit) return located(of, fit.error());
  Findings out = found(of, "Hotelling's T squared, two groups", of.formula.response, *fit, columns);
  out.report["compared"] = parts.names[1] + " minus " + parts.names[0];
  return out;
}

core::Result<Findings> repeated(const Analysis& of) {
  const auto column = TRY(single_column(of, "hotelling"));
  const auto y = TRY(of.table.numbers(of.formula.response));
  const auto cells = TRY(cells_of(of, {column}, y));
  const auto k = cells.values.cols();
  if (k < 2)
    return core::bad_input(
        fmt::format("{}: column '{}' has one level: nothing to compare", of.table.name(), column));
  const Matrix steps = cells.values.rightCols(k - 1) - cells.values.leftCols(k - 1);
  std::vector<std::string> names;
  for (std::size_t j = 1; j < cells.names.size(); ++j)
    names.push_back(cells.names[j] + " minus " + cells.names[j - 1]);
  const auto fit = statistics::hotelling(steps, names);
  if (!fit) return located(of, fit.error());
  Findings out = found(of, "Hotelling's T squared, repeated measures", column, *fit, names);
  out.figures.push_back(profile_picture(cells.names, cells.values, of.formula.response));
  return out;
}

core::Result<Findings> run_hotelling(const Analysis& of) {
  return of.formula.group.empty() ? two_groups(of) : repeated(of);
}

}  // namespace

namespace methods {
Method hotelling_method() {
  return {"hotelling",
          "Several responses at once: group ~ a + b, or y ~ level + (1|subject) without sphericity",
          "group ~ velocity_m_s + force_N",
          "Hotelling's T squared",
          {},
          run_hotelling};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
