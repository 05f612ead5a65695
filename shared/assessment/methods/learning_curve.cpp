/// How fast a score changes over trials, and to what level.
#include "statistics/learning/learning_curve.hpp"

#include <fmt/format.h>

#include <cmath>

#include "assessment/pictures.hpp"
#include "assessment/report.hpp"
#include "core/try.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using statistics::CurveShape;
using statistics::LearningCurve;
using statistics::Vector;

struct Shape {
  CurveShape shape;
  const char* name;
  const char* law;
};
constexpr Shape kShapes[] = {
    {CurveShape::power, "power", "y = a n^-b"},
    {CurveShape::power_plateau, "power with plateau", "y = a n^-b + c"},
    {CurveShape::exponential_plateau, "exponential with plateau", "y = a exp(-b (n - 1)) + c"}};

double value_at(const LearningCurve& fit, CurveShape shape, double n) {
  const auto& k = fit.coefficients;
  if (shape == CurveShape::power) return k[0] * std::pow(n, -k[1]);
  if (shape == CurveShape::power_plateau) return k[0] * std::pow(n, -k[1]) + k[2];
  return k[0] * std::exp(-k[1] * (n - 1.0)) + k[2];
}

Json coefficients(const LearningCurve& fit) {
  return coefficient_table(fit.names, {{"estimate", &fit.coefficients},
                                       {"standard_error", &fit.standard_errors},
                                       {"t", &fit.t},
                                       {"p", &fit.p}});
}

plot::Figure picture(const Analysis& of, const Vector& trial, const Vector& y,
                     const std::vector<std::pair<const Shape*, LearningCurve>>& fits) {
  plot::Panel panel{
      "", of.formula.terms[0].name(), of.formula.response, "", {}, {}, {}, {}, {}, false, 300};
  panel.lines.push_back(crosses("observed", trial, y));
  const char* colours[] = {"#b3261e", "#2e7d32", "#7b1fa2"};
  for (std::size_t k = 0; k < fits.size(); ++k) {
    plot::Line line{fits[k].first->name, {}, {}, colours[k % 3], 1.5};
    for (int i = 0; i <= 100; ++i) {
      const double n = trial.minCoeff() + (trial.maxCoeff() - trial.minCoeff()) * i / 100.0;
      line.x.push_back(n);
      line.y.push_back(value_at(fits[k].second, fits[k].first->shape, n));
    }
    panel.lines.push_back(std::move(line));
  }
  return {"", 620, 1, {panel}, ""};
}

core::Result<Findings> run_learning_curve(const Analysis& of) {
  const auto problem = TRY(problem_of(of, false));
  if (of.formula.terms.size() != 1 || problem.model.design.columns.cols() != 2)
    return core::bad_input(
        "learning-curve takes one number that counts trials: write score ~ trial");
  const Vector trial = problem.model.design.columns.col(1);
  Json out = report_head(of, "learning curves by nonlinear least squares");
  std::vector<std::pair<const Shape*, LearningCurve>> fits;
  out["shapes"] = Json::array();
  out["notes"] = Json::array();
  std::string refusal;
  for (const auto& shape : kShapes) {
    auto fit = statistics::learning_curve(trial, problem.y, shape.shape);
    if (!fit) {
      refusal = fit.error().what;
      out["notes"].push_back(fmt::format("no {}: {}", shape.name, refusal));
      continue;
    }
    out["shapes"].push_back({{"shape", shape.name},
                             {"law", shape.law},
                             {"aicc", fit->aicc},
                             {"residual_sd", fit->sigma},
                             {"rss", fit->rss}});
    fits.emplace_back(&shape, std::move(*fit));
  }
  if (fits.empty()) return core::bad_input(of.table.name() + ": " + refusal);
  const auto best =
      std::ranges::min_element(fits, {}, [](const auto& fit) { return fit.second.aicc; });
  out["best"] = best->first->name;
  out["coefficients"] = coefficients(best->second);
  const auto& b = best->second;
  out["tests"] = Json::array({Test{"rate b", "t", b.t[1], 0, b.df, b.p[1], "b", b.coefficients[1],
                                   std::nan(""), std::nan("")}
                                  .to_json()});
  for (const auto& [shape, fit] : fits)
    if (shape->shape == CurveShape::power)
      out["power_law"] = {{"share_left_when_trials_double", statistics::share_per_doubling(fit)}};
  out["notes"].push_back("shapes are compared by AICc: differences under 2 say nothing");
  return Findings{std::move(out), {picture(of, trial, problem.y, fits)}};
}

}  // namespace

namespace methods {
Method learning_curve_method() {
  return {"learning-curve",
          "Power and exponential learning curves, compared by AICc",
          "operation_time_s ~ trial",
          "learning curves by nonlinear least squares, compared by AICc",
          {},
          run_learning_curve};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
