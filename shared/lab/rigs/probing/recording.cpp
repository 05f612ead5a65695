#include "lab/rigs/probing/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "lab/settings.hpp"
#include "lab/signal/even_clock.hpp"
#include "lab/signal/saturation.hpp"
#include "lab/signal/smoother.hpp"

namespace tractus {
namespace lab {
namespace {

using core::Errc;
using core::Error;
using core::Result;

/// The step of which all differences of two neighbours are multiples, 0 if there is none: how coarsely a channel was recorded.
/// Begun with the smallest difference and refined by each larger one, for a file rounds the multiples once more.
double quantum(std::span<const double> y) {
  constexpr std::size_t kLook = 20'000;
  std::vector<double> steps;
  for (std::size_t k = 1; k < std::min(y.size(), kLook); ++k)
    if (const double d = std::abs(y[k] - y[k - 1]); d > 0.0) steps.push_back(d);
  if (steps.empty()) return 0.0;
  std::ranges::sort(steps);
  double q = steps.front(), products = 0.0, squares = 0.0;
  for (const double d : steps) {
    const double n = std::round(d / q);
    if (std::abs(d / q - n) > 0.1) return 0.0;
    products += d * n, squares += n * n;
    q = products / squares;
  }
  return q;
}

struct Noise {
  double sd = 0.0;          ///< of a sample
  double correlated = 0.0;  ///< sd of the part that filtering does not average away
};

/// Noise of a channel, `sd` as differences of its samples say. Rounding that is not drowned by noise stays where it is for long: its first
/// harmonic has the power q²/(2π²) e^(−4π²σ²/q²) for noise σ before rounding to q.
Noise noise_of(std::span<const double> y, std::optional<double> stated, double sd) {
  const double q = quantum(y);
  if (!(sd > 0.0)) sd = stated.value_or(0.0);
  sd = std::max(sd, q / std::sqrt(12.0));
  if (!(sd > 0.0)) {
    double most = 0.0;
    for (const double v : y) most = std::max(most, std::abs(v));
    sd = std::max(1e-9 * most, 1e-12);
  }
  if (q <= 0.0) return {sd, 0.0};
  const double before = std::max(0.0, sd * sd - q * q / 12.0);
  const double pi = std::numbers::pi;
  return {sd, q / (pi * std::numbers::sqrt2) * std::exp(-2.0 * pi * pi * before / (q * q))};
}

/// The noise's level at low frequency as seen after averaging 2 and 4 samples: more than the white
/// level of single samples where the sensor has smoothed them.
double colour(std::span<const double> y, double white_sd) {
  double most = 1.0;
  std::vector<double> means;
  for (const std::size_t m : {2u, 4u}) {
    means.clear();
    for (std::size_t k = 0; k + m <= y.size(); k += m) {
      double sum = 0.0;
      for (std::size_t i = 0; i < m; ++i) sum += y[k + i];
      means.push_back(sum / double(m));
    }
    most = std::max(most, std::sqrt(double(m)) * noise_sd(means) / white_sd);
  }
  return most;
}

Error unusable_probing(const std::string& where, const std::string& why) {
  return {Errc::bad_input, fmt::format("{}: {}", where, why)};
}

double middle_of(std::vector<double> values) {
  const auto at = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::ranges::nth_element(values, at);
  return *at;
}

/// Angle and torque, where recorded.
void prepare_turning(trial::ProbingMeasurement& trial, const trial::StatedNoise& stated,
                     ProbingRecording& out) {
  effects::ProbingMotion& motion = out.motion;
  if (!trial.theta_rad.empty()) {
    Smoothed theta = smooth(
        trial.t_s, trial.theta_rad,
        noise_of(trial.theta_rad, stated.theta_rad, noise_sd_on_fast_motion(trial.theta_rad)).sd);
    motion.theta_rad = std::move(theta.value);
    out.theta_sd_rad = std::move(theta.value_sd);
    motion.omega_rad_s = std::move(theta.rate);
    out.omega_sd_rad_s = std::move(theta.rate_sd);
    motion.rest_rad_s = kProbingRecording.rest_errors * middle_of(out.omega_sd_rad_s);
  }
  motion.tz_Nm = std::move(trial.tz_Nm);
}

void prepare_sliding(trial::ProbingMeasurement& trial, const trial::StatedNoise& stated,
                     ProbingRecording& out) {
  effects::ProbingMotion& motion = out.motion;
  const std::size_t n = trial.t_s.size();
  if (trial.x_m.empty()) {
    for (auto* all :
         {&motion.x_m, &motion.v_m_s, &motion.a_m_s2, &out.x_sd_m, &out.v_sd_m_s, &out.a_sd_m_s2})
      all->assign(n, 0.0);
    return;
  }
  const Noise noise = noise_of(trial.x_m, stated.x_m, noise_sd_on_fast_motion(trial.x_m));
  out.recorded_x_m = std::move(trial.x_m);
  out.x_noise_sd_m = noise.sd;
  out.x_rounding_sd_m = noise.correlated;
}

/// Outputs that say something new: while the probe stands, the longer it stands the rarer, as what
/// still changes then (relaxation) does so over ever longer times.
std::vector<std::size_t> informative(const ProbingRecording& r) {
  std::vector<std::size_t> out;
  const effects::ProbingMotion& m = r.motion;
  double place_m = m.x_m.front(), since_s = m.t_s.front(), next_s = since_s;
  for (std::size_t j = 0; j < r.decimator.size(r.size()); ++j) {
    const std::size_t k = r.decimator.middle(j);
    if (std::abs(m.x_m[k] - place_m) > kProbingRecording.same_place_m)
      place_m = m.x_m[k], since_s = m.t_s[k];
    const double stood_s = m.t_s[k] - since_s;
    if (stood_s > kProbingRecording.long_stand_s && m.t_s[k] < next_s) continue;
    out.push_back(j);
    next_s = m.t_s[k] + stood_s / (kProbingRecording.long_stand_s * kProbingRecording.thin_rate_Hz);
  }
  return out;
}

/// Said one by one, so that a filter for every other sample (Decimator::of_every) has no output more.
std::vector<std::size_t> all_outputs(const ProbingRecording& r) {
  std::vector<std::size_t> out(r.decimator.size(r.size()));
  std::iota(out.begin(), out.end(), std::size_t{0});
  return out;
}

/// The samples at rest with the least speed that would be told from it.
void find_rest(ProbingRecording& r) {
  const effects::ProbingMotion& m = r.motion;
  effects::ProbingMotion& out = r.at_rest;
  r.rest.clear();
  out = {};
  out.rest_m_s = 0.0;
  for (std::size_t k = 0; k < r.size(); ++k) {
    const double told_m_s =
        std::max(2.0 * m.rest_m_s, kProbingRecording.rest_errors * r.v_sd_m_s[k]);
    if (std::abs(m.v_m_s[k]) >= told_m_s) continue;
    r.rest.push_back(k);
    out.t_s.push_back(m.t_s[k]);
    out.x_m.push_back(m.x_m[k]);
    out.v_m_s.push_back(told_m_s);
    out.a_m_s2.push_back(0.0);
  }
}

/// The same of the turning.
void find_turning_rest(ProbingRecording& r) {
  const effects::ProbingMotion& m = r.motion;
  effects::ProbingMotion& out = r.at_rest;
  r.rest.clear();
  out = {};
  out.rest_rad_s = 0.0;
  for (std::size_t k = 0; k < r.size(); ++k) {
    const double told_rad_s =
        std::max(2.0 * m.rest_rad_s, kProbingRecording.rest_errors * r.omega_sd_rad_s[k]);
    if (std::abs(m.omega_rad_s[k]) >= told_rad_s) continue;
    r.rest.push_back(k);
    out.t_s.push_back(m.t_s[k]);
    out.x_m.push_back(m.x_m[k]);
    for (auto* all : {&out.v_m_s, &out.a_m_s2}) all->push_back(0.0);
    out.theta_rad.push_back(m.theta_rad[k]);
    out.omega_rad_s.push_back(told_rad_s);
  }
}

/// What the law says of the judged channel at a sample, were the probe at this depth.
double judged(const laws::ProbingLaw& law, const ProbingRecording& r, double x_m, std::size_t k) {
  const effects::ProbingMotion& m = r.motion;
  return r.turns ? law.torque_Nm(x_m, m.theta_rad[k], m.omega_rad_s[k])
                 : law.force_N(x_m, m.v_m_s[k]);
}

/// Where the judged channel jumps between neighbouring samples because a border lies between them: the
/// second of the two, and by how much.
struct ForceJump {
  std::size_t sample;
  double size;
};

std::vector<ForceJump> jumps(const laws::ProbingLaw& law, const ProbingRecording& r) {
  const std::vector<double> borders = borders_of(law.parameters().layers);
  std::vector<ForceJump> out;
  const auto& x = r.motion.x_m;
  for (std::size_t k = 1; k < x.size(); ++k)
    for (const double border : borders)
      if ((x[k - 1] < border) != (x[k] < border)) {
        out.push_back(
            {k, std::abs(judged(law, r, border + 1e-9, k) - judged(law, r, border - 1e-9, k))});
        break;
      }
  return out;
}

/// Variance of the judged channel by the errors of the smoothed motion, sample by sample. The law of the force is linear
/// in depth and speed but for its borders: differences are its derivatives.
std::vector<double> variance_by_motion(const laws::ProbingLaw& law, const ProbingRecording& r) {
  const auto& m = r.motion;
  std::vector<double> out(r.size());
  for (std::size_t k = 0; k < r.size(); ++k) {
    const double at = judged(law, r, m.x_m[k], k);
    if (r.turns) {
      const double speed_rad_s = m.omega_rad_s[k] + r.omega_sd_rad_s[k],
                   angle_rad = m.theta_rad[k] + r.theta_sd_rad[k];
      const double by_speed = law.torque_Nm(m.x_m[k], m.theta_rad[k], speed_rad_s) - at;
      const double by_angle = law.torque_Nm(m.x_m[k], angle_rad, m.omega_rad_s[k]) - at;
      out[k] = by_speed * by_speed + by_angle * by_angle;
      continue;
    }
    const double by_speed = law.force_N(m.x_m[k], m.v_m_s[k] + r.v_sd_m_s[k]) - at;
    const double by_depth = law.force_N(m.x_m[k], 0.0) - law.force_N(m.x_m[k] - r.x_sd_m[k], 0.0);
    const double border = std::abs(by_depth) > 0.5 * std::abs(at) ? 0.0 : by_depth;
    out[k] = by_speed * by_speed + border * border;
  }
  return out;
}

/// Where recorded positions pass a border: a break in the middle of the interval.
std::vector<Break> passages(std::span<const double> x_m, std::span<const double> borders_m) {
  std::vector<Break> out;
  for (std::size_t k = 1; k < x_m.size(); ++k)
    if (std::ranges::any_of(borders_m, [&](double b) { return (x_m[k - 1] < b) != (x_m[k] < b); }))
      out.push_back({k});
  return out;
}

/// The share of the interval after which the motion smoothed so far reaches the border.
double moment_of(const Break& one, const Smoothed& x, std::span<const double> t_s,
                 std::span<const double> recorded_m, std::span<const double> borders_m) {
  const std::size_t k = one.sample;
  const double h = t_s[k] - t_s[k - 1];
  for (const double border : borders_m)
    if ((recorded_m[k - 1] < border) != (recorded_m[k] < border)) {
      const double before = border - x.value[k - 1], after = x.value[k] - border;
      const double there = x.rate[k - 1] * h, rest = x.rate[k] * h;
      // From both sides: the share that is left to go before it, and that which was gone since.
      double sum = 0.0, count = 0.0;
      if (std::abs(there) > 0.0) sum += before / there, count += 1.0;
      if (std::abs(rest) > 0.0) sum += 1.0 - after / rest, count += 1.0;
      return count > 0.0 ? std::clamp(sum / count, 0.02, 0.98) : 0.5;
    }
  return one.share;
}

}  // namespace

std::vector<double> borders_of(std::span<const laws::Layer> layers) {
  std::vector<double> out;
  for (const laws::Layer& layer : layers)
    out.insert(out.end(), {layer.start_m, layer.start_m + layer.thickness_m});
  return out;
}

void set_motion(ProbingRecording& r, std::span<const double> borders_m) {
  if (r.recorded_x_m.empty()) return;
  effects::ProbingMotion& motion = r.motion;
  std::vector<Break> breaks = passages(r.recorded_x_m, borders_m);
  Smoothed x = smooth(motion.t_s, r.recorded_x_m, r.x_noise_sd_m, breaks);
  if (!breaks.empty()) {
    for (Break& one : breaks) one.share = moment_of(one, x, motion.t_s, r.recorded_x_m, borders_m);
    x = smooth(motion.t_s, r.recorded_x_m, r.x_noise_sd_m, breaks);
  }
  motion.x_m = std::move(x.value);
  motion.v_m_s = std::move(x.rate);
  motion.a_m_s2 = std::move(x.acceleration);
  r.x_sd_m = std::move(x.value_sd);
  for (double& sd : r.x_sd_m) sd = std::hypot(sd, r.x_rounding_sd_m);
  r.v_sd_m_s = std::move(x.rate_sd);
  r.a_sd_m_s2 = std::move(x.acceleration_sd);
  motion.rest_m_s = kProbingRecording.rest_errors * middle_of(r.v_sd_m_s);
  find_rest(r);
}

Result<ProbingRecording> prepare(trial::ProbingMeasurement&& trial,
                                 const trial::StatedNoise& stated, bool turns,
                                 std::span<const double> borders_m, const std::string& where) {
  const std::size_t n = trial.t_s.size();
  if (n < kProbingRecording.fewest_samples)
    return unusable_probing(where, fmt::format("{} samples, at least {} are expected", n,
                                               kProbingRecording.fewest_samples));
  const double spacing_s = (trial.t_s.back() - trial.t_s.front()) / double(n - 1);
  if (spacing_s * kProbingRecording.slowest_rate_Hz > 1.001)
    return unusable_probing(
        where, fmt::format("{:.3g} samples per second, at least {} are expected", 1.0 / spacing_s,
                           kProbingRecording.slowest_rate_Hz));
  restore_even_clock(trial.t_s);
  ProbingRecording out;
  out.id = trial.id;
  out.turns = turns;
  out.motion.t_s = std::move(trial.t_s);
  trial.t_s = out.motion.t_s;
  out.measured = turns ? trial.tz_Nm : std::move(trial.fz_N);
  if (!turns) out.other = trial.tz_Nm;
  const Noise noise =
      noise_of(out.measured, turns ? stated.tz_Nm : stated.fz_N, noise_sd(out.measured));
  out.noise_sd = noise.sd;
  out.decimator = Decimator(spacing_s, kProbingRecording.thin_rate_Hz);
  out.slow_noise_sd =
      std::hypot(noise.sd * std::sqrt(out.decimator.noise_gain()) *
                     (out.decimator.stride() > 1 ? colour(out.measured, noise.sd) : 1.0),
                 noise.correlated);
  if (!out.other.empty())
    out.other_noise_sd = noise_of(out.other, stated.tz_Nm, noise_sd(out.other)).sd;
  prepare_sliding(trial, stated, out);
  set_motion(out, borders_m);
  prepare_turning(trial, stated, out);
  if (turns) find_turning_rest(out);
  out.decimator.choose(turns ? all_outputs(out) : informative(out));
  out.measured_thin.resize(out.decimator.size(n));
  out.decimator.apply(out.measured, out.measured_thin);
  out.judgement.assign(n, Judgement::judged);
  out.sd_thin.assign(out.measured_thin.size(), out.slow_noise_sd);
  out.floor = out.noise_sd;
  return out;
}

void mark_saturated(std::span<ProbingRecording> recordings) {
  std::vector<std::span<const double>> telling;
  for (const ProbingRecording& r : recordings)
    if (shows_noise(r.measured, noise_sd(r.measured))) telling.emplace_back(r.measured);
  const SensorRange of_all = sensor_range(telling);
  for (ProbingRecording& r : recordings) {
    const std::span<const double> one(r.measured);
    const SensorRange own =
        shows_noise(one, noise_sd(one)) ? sensor_range({&one, 1}) : SensorRange{};
    r.saturated.resize(r.size());
    std::ranges::transform(one, r.saturated.begin(), [&](double value) {
      return of_all.ends_at(value) || own.ends_at(value);
    });
  }
}

namespace {

/// Variance of single samples about the means of blocks of `length`: of stretches of 16 blocks the tenth that is quietest,
/// over that quantile of χ² [Wilson1931, eq. 1], so that only what all stretches hold counts. One block alone may be quiet
/// by chance where its samples follow each other.
double variance_within(std::span<const double> y, std::size_t length) {
  std::vector<double> blocks;
  for (std::size_t from = 0; from + length <= y.size(); from += length) {
    double mean = 0.0, squares = 0.0;
    for (std::size_t k = from; k < from + length; ++k) mean += y[k] / double(length);
    for (std::size_t k = from; k < from + length; ++k) squares += (y[k] - mean) * (y[k] - mean);
    blocks.push_back(squares / double(length - 1));
  }
  const std::size_t together = std::clamp<std::size_t>(blocks.size() / 10, 1, 16);
  std::vector<double> variances;
  for (std::size_t from = 0; from + together <= blocks.size(); from += together)
    variances.push_back(std::accumulate(blocks.begin() + std::ptrdiff_t(from),
                                        blocks.begin() + std::ptrdiff_t(from + together), 0.0) /
                        double(together));
  if (variances.empty()) return 0.0;
  const auto quietest = variances.begin() + std::ptrdiff_t(0.1 * double(variances.size()));
  std::ranges::nth_element(variances, quietest);
  constexpr double kTenth = -1.2816;  // of the standard normal
  const double spread = 2.0 / (9.0 * double(together * (length - 1))),
               root = 1.0 - spread + kTenth * std::sqrt(spread);
  return *quietest / (root * root * root);
}

/// What errors of single samples, all one way, make of an output: no more than the greatest of them.
double passed_on(std::span<const double> errors, const Decimator& decimator, std::size_t output) {
  const std::size_t middle = decimator.middle(output), half = decimator.half() + 1;
  const std::size_t from = middle > half ? middle - half : 0,
                    to = std::min(errors.size(), middle + half + 1);
  double sum = 0.0, most = 0.0;
  for (std::size_t k = from; k < to; ++k) sum += errors[k], most = std::max(most, errors[k]);
  return std::min(most, decimator.largest_tap() * sum);
}

/// What of an output's standard deviation is noise, by third differences of every `apart`-th output: white noise gives the
/// same for each, noise that is correlated over several outputs more where they lie further apart.
double noise_of_outputs(std::span<const double> outputs, const Decimator& decimator,
                        std::size_t apart) {
  double sum = 0.0;
  for (std::size_t first = 0; first < apart; ++first) {
    std::vector<double> every;
    for (std::size_t k = first; k < outputs.size(); k += apart) every.push_back(outputs[k]);
    sum += noise_sd(every, kQuietestQuantile) / double(apart);
  }
  return sum * std::sqrt(decimator.noise_gain() / decimator.third_difference_gain(apart));
}

}  // namespace

void estimate_noise(ProbingRecording& r, std::span<const double> residual,
                    std::span<const double> thin) {
  const double gain = r.decimator.noise_gain();
  // What a model misses is in what it leaves, what it does not miss is in the force: each is a bound.
  for (const std::size_t apart : {1u, 2u})
    r.slow_noise_sd =
        std::max(r.slow_noise_sd, std::min(noise_of_outputs(thin, r.decimator, apart),
                                           noise_of_outputs(r.measured_thin, r.decimator, apart)));
  const std::size_t stride = r.decimator.stride();
  if (stride < 4) {
    if (stride == 1) r.noise_sd = std::max(r.noise_sd, r.slow_noise_sd);
    return;
  }
  const double fast =
      std::min(variance_within(residual, stride), variance_within(r.measured, stride));
  const double variance = (1.0 - gain) * fast + r.slow_noise_sd * r.slow_noise_sd;
  r.noise_sd = std::max(r.noise_sd, std::sqrt(variance));
}

void weigh(const laws::ProbingLaw& law, std::span<const double> by_effects, ProbingRecording& r) {
  const std::size_t n = r.size();
  const std::vector<double> by_bone = variance_by_motion(law, r);
  std::vector<double> motion_variance = by_bone;
  for (std::size_t k = 0; k < n; ++k) motion_variance[k] += by_effects[k];
  const auto& m = r.motion;
  const auto found = jumps(law, r);
  r.judgement.assign(n, Judgement::judged);
  const auto reach =
      std::max(kProbingRecording.border_samples,
               std::size_t(kProbingRecording.border_s / (r.seconds() / double(n - 1))));
  // What the motion's noise makes of the force must stay well under the sensor's own noise, at the
  // least in the better half of the samples.
  std::vector<double> ordered = motion_variance;
  const auto half_way =
      ordered.begin() + std::ptrdiff_t(kProbingRecording.least_judged_share * double(n));
  std::ranges::nth_element(ordered, half_way);
  const double most =
      std::max(*half_way, kProbingRecording.well_known_share * kProbingRecording.well_known_share *
                              r.noise_sd * r.noise_sd);
  // Nor is it known at the ends, where one side's samples alone tell speed: no output of the filter has its middle there.
  const std::size_t end = std::min(n, r.decimator.half());
  for (std::size_t k = 0; k < n; ++k)
    if (motion_variance[k] > most || k < end || k + end >= n)
      r.judgement[k] = Judgement::unknown_motion;
  // What is unknown of a sample, first because nobody can tell on which side of a border it lies: a probe may stand there for long.
  std::vector<double> unknown(n, 0.0);
  const bool slides = !r.recorded_x_m.empty();
  for (const double border : slides ? borders_of(law.parameters().layers) : std::vector<double>{})
    for (std::size_t k = 0; k < n; ++k) {
      const double near_m = kProbingRecording.on_border_m + 3.0 * r.x_sd_m[k];
      if (!(std::abs(m.x_m[k] - border) < near_m)) continue;
      r.judgement[k] = Judgement::at_border;
      unknown[k] = std::max(unknown[k], std::abs(judged(law, r, border + near_m, k) -
                                                 judged(law, r, border - near_m, k)));
    }
  for (const ForceJump& jump : found)
    for (std::size_t k = jump.sample < reach ? 0 : jump.sample - reach;
         k < std::min(n, jump.sample + reach); ++k)
      r.judgement[k] = Judgement::at_border;
  for (const ForceJump& jump : found)
    unknown[jump.sample] = std::max(unknown[jump.sample], jump.size);
  // At the end of its range a sensor says no more than that there is at least so much.
  for (std::size_t k = 0; k < n; ++k) {
    if (!r.saturated[k]) continue;
    r.judgement[k] = Judgement::saturated;
    unknown[k] = std::max(unknown[k], std::abs(r.measured[k]));
  }
  for (std::size_t j = 0; j < r.sd_thin.size(); ++j)
    r.sd_thin[j] =
        std::sqrt(r.slow_noise_sd * r.slow_noise_sd + motion_variance[r.decimator.middle(j)] +
                  std::pow(passed_on(unknown, r.decimator, j), 2));
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k < n; ++k)
    if (r.judgement[k] == Judgement::judged)
      sum += r.noise_sd * r.noise_sd + by_bone[k], count += 1.0;
  r.floor = count > 0.0 ? std::sqrt(sum / count) : r.noise_sd;
}

}  // namespace lab
}  // namespace tractus
