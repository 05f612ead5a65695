/// A haptic device driven tick by tick, every force through the limiter.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/try.hpp"
#include "station/check/device_check.hpp"

namespace tractus::check {

/// Armed from its making to its end; left at zero force.
class Driver {
 public:
  explicit Driver(Bench& bench)
      : bench_(bench),
        period_(core::Instant_ns(std::llround(1e9 / bench.rate_Hz))),
        next_(bench.clock.now()) {
    bench_.limiter.arm();
  }
  ~Driver() {
    bench_.limiter.disarm();
    static_cast<void>(bench_.device.write({}));
  }
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  /// One tick with this wrench wanted. Errors: unavailable, cancelled.
  core::Result<devices::Sample> tick(const math::Wrench& wanted) {
    bench_.clock.sleep_until(next_);
    const core::Instant_ns now = bench_.clock.now();
    next_ = std::max(next_ + period_, now);
    devices::Sample sample;
    const core::Instant_ns asked = bench_.wall.now();
    const devices::Status status = bench_.device.read(now, sample);
    const core::Instant_ns came = bench_.wall.now();
    const auto passed = bench_.limiter.pass(now, status, sample, wanted);
    const core::Instant_ns decided = bench_.wall.now();
    const devices::Status given = bench_.device.write(passed.wrench);
    trips_.add(bench_.wall.now() - decided + came - asked);
    if (const auto fault = loop::fault_of(given); fault != loop::Fault::none)
      bench_.limiter.fail(fault);
    if (bench_.limiter.guard() == loop::Guard::latched)
      return core::Error{core::Errc::unavailable,
                         fmt::format("stopped: {}", loop::text_of(bench_.limiter.fault()))};
    return sample;
  }

  /// For so long; `each` sees every sample and the time since the start of it.
  template <class Each>
  core::Result<void> run(double for_s, const math::Wrench& wanted, const Each& each) {
    const int ticks = int(for_s * bench_.rate_Hz), shown = std::max(1, int(bench_.rate_Hz / 30.0));
    for (int k = 0; k < ticks; ++k) {
      auto sample = TRY(tick(wanted));
      each(double(k) / bench_.rate_Hz, sample);
      elapsed_s_ += 1.0 / bench_.rate_Hz;
      if (k % shown == 0 && bench_.progress &&
          !bench_.progress(std::min(1.0, elapsed_s_ / plan_s_)))
        return core::Error{core::Errc::cancelled, "stopped"};
    }
    return {};
  }
  core::Result<void> run(double for_s, const math::Wrench& wanted) {
    return run(for_s, wanted, [](double, const devices::Sample&) {});
  }

  /// Mean pose over a moment.
  core::Result<math::Pose> mean_pose(double for_s, const math::Wrench& wanted) {
    math::Vec3 sum = math::Vec3::Zero();
    Eigen::Vector4d turn = Eigen::Vector4d::Zero();
    int count = 0;
    TRY(run(for_s, wanted, [&](double, const devices::Sample& sample) {
      const Eigen::Vector4d q = sample.X_DH.q.coeffs();
      turn += turn.dot(q) < 0.0 ? -q : q;
      sum += sample.X_DH.p;
      ++count;
    }));
    return math::Pose{sum / count, math::Quat(Eigen::Vector4d(turn.normalized()))};
  }

  void plan(double for_s) { plan_s_ = for_s; }  ///< what `progress` shares
  const Durations& trips() const { return trips_; }

 private:
  static constexpr std::size_t kTrips = 1 << 16;
  Bench& bench_;
  core::Instant_ns period_, next_;
  Durations trips_{kTrips};
  double elapsed_s_ = 0.0, plan_s_ = 1.0;
};

}  // namespace tractus::check
