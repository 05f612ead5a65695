#include "station/devices/felt_breach.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace tractus {
namespace devices {
namespace {
constexpr double kQuick_s = 0.05, kSlow_s = 1.0;
constexpr double kLeast_m_s = 0.001, kLeast_N = 5.0;  // below that nothing is compared
// Five times as fast: ln 5. The tuned walls make a hand feel some 2.1, borders of layers 1.1.
constexpr double kThreshold = 1.6;
constexpr double kUnskilled_m = 0.004, kSkilled_m = 0.0015;  // of the remembered depth
constexpr double kDeepest_m = 0.1;
constexpr double kUnskilled = 0.6, kSkilled = 0.25;  // noise of the perceived strength
}  // namespace

FeltBreach::FeltBreach(std::uint64_t seed, double skill, double period_s)
    : seed_(seed),
      skill_(std::clamp(skill, 0.0, 1.0)),
      quick_(-std::expm1(-period_s / kQuick_s)),
      slow_(-std::expm1(-period_s / kSlow_s)) {}

void FeltBreach::feel(double speed_m_s, double push_N, double x_m) noexcept {
  speed_m_s_ += quick_ * (speed_m_s - speed_m_s_);
  push_N_ += quick_ * (push_N - push_N_);
  settled_ += slow_ * (1.0 - settled_);
  usual_m_s_ += slow_ * (speed_m_s - usual_m_s_);
  usual_N_ += slow_ * (push_N - usual_N_);
  if (settled_ < 0.6 || usual_N_ < kLeast_N * settled_) return;
  const double faster =
      std::log(std::max(speed_m_s_, kLeast_m_s) / std::max(usual_m_s_ / settled_, kLeast_m_s));
  if (faster <= strongest_) return;
  strongest_ = faster;
  strongest_m_ = x_m;
}

double FeltBreach::depth_m() const noexcept {
  std::mt19937_64 random(seed_ ^ 0xd1b54a32d192ed03ull);
  std::normal_distribution<double> normal;
  const double off_m = std::lerp(kUnskilled_m, kSkilled_m, skill_) * normal(random);
  return std::clamp(strongest_m_ + off_m, 0.0, kDeepest_m);
}

SimulatedAnswer FeltBreach::answer() const noexcept {
  std::mt19937_64 random(seed_ ^ 0x9e3779b97f4a7c15ull);
  std::normal_distribution<double> normal;
  const double perceived = strongest_ + std::lerp(kUnskilled, kSkilled, skill_) * normal(random);
  SimulatedAnswer out;
  out.breach = perceived > kThreshold;
  if (out.breach) out.wall = "lateral";
  out.confidence = 1.0 - 0.5 * std::exp(-2.0 * std::abs(perceived - kThreshold));
  return out;
}

}  // namespace devices
}  // namespace tractus
