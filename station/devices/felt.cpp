#include "station/devices/felt.hpp"

#include <algorithm>
#include <cmath>

namespace tractus {
namespace devices {
namespace {
constexpr double kWeber = 0.1;
constexpr double kSideThreshold = 0.25;      // of the other walls' push: below, "nothing there"
constexpr double kEndThreshold_m = 0.0022;   // a tap that goes farther than sides gave way
constexpr double kShankFeel_N_per_m = 15.0;  // a bent probe's push per millimetre, from practice
constexpr double kFirm_N_per_m = 5.0;        // softer all round: nobody can tell
constexpr std::uint32_t kMinCount = 20;
constexpr std::size_t kWindow = 3;  // bins that are felt as one place
constexpr std::array<const char*, 4> kWallNames{"medial", "superior", "lateral", "inferior"};

double noise(std::uint64_t& state) {  // −1 … 1, SplitMix64 [Steele2014]
  std::uint64_t z = (state += 0x9e3779b97f4a7c15ull);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
}

/// The middle two of four.
double usual_of(std::array<double, 4> values) {
  std::ranges::sort(values);
  return 0.5 * (values[1] + values[2]);
}

double confidence_of(double distance) { return std::clamp(0.5 + distance, 0.5, 0.99); }
}  // namespace

FeltResistance::Bin& FeltResistance::Bin::operator+=(const Bin& other) noexcept {
  resistance_N += other.resistance_N;
  lean_m += other.lean_m;
  count += other.count;
  return *this;
}

void FeltResistance::note(const Intent& intent, double share, double lean_m,
                          double resistance_N) noexcept {
  if (intent.act == Act::tap) tap_lean_m_ = std::max(tap_lean_m_, lean_m);
  if (intent.act != Act::stroke || lean_m < kMinLean_m) return;
  const int bin = std::clamp(static_cast<int>(share * kBins), 0, kBins - 1);
  walls_[std::size_t(intent.wall)][std::size_t(bin)] += {resistance_N, lean_m, 1};
}

FeltResistance::Bin FeltResistance::place(std::size_t wall, std::size_t first,
                                          std::size_t bins) const noexcept {
  Bin out;
  for (std::size_t bin = first; bin < first + bins; ++bin) out += walls_[wall][bin];
  return out;
}

// The least push per lean at any place of a wall, as a share of what the four walls give there.
FeltResistance::Weakest FeltResistance::weakest(std::uint64_t& random) const noexcept {
  Weakest out;
  for (std::size_t first = 0; first + kWindow <= kBins; ++first) {
    std::array<double, 4> push{};
    bool felt = true;
    for (std::size_t wall = 0; wall < 4; ++wall) {
      const Bin here = place(wall, first, kWindow);
      felt = felt && here.count >= kMinCount;
      push[wall] =
          here.resistance_N / std::max(here.lean_m, kMinLean_m) * (1.0 + kWeber * noise(random));
    }
    const double usual = usual_of(push);
    if (!felt || usual < kFirm_N_per_m) continue;
    for (std::size_t wall = 0; wall < 4; ++wall)
      if (push[wall] / usual < out.share) out = {push[wall] / usual, wall};
  }
  return out;
}

// How far sides gave way before they held: lean less what the shank took up by bending.
double FeltResistance::side_give_m() const noexcept {
  std::array<double, 4> give{};
  for (std::size_t wall = 0; wall < 4; ++wall) {
    const Bin all = place(wall, 0, kBins);
    const double bent_m = all.resistance_N / kShankFeel_N_per_m;
    give[wall] = all.count ? std::max(0.0, (all.lean_m - bent_m) / all.count) : 0.0;
  }
  return usual_of(give);
}

SimulatedAnswer FeltResistance::answer(std::uint64_t seed) const noexcept {
  std::uint64_t random = seed ^ 0x5eed0fee1ull;
  const Weakest side = weakest(random);
  if (side.share < kSideThreshold)
    return {true, kWallNames[side.wall], confidence_of(kSideThreshold - side.share)};
  const double beyond_m = tap_lean_m_ * (1.0 + kWeber * noise(random)) - side_give_m();
  if (beyond_m > kEndThreshold_m)
    return {true, "anterior", confidence_of((beyond_m - kEndThreshold_m) / kEndThreshold_m)};
  if (side.share > 1.0) return {false, "", confidence_of(0.0)};  // no place was felt all round
  return {false, "", confidence_of(side.share - kSideThreshold)};
}

}  // namespace devices
}  // namespace tractus
