#include "metrics/threshold_statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tractus {
namespace metrics {
namespace {
constexpr double kForceFloor_N = 0.01;
constexpr double kTorqueFloor_Nm = 0.001;

bool is_force(WrenchPart part) {
  return part == WrenchPart::force_xy || part == WrenchPart::force_z;
}

double value_of(const trial::Sample& sample, WrenchPart part) {
  const auto& v = is_force(part) ? sample.force_N : sample.torque_Nm;
  if (part == WrenchPart::force_z || part == WrenchPart::torque_z) return std::abs(double{v[2]});
  return std::hypot(double{v[0]}, double{v[1]});
}

/// All four parts in one pass over the samples.
const ThresholdStatistics& statistics_of(const Subject& subject, WrenchPart part) {
  auto& kept = subject.derived.wrench;
  if (!kept) {
    std::array<ThresholdStatistics, 4> parts{
        ThresholdStatistics(kForceFloor_N), ThresholdStatistics(kForceFloor_N),
        ThresholdStatistics(kTorqueFloor_Nm), ThresholdStatistics(kTorqueFloor_Nm)};
    for (const auto& sample : subject.trial.samples)
      for (const WrenchPart of : kWrenchParts) parts[std::size_t(of)].add(value_of(sample, of));
    kept = std::make_shared<const std::array<ThresholdStatistics, 4>>(parts);
  }
  return (*kept)[std::size_t(part)];
}
}  // namespace

void ThresholdStatistics::add(double value) noexcept {
  if (!(value > floor_)) return;
  ++count_;
  const double off = value - mean_;
  mean_ += off / double(count_);
  squares_ += off * (value - mean_);
  max_ = count_ == 1 ? value : std::max(max_, value);
}

std::optional<double> ThresholdStatistics::mean() const noexcept {
  return count_ > 0 ? std::optional(mean_) : std::nullopt;
}

std::optional<double> ThresholdStatistics::sd() const noexcept {
  return count_ > 1 ? std::optional(std::sqrt(squares_ / double(count_ - 1))) : std::nullopt;
}

std::optional<double> ThresholdStatistics::max() const noexcept {
  return count_ > 0 ? std::optional(max_) : std::nullopt;
}

Score wrench_score(const Subject& subject, WrenchPart part, Statistic statistic) {
  const ThresholdStatistics& values = statistics_of(subject, part);
  Score score{statistic == Statistic::mean ? values.mean()
              : statistic == Statistic::sd ? values.sd()
                                           : values.max(),
              fmt::format("over {} of {} samples", values.count(), subject.trial.samples.size())};
  if (!score.value)
    score.note = values.count() == 0
                     ? (is_force(part) ? "no sample is over 0.01 N" : "no sample is over 0.001 N·m")
                     : "a single sample is over the floor";
  return score;
}

TableCell wrench_cell(WrenchPart part, Statistic statistic) {
  constexpr std::array<const char*, 4> kRows{"Transverse force", "Axial force", "Bending torque",
                                             "Twisting torque"};
  constexpr std::array<const char*, 4> kSymbols{"F_xy", "F_z", "T_xy", "T_z"};
  constexpr std::array<const char*, 3> kColumns{"Mean", "SD", "Max"};
  return {kRows[std::size_t(part)], kSymbols[std::size_t(part)], kColumns[std::size_t(statistic)]};
}

}  // namespace metrics
}  // namespace tractus
