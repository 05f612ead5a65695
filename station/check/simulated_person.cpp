#include "station/check/simulated_person.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tractus {
namespace check {
namespace {
using math::Vec3;

constexpr double kHand_N_per_m = 400.0, kFollows_s = 0.005;
constexpr double kReach_m = 0.020;  // of a stroke, up and down
constexpr double kStrokeEach_s = 3.0, kFirst_s = 0.5;
constexpr double kPressed_m = 0.010;  // to the right, beyond the wall's 5 mm
constexpr double kPlaceWidth_m = 0.001;
constexpr double kFromMiddle_s = 0.25, kToMiddle_s = 0.75;  // of a push of 1 s
constexpr double kThreeQuarters = 0.67448975;               // Φ⁻¹(0.75)

/// Where the hand means to be, t after a stroke began: to the wall, then down and up.
Vec3 stroking(double t_s) {
  const double in = std::clamp(t_s / kFirst_s, 0.0, 1.0);
  const double way = std::clamp((t_s - kFirst_s) / (kStrokeEach_s - kFirst_s), 0.0, 1.0);
  return {0.0, in * kPressed_m, kReach_m * std::sin(2.0 * std::numbers::pi * way)};
}
}  // namespace

SimulatedPerson::SimulatedPerson(const devices::HandSense& sense, std::uint64_t seed)
    : sense_(sense), random_(seed) {}

Asked SimulatedPerson::asked() {
  return {.begins = [this](Stimulus stimulus, Moment moment) { begins(stimulus, moment); },
          .answer =
              [this] {
                const double first = felt_[0], second = felt_[1];
                return first > second ? 1 : 2;
              }};
}

// Two intervals of which the greater holds x more: right with Φ(x/√(σ₁² + σ₂²)) = 0.75.
double SimulatedPerson::threshold(Stimulus stimulus) const {
  const double t2 = std::pow(sense_.force_threshold_N, 2), w2 = std::pow(sense_.force_weber, 2);
  if (stimulus == Stimulus::gap) {
    const double wall_N = 0.5 * kHand_N_per_m * (kPressed_m - 0.005);  // two equal springs
    return kThreeQuarters * std::sqrt(2.0 * (t2 + w2 * wall_N * wall_N)) / (0.5 * kHand_N_per_m);
  }
  const double from_N = stimulus == Stimulus::difference ? kReference_N : 0.0;
  double x = 0.0;
  for (int n = 0; n < 50; ++n)
    x = kThreeQuarters * std::sqrt(2.0 * t2 + w2 * (from_N * from_N + (from_N + x) * (from_N + x)));
  return x;
}

void SimulatedPerson::begins(Stimulus stimulus, Moment moment) {
  if (moment_ == Moment::first) felt_[0] = perceived();
  if (moment_ == Moment::second) felt_[1] = perceived();
  stimulus_ = stimulus, moment_ = moment, began_ = now_;
  sum_N_ = 0.0, count_ = 0;
  place_N_.fill(0.0), place_count_.fill(0);
}

double SimulatedPerson::perceived() {
  double force_N = count_ > 0 ? sum_N_ / double(count_) : 0.0, out = force_N;
  if (stimulus_ == Stimulus::gap) {
    double least_N = 1e300;
    for (int place = 0; place < kPlaces; ++place)
      if (const long count = place_count_[std::size_t(place)]; count > 0)
        least_N = std::min(least_N, place_N_[std::size_t(place)] / double(count));
    out = force_N - least_N;
  }
  return out +
         std::hypot(sense_.force_threshold_N, sense_.force_weber * force_N) * normal_(random_);
}

core::Result<devices::Limits> SimulatedPerson::open() {
  return devices::Limits{20.0, 0.2, 4000.0, "simulated person", true};
}

devices::Status SimulatedPerson::read(core::Instant_ns now, devices::Sample& out) noexcept {
  const double gap_s = std::min(1e-3, double(now - now_) * 1e-9), t_s = double(now - began_) * 1e-9;
  now_ = now;
  const bool interval = moment_ == Moment::first || moment_ == Moment::second;
  const bool strokes = interval && stimulus_ == Stimulus::gap;
  const Vec3 to = (strokes ? stroking(t_s) : Vec3(Vec3::Zero())) + wrench_.force_N / kHand_N_per_m;
  p_ += std::min(1.0, gap_s / kFollows_s) * (to - p_);
  if (strokes && t_s > kFirst_s) {
    const int place = std::clamp(int((p_.z() + kReach_m) / kPlaceWidth_m), 0, kPlaces - 1);
    place_N_[std::size_t(place)] -= wrench_.force_N.y(), ++place_count_[std::size_t(place)];
    sum_N_ -= wrench_.force_N.y(), ++count_;
  } else if (interval && t_s > kFromMiddle_s && t_s < kToMiddle_s) {
    sum_N_ += wrench_.force_N.y(), ++count_;
  }
  out = {};
  out.stamp = now;
  out.X_DH.p = p_;
  return devices::Status::ok;
}

devices::Status SimulatedPerson::write(const math::Wrench& on_hand_D) noexcept {
  wrench_ = on_hand_D;
  return devices::Status::ok;
}

}  // namespace check
}  // namespace tractus
