#pragma once
/// Random numbers that are the same on every machine: the engine is the standard's, the
/// distributions are ours.
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace blind {

class Random {
 public:
  explicit Random(std::uint64_t seed)
      : engine_(seed * 0x9E3779B97F4A7C15ULL + 0x632BE59BD9B4E019ULL) {
    engine_.discard(16);
  }
  /// A stream of its own, which later draws from this one do not shift.
  Random split() { return Random(engine_()); }
  /// 0 <= value < 1.
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * unit(); }
  /// Uniform in the logarithm; both bounds positive.
  double log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  bool chance(double probability) { return unit() < probability; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }
  /// 0 … count − 1.
  int below(int count) { return static_cast<int>(unit() * count); }
  /// Standard normal, Box and Muller.
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - unit()));
    return radius * std::cos(2.0 * std::numbers::pi * unit());
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace blind
