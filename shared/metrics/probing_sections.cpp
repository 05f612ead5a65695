#include "metrics/probing_sections.hpp"

#include <algorithm>
#include <cmath>

namespace tractus {
namespace metrics {
namespace {
using trial::ProbingMode;
using trial::ProbingSample;
using Samples = std::span<const ProbingSample>;

bool is_breach(const ProbingSample& s) { return s.mode == ProbingMode::breach; }
bool moves(const ProbingSample& s) {
  return s.mode != ProbingMode::holding && s.mode != ProbingMode::stopped;
}
bool ends_breach(const ProbingSample& s) {
  return s.mode != ProbingMode::breach && s.mode != ProbingMode::holding;
}

}  // namespace

Samples probing_motion(const trial::Trial& trial) {
  const Samples all = trial.probing;
  const auto first = std::ranges::find_if(all, moves);
  if (first == all.end()) return {};
  const auto stop = std::find_if(
      first, all.end(), [](const ProbingSample& s) { return s.mode == ProbingMode::stopped; });
  return {first, stop};
}

Samples first_breach(const trial::Trial& trial) {
  const Samples all = trial.probing;
  const auto begin = std::ranges::find_if(all, is_breach);
  auto last = std::find_if(begin, all.end(), ends_breach);
  while (last != begin && !is_breach(*(last - 1))) --last;
  return {begin, last};
}

std::size_t breach_count(const trial::Trial& trial) {
  const ProbingSample* before = nullptr;
  std::size_t count = 0;
  for (const ProbingSample& s : trial.probing) {
    if (s.mode == ProbingMode::holding) continue;
    const bool inward = !before || s.x_m >= before->x_m;
    count += is_breach(s) && inward && !(before && is_breach(*before));
    before = &s;
  }
  return count;
}

Spread spread_of(Samples samples, double (*value)(const ProbingSample&)) {
  Spread out;
  if (samples.empty()) return out;
  out.count = samples.size();
  out.least = out.most = value(samples.front());
  double sum = 0.0, squares = 0.0;
  for (const ProbingSample& s : samples) {
    sum += value(s);
    out.least = std::min(out.least, value(s));
    out.most = std::max(out.most, value(s));
  }
  out.mean = sum / double(out.count);
  for (const ProbingSample& s : samples) squares += (value(s) - out.mean) * (value(s) - out.mean);
  if (out.count > 1) out.variance = squares / double(out.count - 1);
  return out;
}

Score score_of_motion(const Subject& subject, std::size_t least, double (*score)(Samples)) {
  const Samples motion = probing_motion(subject.trial);
  if (motion.empty()) return {{}, "the probe never turned fast enough to move"};
  if (motion.size() < least) return {{}, "too few samples"};
  return {score(motion), subject.trial.complete ? "" : "the trial was interrupted"};
}

Score score_of_breach(const Subject& subject, std::size_t least, double (*score)(Samples)) {
  const Samples section = first_breach(subject.trial);
  if (section.empty()) return {{}, "no wall was breached"};
  if (section.size() < least) return {{}, "too few samples"};
  return {score(section), breach_count(subject.trial) > 1 ? "of the first breach" : ""};
}

Pauses pauses_of(Samples motion, double rate_Hz) {
  const auto size = std::ptrdiff_t(motion.size());
  const auto window =
      std::min(size, std::max<std::ptrdiff_t>(1, std::llround(kPauseSmooth_s * rate_Hz)));
  std::vector<double> sums(motion.size() + 1, 0.0);
  for (std::size_t i = 0; i < motion.size(); ++i) sums[i + 1] = sums[i] + speed_m_s(motion[i]);
  const auto slow = [&](std::ptrdiff_t i) {  // a whole window also at the ends
    const auto from = std::clamp<std::ptrdiff_t>(i - window / 2, 0, size - window);
    const double moved = sums[std::size_t(from + window)] - sums[std::size_t(from)];
    return std::abs(moved) / double(window) < kPause_m_s;
  };
  std::ptrdiff_t begin = 0, end = size;
  while (begin < end && slow(begin)) ++begin;
  while (end > begin && slow(end - 1)) --end;
  Pauses out;
  for (std::ptrdiff_t i = begin; i < end; ++i) {
    if (!slow(i)) continue;
    const std::ptrdiff_t from = i;
    while (i < end && slow(i)) ++i;
    const double lasted_s = double(i - from) / rate_Hz;
    if (lasted_s < kPause_s - 1e-9) continue;
    ++out.count;
    out.total_s += lasted_s;
  }
  return out;
}

}  // namespace metrics
}  // namespace tractus
