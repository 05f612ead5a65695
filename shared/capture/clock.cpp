#include "capture/clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/try.hpp"
#include "math/spline.hpp"

namespace tractus {
namespace capture {
namespace {
constexpr double kRhythm_s = 0.025;  // of peaks, before the fine fit
constexpr double kSearch_s = 0.03, kStep_s = 0.0005;
constexpr double kInContact = 0.15;  // of a tap's peak
constexpr double kTogether = 0.6, kLargestSd_s = 0.008;
constexpr double kAgree_s = 0.03, kMostDrift = 1e-3;
constexpr double kApart_s = 5.0;  // of runs that tell a drift
constexpr std::size_t kMostCandidates = 100'000, kMostPairs = 500;
constexpr double kRival = 0.8;  // of the best one's score: cannot be told apart

/// The force of one tap while in contact, about its mean.
struct Contact {
  std::vector<double> t_s, force_N;
};

struct Candidate {
  const TapRun* force;
  const TapRun* motion;
  double rhythm_s, offset_s;
};

double rms_of_rhythm(const TapRun& a, const TapRun& b) {
  double sum = 0.0;
  for (std::size_t k = 1; k < a.at_s.size(); ++k) {
    const double off = (a.at_s[k] - a.at_s[k - 1]) - (b.at_s[k] - b.at_s[k - 1]);
    sum += off * off;
  }
  return std::sqrt(sum / double(std::max<std::size_t>(1, a.at_s.size() - 1)));
}

/// Step 1: those whose rhythm fits, best first; `nearest_s` is how well the best of all fits.
std::vector<Candidate> candidates(const std::vector<TapRun>& force,
                                  const std::vector<TapRun>& motion, double& nearest_s) {
  std::vector<Candidate> out;
  nearest_s = 1e300;
  for (const TapRun& f : force)
    for (const TapRun& m : motion) {
      const double rhythm_s = rms_of_rhythm(f, m);
      nearest_s = std::min(nearest_s, rhythm_s);
      if (rhythm_s > kRhythm_s || out.size() == kMostCandidates) continue;
      double sum = 0.0;
      for (std::size_t k = 0; k < f.at_s.size(); ++k) sum += f.at_s[k] - m.at_s[k];
      out.push_back({&f, &m, rhythm_s, sum / double(f.at_s.size())});
    }
  std::ranges::sort(out, {}, &Candidate::rhythm_s);
  return out;
}

/// Samples round the peak, as long as the force stays above its share of it.
Contact contact_at(const Tapped& tapped, double at_s, double peak_N) {
  const auto& t = tapped.force_t_s;
  const auto& f = tapped.force_N;
  const auto mid = std::size_t(std::ranges::lower_bound(t, at_s) - t.begin());
  Contact out;
  std::size_t from = std::min(mid, t.size() - 1), to = from;
  while (from > 0 && f[from - 1] > kInContact * peak_N) --from;
  while (to + 1 < t.size() && f[to + 1] > kInContact * peak_N) ++to;
  out.t_s.assign(t.begin() + std::ptrdiff_t(from), t.begin() + std::ptrdiff_t(to) + 1);
  out.force_N.assign(f.begin() + std::ptrdiff_t(from), f.begin() + std::ptrdiff_t(to) + 1);
  double mean = 0.0;
  for (const double v : out.force_N) mean += v / double(out.force_N.size());
  for (double& v : out.force_N) v -= mean;
  return out;
}

/// Share of the contacts' variance that the way explains at an offset; 0 where force falls with it.
double together(std::span<const Contact> contacts, const math::CubicSpline& way, double offset_s) {
  double ff = 0.0, fw = 0.0, ww = 0.0;
  std::vector<double> w;
  for (const Contact& contact : contacts) {
    w.clear();
    double mean = 0.0;
    for (const double t : contact.t_s) w.push_back(way.value(t - offset_s));
    for (const double v : w) mean += v / double(w.size());
    for (std::size_t k = 0; k < w.size(); ++k) {
      ff += contact.force_N[k] * contact.force_N[k];
      fw += contact.force_N[k] * (w[k] - mean);
      ww += (w[k] - mean) * (w[k] - mean);
    }
  }
  return fw > 0.0 && ff > 0.0 && ww > 0.0 ? fw * fw / (ff * ww) : 0.0;
}

struct Best {
  double offset_s, together;
};

/// The best offset about a rough one: a grid, then the parabola through its highest three.
Best best_offset(std::span<const Contact> contacts, const math::CubicSpline& way, double rough_s) {
  const int steps = int(kSearch_s / kStep_s);
  std::vector<double> r;
  for (int k = -steps; k <= steps; ++k) r.push_back(together(contacts, way, rough_s + k * kStep_s));
  const auto k = std::size_t(std::ranges::max_element(r) - r.begin());
  Best out{rough_s + (int(k) - steps) * kStep_s, r[k]};
  if (k == 0 || k + 1 == r.size()) return out;
  const double bend = r[k - 1] - 2.0 * r[k] + r[k + 1];
  if (bend < 0.0)
    out.offset_s += kStep_s * std::clamp(0.5 * (r[k - 1] - r[k + 1]) / bend, -0.5, 0.5);
  return out;
}

/// Step 2: nothing where force and way do not go together, or taps do not agree.
std::optional<TapPair> fine(const Tapped& tapped, const Candidate& candidate) {
  const TapRun &f = *candidate.force, &m = *candidate.motion;
  const auto& t = tapped.motion_t_s;
  const auto from = std::ranges::lower_bound(t, m.at_s.front() - 0.5) - t.begin();
  const auto to = std::ranges::upper_bound(t, m.at_s.back() + 0.5) - t.begin();
  std::vector<double> way;
  for (auto k = from; k < to; ++k) way.push_back(m.inward.dot(tapped.tip_m[std::size_t(k)]));
  const auto spline =
      math::CubicSpline::make(t.subspan(std::size_t(from), std::size_t(to - from)), way);
  if (!spline) return std::nullopt;
  std::vector<Contact> contacts;
  for (std::size_t k = 0; k < f.at_s.size(); ++k)
    contacts.push_back(contact_at(tapped, f.at_s[k], f.height[k]));
  const Best best = best_offset(contacts, *spline, candidate.offset_s);
  TapPair out{m.at_s, m.inward, best.offset_s, 0.0, best.together};
  double sum = 0.0;
  for (const Contact& one : contacts) {
    const double off = best_offset({&one, 1}, *spline, best.offset_s).offset_s - best.offset_s;
    sum += off * off;
  }
  const double n = double(contacts.size());
  const double sd_of_one = std::sqrt(sum / (n - 1.0));
  out.sd_s = sd_of_one / std::sqrt(n);
  if (best.together < kTogether || sd_of_one > kLargestSd_s) return std::nullopt;
  return out;
}

bool overlap(const TapPair& a, const TapPair& b) {
  return a.taps_s.front() <= b.taps_s.back() && b.taps_s.front() <= a.taps_s.back();
}

/// Step 3: the pairs that agree with one, the best of those that overlap, by time.
std::vector<TapPair> agreeing(const std::vector<TapPair>& pairs, const TapPair& with) {
  std::vector<TapPair> fit;
  for (const TapPair& p : pairs) {
    const double apart_s = std::abs(p.taps_s.front() - with.taps_s.front());
    if (std::abs(p.offset_s - with.offset_s) < kAgree_s + kMostDrift * apart_s) fit.push_back(p);
  }
  std::ranges::sort(fit, std::greater<>(), &TapPair::together);
  std::vector<TapPair> out;
  for (const TapPair& p : fit)
    if (std::ranges::none_of(out, [&](const TapPair& q) { return overlap(p, q); }))
      out.push_back(p);
  std::ranges::sort(out, {}, [](const TapPair& p) { return p.taps_s.front(); });
  return out;
}

double score(const std::vector<TapPair>& runs) {
  double sum = 0.0;
  for (const TapPair& p : runs) sum += p.together;
  return sum;
}

/// A line through the runs' offsets; level when they lie close in time.
ClockFit line_through(std::vector<TapPair> runs) {
  ClockFit out;
  double mean_s = 0.0, mean_o = 0.0;
  for (const TapPair& p : runs) {
    mean_s += p.taps_s[p.taps_s.size() / 2] / double(runs.size());
    mean_o += p.offset_s / double(runs.size());
  }
  double tt = 0.0, to = 0.0, var = 0.0;
  for (const TapPair& p : runs) {
    const double t = p.taps_s[p.taps_s.size() / 2] - mean_s;
    tt += t * t;
    to += t * (p.offset_s - mean_o);
    var += p.sd_s * p.sd_s;
  }
  out.at_s = mean_s;
  out.offset_s = mean_o;
  if (runs.back().taps_s.front() - runs.front().taps_s.front() > kApart_s) out.drift = to / tt;
  out.sd_s = std::sqrt(var) / double(runs.size());
  out.runs = std::move(runs);
  return out;
}
/// Steps 1 and 2: the same taps in both.
core::Result<std::vector<TapPair>> pairs_of(const Tapped& tapped, int count) {
  const auto force = force_taps(tapped.force_t_s, tapped.force_N, count);
  if (force.empty())
    return core::bad_input(
        fmt::format("no run of {} taps in the force (peaks over 0.5 N, 0.12 to 1.5 s "
                    "apart): tap against a solid surface, or state offset_s",
                    count));
  const auto motion = motion_taps(tapped.motion_t_s, tapped.tip_m, count);
  if (motion.empty())
    return core::bad_input(
        fmt::format("no run of {} taps in the motion (the tip down and up by 2 mm or "
                    "more): is tip_z_m right? Or state offset_s",
                    count));
  double nearest_s = 0.0;
  const auto all = candidates(force, motion, nearest_s);
  if (all.empty())
    return core::bad_input(
        fmt::format("the taps' rhythm differs by {:.0f} ms between force and motion, at "
                    "most {:.0f} ms is expected: are these two recordings of one trial? "
                    "Or state offset_s",
                    1e3 * nearest_s, 1e3 * kRhythm_s));
  std::vector<TapPair> out;
  for (const Candidate& one : all) {
    if (out.size() == kMostPairs) break;
    if (auto pair = fine(tapped, one)) out.push_back(std::move(*pair));
  }
  if (out.empty())
    return core::bad_input(
        "force and motion do not go together in the taps: is the tool's frame (X_BH, "
        "tip_z_m) right, and the surface solid? Or state offset_s");
  return out;
}
}  // namespace

core::Result<ClockFit> align(const Tapped& tapped, int count) {
  const auto pairs = TRY(pairs_of(tapped, count));
  std::vector<TapPair> best;
  for (const TapPair& one : pairs)
    if (auto runs = agreeing(pairs, one); score(runs) > score(best)) best = std::move(runs);
  for (const TapPair& one : pairs) {
    const double apart_s = std::abs(one.taps_s.front() - best.front().taps_s.front());
    if (std::abs(one.offset_s - best.front().offset_s) > 2.0 * kAgree_s + kMostDrift * apart_s &&
        score(agreeing(pairs, one)) > kRival * score(best))
      return core::bad_input(
          fmt::format("two offsets fit the taps as well, {:.3f} s and {:.3f} s: tap with "
                      "an uneven rhythm, or state offset_s",
                      best.front().offset_s, one.offset_s));
  }
  return line_through(std::move(best));
}

}  // namespace capture
}  // namespace tractus
