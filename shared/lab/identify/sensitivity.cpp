#include "lab/identify/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "lab/identify/parallel.hpp"
#include "lab/identify/projection.hpp"
#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kThresholds = kSettings.selection;

/// Share by which the mean square must rise without an effect so that it is named with it. The evidence is that of
/// StructurePosterior: half the independent observations times the logarithm, against the number of single structures.
double least_rise(const Residual& residual, const Solution& at) {
  const Problem& problem = residual.problem();
  const SelectionThresholds& thresholds = problem.selection_thresholds();
  const double observations = thresholds.observations_per_trial * residual.trials();
  const double evidence = std::log(double(std::max<std::size_t>(2, problem.candidates().size()))) +
                          kThresholds.price_nats;
  return std::max({kThresholds.clear_loss / std::max(1.0, at.judged),
                   thresholds.least_gain_share / (1.0 - thresholds.least_gain_share),
                   std::expm1(2.0 * evidence / observations)});
}

/// One strength of an effect on top of a fitted structure.
class Strength {
 public:
  Strength(const Residual& residual, const Solution& at, const Projection& fitted,
           const LinearScreen::Start& start, std::size_t parameter, std::string_view effect)
      : residual_(residual),
        fitted_(fitted),
        structure_(plus(at.structure, effect)),
        parameters_(residual.problem().parameters(structure_)),
        off_(carried(parameters_, at)),
        parameter_(parameter) {
    const std::string lead = std::string(effect) + "/";
    for (std::size_t k = 0; k < parameters_.size(); ++k)
      if (parameters_[k].pointer.starts_with(lead))
        off_[k] = parameters_[k].shape
                      ? start.values[k]
                      : std::clamp(parameters_[k].off, parameters_[k].low, parameters_[k].high);
    there_ = residual(structure_, off_);
    without_.resize(std::size_t(residual.trials()));
    parallel(residual.trials(), residual.threads(), [&](int k) {
      without_[std::size_t(k)] = residual.problem().full_rate(structure_, off_, k);
    });
  }

  struct Response {
    double square = 0.0;  // whitened, what the fitted numbers cannot imitate
    double rms = 0.0;     // of the primary's judged samples, so much of it
  };
  Response response(double value) const {
    std::vector<double> values = off_;
    values[parameter_] = value;
    Eigen::MatrixXd column = residual_.near(structure_, off_, {values});
    column.colwise() -= there_;
    Eigen::VectorXd norms;
    const Gram rest = fitted_.without_fitted(column, norms);
    const double share = norms(0) > 0.0 ? std::clamp(rest.a(0, 0) / norms(0), 0.0, 1.0) : 0.0;
    return {rest.a(0, 0), std::sqrt(share) * added(values)};
  }
  const Parameter& parameter() const { return parameters_[parameter_]; }
  double off() const { return off_[parameter_]; }

 private:
  /// Root mean square of what the values add to the primary channel on judged samples.
  double added(const std::vector<double>& values) const {
    const Problem& problem = residual_.problem();
    const std::size_t components =
        problem.channels().front().components;  // of a norm: those after it
    const std::size_t first = components > 0 ? 1 : 0, count = std::max<std::size_t>(1, components);
    std::vector<double> sum(without_.size(), 0.0), n(without_.size(), 0.0);
    parallel(residual_.trials(), residual_.threads(), [&](int trial) {
      const auto k = std::size_t(trial);
      const Residuals with = problem.full_rate(structure_, values, trial);
      for (std::size_t i = 0; i < with.t_s.size(); ++i) {
        if (with.judgement[i] != Judgement::judged) continue;
        n[k] += 1.0;
        for (std::size_t c = first; c < first + count; ++c)
          sum[k] += std::pow(with.channels[c][i] - without_[k].channels[c][i], 2);
      }
    });
    const double judged = std::reduce(n.begin(), n.end());
    return judged > 0.0 ? std::sqrt(std::reduce(sum.begin(), sum.end()) / judged) : 0.0;
  }

  const Residual& residual_;
  const Projection& fitted_;
  Structure structure_;
  std::vector<Parameter> parameters_;
  std::vector<double> off_;
  std::size_t parameter_;
  Eigen::VectorXd there_;
  std::vector<Residuals> without_;  // by trial
};

/// Of the starts the one at which a strength shows as well as at half of them, with what it was moved there.
struct MiddleStart {
  const LinearScreen::Start* start = nullptr;
  double moved = 0.0, for_one = 0.0;  ///< for_one: moved so that the response is 1
};
MiddleStart middle_start(const LinearScreen& screen, std::size_t parameter) {
  std::vector<MiddleStart> all;
  for (const LinearScreen::Start& start : screen.starts)
    for (const LinearScreen::Strength& s : start.strengths)
      if (s.parameter == parameter && s.response > 0.0)
        all.push_back({&start, s.moved, std::abs(s.moved) / std::sqrt(s.response)});
  if (all.empty()) return {};
  std::ranges::sort(all, {}, &MiddleStart::for_one);
  return all[(all.size() - 1) / 2];
}

/// The value at which the response is as large as asked: from the linear answer on by secant steps of the square root, which
/// the response of a strength follows nearly. Nothing if the range ends before.
std::optional<double> least_value(const Strength& strength, double moved, double square,
                                  double rms) {
  const Parameter& p = strength.parameter();
  double value = std::clamp(strength.off() + moved, p.low, p.high);
  double lacking = 0.0;
  for (int step = 0; step < kThresholds.sensitivity_steps; ++step) {
    const Strength::Response now = strength.response(value);
    if (!(now.square > 0.0) || !(now.rms > 0.0)) return {};
    lacking = std::max(std::sqrt(square / now.square), rms / now.rms);
    const double next =
        std::clamp(strength.off() + lacking * (value - strength.off()), p.low, p.high);
    if (next == value) break;
    value = next;
  }
  const bool ends = value == p.low || value == p.high;
  return ends && lacking > 1.0 ? std::nullopt : std::optional(value);
}

}  // namespace

std::vector<DetectionLimit> detection_limits(const Residual& residual, const Solution& at,
                                             double rmse, const LinearScreen& screen,
                                             std::string_view effect) {
  std::vector<DetectionLimit> out;
  if (!screen.excited || screen.starts.empty()) return out;
  const Projection fitted(at);
  const double rise = least_rise(residual, at);
  const double fall = std::pow(1.0 - kThresholds.least_fall, -2.0) - 1.0;
  for (const LinearScreen::Strength& s : screen.starts.front().strengths) {
    const MiddleStart middle = middle_start(screen, s.parameter);
    if (middle.start == nullptr) continue;
    const Strength strength(residual, at, fitted, *middle.start, s.parameter, effect);
    const auto value = least_value(strength, middle.moved, rise * at.mean_square() * at.judged,
                                   std::sqrt(fall) * rmse);
    out.push_back({strength.parameter().pointer.substr(effect.size() + 1), value});
  }
  return out;
}

}  // namespace lab
}  // namespace tractus
