/// Several p-values of one question.
#include "statistics/summary/p_adjust.hpp"

#include <fmt/format.h>

#include "assessment/report.hpp"
#include "core/try.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using statistics::Adjustment;

core::Result<Findings> run_p_adjust(const Analysis& of) {
  const auto p = TRY(of.table.numbers(of.formula.response));
  for (Eigen::Index i = 0; i < p.size(); ++i)
    if (!(p[i] >= 0.0 && p[i] <= 1.0))
      return core::bad_input(fmt::format("{}:{}: {} is no p-value: 0 to 1 is expected",
                                         of.table.name(),
                                         of.table.line(static_cast<std::size_t>(i)), p[i]));
  const std::vector<double> raw(p.begin(), p.end());
  const auto by = [&](Adjustment how) { return statistics::adjusted(raw, how); };
  const auto bonferroni = by(Adjustment::bonferroni), holm = by(Adjustment::holm),
             hochberg = by(Adjustment::hochberg), hommel = by(Adjustment::hommel),
             bh = by(Adjustment::benjamini_hochberg),
             yekutieli = by(Adjustment::benjamini_yekutieli);
  Json out = report_head(of, "p-values adjusted for multiplicity");
  out["adjusted"] = Json::array();
  const auto labels = of.formula.factors();
  for (std::size_t i = 0; i < raw.size(); ++i) {
    std::string name;
    for (const auto& column : labels)
      name += (name.empty() ? "" : " ") + std::string(of.table.texts(column)[i]);
    out["adjusted"].push_back({{"name", name.empty() ? fmt::format("row {}", i + 1) : name},
                               {"p", raw[i]},
                               {"holm", holm[i]},
                               {"hommel", hommel[i]},
                               {"hochberg", hochberg[i]},
                               {"bonferroni", bonferroni[i]},
                               {"benjamini_hochberg", bh[i]},
                               {"benjamini_yekutieli", yekutieli[i]}});
  }
  out["notes"] = {
      fmt::format("{} tests; Holm, Hommel, Hochberg and Bonferroni hold the chance of "
                  "any false positive, the last two the share of false positives",
                  raw.size())};
  return Findings{std::move(out), {}};
}

}  // namespace

namespace methods {
Method p_adjust_method() {
  return {"p-adjust",
          "Holm, Hommel, Hochberg, Bonferroni, Benjamini-Hochberg, Benjamini-Yekutieli",
          "p ~ scenario + measure   (p ~ 1 without names)",
          "p-values adjusted for the number of tests",
          {},
          run_p_adjust};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
