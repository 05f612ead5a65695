/// Mean, standard deviation and largest value over a floor: the rule of the published tables.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "metrics/metric.hpp"

namespace tractus::metrics {

/// Over the values strictly above `floor` alone; the others do not exist for it.
///
/// Mean and spread by Welford's updates, in one pass.
/// Known limit: the floor cuts the low tail, so the mean is that of contact, not of the trial.
class ThresholdStatistics {
 public:
  explicit ThresholdStatistics(double floor) : floor_(floor) {}
  void add(double value) noexcept;
  std::uint64_t count() const noexcept { return count_; }
  std::optional<double> mean() const noexcept;
  /// With n − 1 (the source does not say); nothing for fewer than two values.
  std::optional<double> sd() const noexcept;
  std::optional<double> max() const noexcept;

 private:
  double floor_;
  std::uint64_t count_ = 0;
  double mean_ = 0.0, squares_ = 0.0, max_ = 0.0;
};

enum class WrenchPart { force_xy, force_z, torque_xy, torque_z };
inline constexpr std::array kWrenchParts{WrenchPart::force_xy, WrenchPart::force_z,
                                         WrenchPart::torque_xy, WrenchPart::torque_z};
enum class Statistic { mean, sd, max };

/// One cell of [Zoller2020, Tables 1 and 2] for a trial: the model's wrench (what the bone does to
/// the probe, in H), F_xy = hypot(F_x, F_y), |F_z|, T_xy = hypot(T_x, T_y), |T_z|; forces over 0.01
/// N, torques over 0.001 N·m.
Score wrench_score(const Subject& subject, WrenchPart part, Statistic statistic);
/// Its place in those tables.
TableCell wrench_cell(WrenchPart part, Statistic statistic);

}  // namespace tractus::metrics
