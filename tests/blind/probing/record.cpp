#include "probing/record.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace blind {
namespace {

/// A slow trend from zero, of unit range over the trial, one-way or bent, never periodic.
std::vector<double> trend(Random& random, std::size_t count) {
  const double line = random.normal(), bend = random.normal(), settle = 1.5 * random.normal();
  std::vector<double> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double u = static_cast<double>(i) / static_cast<double>(count - 1);
    out[i] = line * u + bend * u * u + settle * (1 - std::exp(-3 * u));
  }
  const auto [low, high] = std::ranges::minmax(out);
  for (double& value : out) value /= high - low;
  return out;
}

std::vector<double> late(const std::vector<double>& values, double steps) {
  std::vector<double> out(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double at = std::max(0.0, static_cast<double>(i) - steps);
    const auto k = std::min(static_cast<std::size_t>(at), values.size() - 2);
    const double share = at - static_cast<double>(k);
    out[i] = (1 - share) * values[k] + share * values[k + 1];
  }
  return out;
}

double quantised(double value, double step) {
  return step > 0 ? step * std::round(value / step) : value;
}

/// Value of sample k: the mean over the interval about its time, or the value at it.
double at_sample(const auto& value, std::size_t centre, std::size_t half, std::size_t count,
                 bool averaging) {
  if (!averaging) return value(centre);
  const std::size_t from = centre > half ? centre - half : 0, to = std::min(count, centre + half);
  double sum = 0;
  for (std::size_t i = from; i < to; ++i) sum += value(i);
  return sum / static_cast<double>(to - from);
}

}  // namespace

std::vector<double> torque(const Series& series, const Rotary& rotary) {
  std::vector<double> out;
  for (const Moment& m : series.moments)
    out.push_back(rotary.viscous_Nms_per_rad * m.omega_rad_s +
                  rotary.detent_Nm *
                      std::sin(2 * std::numbers::pi * m.theta_rad / rotary.detent_pitch_rad));
  return out;
}

std::vector<double> as_recorded(const std::vector<double>& force_N,
                                const std::vector<double>& torque_Nm,
                                const std::vector<HiddenEffect>& effects, std::uint64_t trial_seed,
                                double step_s) {
  std::vector<double> out = force_N;
  for (const HiddenEffect& effect : effects)
    if (effect.id == "time_delay") out = late(out, effect.parameters.at("delay_s") / step_s);
  for (const HiddenEffect& effect : effects) {
    Random random(trial_seed ^ 0xD21F7);
    if (effect.id == "sensor_bias")
      for (double& f : out) f += effect.parameters.at("force_N");
    if (effect.id == "sensor_drift") {
      const auto shape = trend(random, out.size());
      for (std::size_t i = 0; i < out.size(); ++i)
        out[i] += effect.parameters.at("range_N") * shape[i];
    }
    if (effect.id == "torque_crosstalk")
      for (std::size_t i = 0; i < out.size(); ++i)
        out[i] += effect.parameters.at("coefficient_per_m") * torque_Nm[i];
  }
  return out;
}

Series sampled_motion(const Series& series, const SetPlan& plan) {
  const double step = 1.0 / plan.request.rate_Hz;
  const auto stride = static_cast<std::size_t>(std::lround(step / kFineStep_s));
  const auto& fine = series.moments;
  Series out;
  for (std::size_t centre = 0; centre + stride / 2 < fine.size(); centre += stride) {
    const auto value = [&](double Moment::*member) {
      return at_sample([&](std::size_t i) { return fine[i].*member; }, centre, stride / 2,
                       fine.size(), plan.recording.averaging);
    };
    out.moments.push_back({static_cast<double>(out.moments.size()) * step, value(&Moment::x_m), 0,
                           0, value(&Moment::theta_rad), value(&Moment::omega_rad_s)});
  }
  auto& m = out.moments;
  for (std::size_t i = 1; i + 1 < m.size(); ++i) {
    m[i].v_m_s = (m[i + 1].x_m - m[i - 1].x_m) / (2 * step);
    m[i].a_m_s2 = (m[i + 1].x_m - 2 * m[i].x_m + m[i - 1].x_m) / (step * step);
  }
  return out;
}

Samples sample(const Series& series, const std::vector<double>& force_N,
               const std::vector<double>& torque_Nm, const SetPlan& plan,
               std::uint64_t trial_seed) {
  Random random(trial_seed ^ 0x5A3);
  const Recording& how = plan.recording;
  const auto stride =
      static_cast<std::size_t>(std::lround(1.0 / (plan.request.rate_Hz * kFineStep_s)));
  const std::size_t count = series.moments.size();
  Samples out;
  double floor = 0;
  for (std::size_t centre = 0; centre + stride / 2 < count; centre += stride) {
    const auto value = [&](const auto& read) {
      return at_sample(read, centre, stride / 2, count, how.averaging);
    };
    const double force = value([&](std::size_t i) { return force_N[i]; });
    const double recorded =
        quantised(force + how.force_noise_N * random.normal(), how.force_step_N);
    floor += (recorded - force) * (recorded - force);
    out.t_s.push_back(static_cast<double>(out.t_s.size()) / plan.request.rate_Hz);
    out.force_N.push_back(recorded);
    out.x_m.push_back(quantised(value([&](std::size_t i) { return series.moments[i].x_m; }) +
                                    how.position_noise_m * random.normal(),
                                how.position_step_m));
    out.theta_rad.push_back(quantised(value([&](std::size_t i) {
                                        return series.moments[i].theta_rad;
                                      }) + how.angle_noise_rad * random.normal(),
                                      how.angle_step_rad));
    out.torque_Nm.push_back(quantised(
        value([&](std::size_t i) { return torque_Nm[i]; }) + how.torque_noise_Nm * random.normal(),
        how.torque_step_Nm));
  }
  out.floor_N = std::sqrt(floor / static_cast<double>(out.t_s.size()));
  return out;
}

}  // namespace blind
