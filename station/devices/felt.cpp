#include "station/devices/felt.hpp"

#include <algorithm>
#include <cmath>

namespace devices {
namespace {
constexpr double kWeber = 0.1;
constexpr double kSideThreshold =
    0.55;  // of the other walls' push per lean: below it, "nothing there"
constexpr double kEndThreshold_m =
    0.0022;  // beyond the planned end: a whole bone stops a tap before
constexpr double kMinLean_m = 0.0005;
constexpr std::uint32_t kMinCount = 20;
constexpr std::array<const char*, 4> kWallNames{"medial", "superior", "lateral", "inferior"};

double noise(std::uint64_t& state) {  // −1 … 1, SplitMix64
  std::uint64_t z = (state += 0x9e3779b97f4a7c15ull);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
}

double confidence_of(double distance) { return std::clamp(0.5 + distance, 0.5, 0.99); }
}  // namespace

void FeltResistance::note(const Intent& intent, double share, double lean_m,
                          double resistance_N) noexcept {
  if (intent.act == Act::tap) {
    ++taps_;
    tap_resistance_N_ = std::max(tap_resistance_N_, resistance_N);
    tap_lean_m_ = std::max(tap_lean_m_, lean_m);
  }
  if (intent.act != Act::stroke || lean_m < kMinLean_m) return;
  const int bin = std::clamp(static_cast<int>(share * kBins), 0, kBins - 1);
  Bin& into = walls_[std::size_t(intent.wall)][std::size_t(bin)];
  into.resistance_N += resistance_N;
  into.lean_m += lean_m;
  ++into.count;
}

Answer FeltResistance::answer(std::uint64_t seed) const noexcept {
  std::uint64_t state = seed ^ 0x5eed0fee1ull;
  double weakest = 1e9;
  std::size_t weakest_wall = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    std::array<double, 4> push{}, sorted{};
    bool whole = true;
    for (std::size_t wall = 0; wall < 4; ++wall) {
      const Bin& felt = walls_[wall][bin];
      whole = whole && felt.count >= kMinCount;
      push[wall] =
          felt.resistance_N / std::max(felt.lean_m, kMinLean_m) * (1.0 + kWeber * noise(state));
    }
    sorted = push;
    std::ranges::sort(sorted);
    const double usual = 0.5 * (sorted[2] + sorted[1]);
    if (!whole || usual <= 0.0) continue;
    for (std::size_t wall = 0; wall < 4; ++wall)
      if (push[wall] / usual < weakest) weakest = push[wall] / usual, weakest_wall = wall;
  }
  const double beyond_m = tap_lean_m_ * (1.0 + kWeber * noise(state));
  if (taps_ > 0 && beyond_m > kEndThreshold_m)
    return {true, "anterior", confidence_of((beyond_m - kEndThreshold_m) / kEndThreshold_m)};
  if (weakest < kSideThreshold)
    return {true, kWallNames[weakest_wall], confidence_of(kSideThreshold - weakest)};
  return {false, "", confidence_of(std::min(weakest, 1.0) - kSideThreshold)};
}

}  // namespace devices
