/// Where the tip of a trial's tool has been.
#pragma once

#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "trial/signals.hpp"
#include "volume/tract.hpp"

namespace tractus::session {

/// From every recorded sample, thinned as it comes: a point is kept where the tip is kStep_m from
/// the one before; beyond kPoints every second one goes and the step doubles. So a trial of any
/// length costs the same, and its line is whole.
class TipWay {
 public:
  static constexpr std::size_t kPoints = 4096;
  static constexpr double kStep_m = 2.5e-4;
  static constexpr double kClear_m = 0.015;  ///< so far before the entry a tool is out of the bone

  struct Snapshot {
    std::vector<math::Vec3> points_m;        ///< in V; the last is where the tip is
    std::optional<trial::Sample> deepest;    ///< the tip's, along the tract
    std::optional<trial::Sample> withdrawn;  ///< the last within kClear_m of the entry
  };

  TipWay(const trial::ProbeShape& probe, const volume::Tract& tract)
      : probe_(probe), tract_(tract) {}
  /// The next ones, from the one thread that records.
  void add(std::span<const trial::Sample> samples);
  /// Brings `seen` up to date; leaves it as it is while samples come in. From any thread, never
  /// waits.
  void show(Snapshot& seen) const;

 private:
  void add_point(const math::Vec3& tip_m);

  trial::ProbeShape probe_;
  volume::Tract tract_;
  mutable std::mutex mutex_;  // of all below
  double step_m_ = kStep_m, deepest_m_ = 0.0;
  math::Vec3 last_m_ = math::Vec3::Zero();
  Snapshot seen_;
};

}  // namespace tractus::session
