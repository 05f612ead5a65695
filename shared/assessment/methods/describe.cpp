/// A column in numbers: size, spread, normality, outliers by the modified Z-score.
#include <fmt/format.h>

#include <cmath>

#include "assessment/pictures.hpp"
#include "assessment/report.hpp"
#include "core/try.hpp"
#include "statistics/summary/modified_z.hpp"
#include "statistics/summary/shapiro_wilk.hpp"
#include "statistics/summary/summary.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using statistics::Vector;

Json row(const std::string& name, const Vector& values) {
  const auto s = statistics::summary(values);
  const auto z = statistics::modified_z(values);
  const auto normal = statistics::shapiro_wilk(values);
  return {{"group", name},
          {"n", values.size()},
          {"mean", s.mean},
          {"sd", s.deviation},
          {"median", z.median},
          {"mad", z.mad},
          {"lowest", values.minCoeff()},
          {"highest", values.maxCoeff()},
          {"shapiro_wilk_p", normal ? Json(normal->p) : Json(nullptr)}};
}

core::Result<Findings> run_describe(const Analysis& of) {
  const auto y = TRY(of.table.numbers(of.formula.response));
  statistics::Groups groups{{"all"}, {y}};
  std::string column = "all";
  if (!of.formula.terms.empty()) {
    const auto named = TRY(single_column(of, "describe"));
    column = named;
    groups = groups_in_order(of.table, column, y);
  }
  Json out = report_head(of, "description");
  out["groups"] = Json::array();
  for (std::size_t j = 0; j < groups.names.size(); ++j)
    out["groups"].push_back(row(groups.names[j], groups.values[j]));
  const double limit = of.number("limit");
  const auto z = statistics::modified_z(y);
  out["outliers"] = Json::array();
  for (Eigen::Index i = 0; i < y.size(); ++i)
    if (std::abs(z.z[i]) > limit && out["outliers"].size() < 1000)
      out["outliers"].push_back({{"row", i + 1},
                                 {"line", of.table.line(static_cast<std::size_t>(i))},
                                 {"value", y[i]},
                                 {"modified_z", z.z[i]}});
  out["notes"] = {fmt::format("{} row(s) beyond a modified Z-score of {} of all rows{}",
                              out["outliers"].size(), limit,
                              z.by_mean_deviation ? " (by the mean deviation: MAD is 0)" : "")};
  return Findings{std::move(out), {group_picture(column, groups, of.formula.response)}};
}

}  // namespace

namespace methods {
Method describe_method() {
  return {"describe",
          "Mean, spread, normality, and outliers by the modified Z-score",
          "force_variance_N2 ~ scenario   (or force_variance_N2 ~ 1)",
          "modified Z-scores after Iglewicz and Hoaglin 1993",
          {{"limit", "modified Z-score beyond which a row is an outlier", "3.5", {}, 0.1, 1000}},
          run_describe};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
