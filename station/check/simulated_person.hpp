/// A SIMULATED person who holds a handle and answers questions of measure_threshold. Its thresholds
/// are known: tests and rehearsals, never a measurement of anyone.
#pragma once

#include <random>
#include <vector>

#include "station/check/threshold.hpp"
#include "station/devices/catalogue.hpp"

namespace tractus::check {

/// The handle hangs on a hand of 400 N/m that follows within 5 ms. Of a push it perceives the mean
/// over the middle half of an interval; of a stroke along a wall, how far the least push of a
/// millimetre lies below the mean. Each is wrong by a normal error, √(t² + (w F)²)
/// (devices::HandSense). It says the interval with more.
class SimulatedPerson final : public devices::Device {
 public:
  SimulatedPerson(const devices::HandSense& sense, std::uint64_t seed);
  Asked asked();

  /// The level at which it is right in three of four answers, from its senses alone.
  double threshold(Stimulus stimulus) const;

  core::Result<devices::Limits> open() override;
  devices::Status read(core::Instant_ns now, devices::Sample& out) noexcept override;
  devices::Status write(const math::Wrench& on_hand_D) noexcept override;
  void close() noexcept override {}

 private:
  void begins(Stimulus stimulus, Moment moment);
  double perceived();

  devices::HandSense sense_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  Stimulus stimulus_ = Stimulus::detection;
  Moment moment_ = Moment::pause;
  core::Instant_ns now_ = 0, began_ = 0;
  math::Vec3 p_ = math::Vec3::Zero();
  math::Wrench wrench_;
  std::array<double, 2> felt_{};
  double sum_N_ = 0.0;
  long count_ = 0;
  static constexpr int kPlaces = 40;
  std::array<double, kPlaces> place_N_{};
  std::array<long, kPlaces> place_count_{};
};

}  // namespace tractus::check
