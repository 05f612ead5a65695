#include "station/devices/felt.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tractus {
namespace devices {
namespace {
constexpr double kPerceived_m = 0.002;  // what is one impression in a stroke, some 0.2 s of it
constexpr double kCaughtWithin_m = 0.003;
constexpr int kLeastFelt = 2;  // places to each side
constexpr double kHole_m = 0.0015, kBeside_m = 0.004, kFarBeside_m = 0.007;
constexpr double kGivesWeight = 0.2;
constexpr double kThrough_N = 0.06;
constexpr double kHoleLike_N = 0.045;  // more: a hole
constexpr double kNoEnd_N = 0.15;      // of a tap, less: nothing stopped it
constexpr double kApart_m = 0.004;     // of two suspects on one wall
constexpr double kRim_m = 0.006;       // behind the first place that is enclosed
constexpr double kThinRim_m = 0.007;   // behind that, where thin bone often lets a tip through
constexpr double kNever = -1e9;
constexpr std::array<const char*, 4> kWallNames{"medial", "superior", "lateral", "inferior"};

double uniform_of(std::uint64_t z) {  // 0 … 1, SplitMix64 [Steele2014]
  z += 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return (static_cast<double>((z ^ (z >> 31)) >> 11) + 0.5) * 0x1p-53;
}

double confidence_of(double over) { return std::clamp(0.5 + 0.25 * over, 0.5, 0.99); }
}  // namespace

double normal_of(std::uint64_t key) noexcept {
  return std::sqrt(-2.0 * std::log(uniform_of(2 * key))) *
         std::cos(2.0 * std::numbers::pi * uniform_of(2 * key + 1));
}

double error_N(const HandSense& sense, double force_N) noexcept {
  return std::hypot(sense.force_threshold_N, sense.force_weber * force_N);
}

FeltWalls::FeltWalls(const DeviceOptions& options)
    : seed_(options.seed),
      sense_(options.sense),
      rim_m_(options.channel.enclosed_from_m + kRim_m),
      places_(std::clamp(int(options.channel.length_m / kPlace_m), 1, kPlaces)) {}

void FeltWalls::note_stroke(const Intent& intent, double depth_m, double push_N,
                            double outward_N) noexcept {
  const int place = std::clamp(int(depth_m / kPlace_m), 0, places_ - 1);
  Look& look = walls_[std::size_t(intent.wall)][std::size_t(place)][std::size_t(intent.look)];
  look.push_N += float(push_N);
  look.outward_N += float(outward_N);
  ++look.count;
}

void FeltWalls::note_through(const Intent& intent, double depth_m) noexcept {
  const int place = std::clamp(int(depth_m / kPlace_m), 0, places_ - 1);
  walls_[std::size_t(intent.wall)][std::size_t(place)][std::size_t(intent.look)].through = true;
}

void FeltWalls::note_tap(double outward_N) noexcept { tap_N_ = std::max(tap_N_, outward_N); }

void FeltWalls::end_tap() noexcept {
  taps_N_ += tap_N_, ++taps_;
  tap_N_ = 0.0;
}

// Of the looks `from` … `to` − 1.
FeltWalls::Walls FeltWalls::felt(int from, int to) const noexcept {
  const double share = std::sqrt(kPerceived_m / kPlace_m);
  Walls out{};
  for (std::size_t wall = 0; wall < 4; ++wall)
    for (std::size_t place = 0; place < std::size_t(places_); ++place) {
      int looks = 0;
      Felt& felt = out[wall][place];
      for (int look = from; look < to; ++look) {
        const Look& was = walls_[wall][place][std::size_t(look)];
        felt.through = felt.through || was.through;
        if (was.count == 0) continue;
        const double push_N = double(was.push_N) / was.count,
                     outward_N = double(was.outward_N) / was.count;
        const double error = share * error_N(sense_, std::hypot(push_N, outward_N));
        const auto key = (seed_ * 1'000'003u + (wall * 128 + place) * 8 + std::uint64_t(look)) * 2;
        felt.push_N += push_N + error * normal_of(key);
        felt.outward_N += outward_N + error * normal_of(key + 1);
        ++looks;
      }
      felt.at_all = looks > 0;
      if (looks > 0) felt.push_N /= looks, felt.outward_N /= looks;
    }
  return out;
}

// Caught and gives, of one wall. `place` is where the one ends and the next begins.
double FeltWalls::likeness_at(const std::array<Felt, kPlaces>& wall, int place) noexcept {
  std::array<double, 2> caught{};  // on its way out of the bone, into it
  std::array<int, 2> within{};
  double hole = 0.0, beside = 0.0;
  int in_hole = 0, at_side = 0;
  bool through = false;
  const int far = int(kFarBeside_m / kPlace_m);
  for (int other = std::max(0, place - far); other < std::min(kPlaces, place + far); ++other) {
    const Felt& felt = wall[std::size_t(other)];
    const double away_m = (other + 0.5 - place) * kPlace_m;  // positive: deeper
    through = through || (felt.through && std::abs(away_m) < kHole_m);
    if (!felt.at_all) continue;
    if (std::abs(away_m) < kCaughtWithin_m) {
      const std::size_t side = away_m > 0.0 ? 1 : 0;
      caught[side] += side == 1 ? felt.outward_N : -felt.outward_N, ++within[side];
    }
    if (std::abs(away_m) < kHole_m) hole += felt.push_N, ++in_hole;
    if (std::abs(away_m) > kBeside_m) beside += felt.push_N, ++at_side;
  }
  double like = kNever;
  if (std::min(within[0], within[1]) >= kLeastFelt) {
    const double gives = in_hole > 0 && at_side > 2 ? beside / at_side - hole / in_hole : 0.0;
    like = std::min(caught[0] / within[0], caught[1] / within[1]) + kGivesWeight * gives;
  }
  return through ? kThrough_N + std::max(0.0, like) : like;
}

// Depth from which places count.
double FeltWalls::counts_from_m() const noexcept {
  const auto gave_way = [&](const auto& wall) {
    for (int place = 0; place * kPlace_m < rim_m_ + kThinRim_m && place < kPlaces; ++place)
      for (const Look& look : wall[std::size_t(place)])
        if (look.through) return true;
    return false;
  };
  return std::ranges::count_if(walls_, gave_way) > 1 ? rim_m_ + kThinRim_m : rim_m_;
}

FeltWalls::Likeness FeltWalls::likeness(const Walls& walls) const noexcept {
  const double from_m = counts_from_m();
  Likeness out;
  for (std::size_t wall = 0; wall < 4; ++wall)
    for (int place = 0; place < kPlaces; ++place)
      out[wall][std::size_t(place)] =
          place * kPlace_m < from_m ? kNever : likeness_at(walls[wall], place);
  return out;
}

std::array<Suspect, PalpationPlan::kSuspects> FeltWalls::suspects() const noexcept {
  const Likeness like = likeness(felt(0, PalpationPlan::kFirstLooks));
  std::array<Suspect, PalpationPlan::kSuspects> out{};
  for (std::size_t n = 0; n < out.size(); ++n) {
    double most = kNever;
    for (int wall = 0; wall < 4; ++wall)
      for (int place = 0; place < kPlaces; ++place) {
        const double depth_m = place * kPlace_m, is = like[std::size_t(wall)][std::size_t(place)];
        const auto near = [&](const Suspect& s) {
          return s.wall == wall && std::abs(s.depth_m - depth_m) < kApart_m;
        };
        if (is <= most || std::any_of(out.begin(), out.begin() + std::ptrdiff_t(n), near)) continue;
        most = is, out[n] = {wall, depth_m};
      }
  }
  return out;
}

FeltWalls::Likest FeltWalls::likest() const noexcept {
  const Likeness like = likeness(felt(PalpationPlan::kFirstLooks, PalpationPlan::kLooks));
  Likest out{.wall = 0, .like_N = kNever};
  for (std::size_t wall = 0; wall < 4; ++wall)
    for (const double is : like[wall])
      if (is > out.like_N) out = {wall, is};
  return out;
}

SimulatedAnswer FeltWalls::answer() const {
  if (taps_ > 0) {
    const double tap_N = taps_N_ / taps_;
    const double felt_N =
        tap_N + error_N(sense_, tap_N) / std::sqrt(taps_) * normal_of(seed_ ^ 0x5eed0fee1ull);
    if (felt_N < kNoEnd_N)
      return {true, "anterior", confidence_of(2.0 * (1.0 - felt_N / kNoEnd_N))};
  }
  const Likest side = likest();
  const double over = side.like_N / kHoleLike_N - 1.0;
  if (over > 0.0) return {true, kWallNames[side.wall], confidence_of(over)};
  return {false, "", confidence_of(-over)};
}

}  // namespace devices
}  // namespace tractus
