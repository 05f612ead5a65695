#include "station/session/tuning.hpp"

#include <algorithm>
#include <cmath>

#include "core/require.hpp"
#include "core/try.hpp"

namespace tractus {
namespace session {
namespace {
using scenarios::Scenario;

constexpr std::array<TunedParameter, Tuning::kParameters> kAll{{
    {"K", "bone/stiffness_N_per_m", 50.0},
    {"D", "bone/damping_Ns_per_m", 50.0},
    {"x0", "bone/equilibrium_m", 1e-4},
    {"L", "bone/interval_m", 1e-4},
    {"R_i", "breach/resistance_interval_m", 1e-4},
    {"R_f", "breach/resistance_factor_per_m", 1.0},
    {"L_b", "breach/breach_interval_m", 1e-4},
    {"D_b", "breach/breach_damping_Ns_per_m", 10.0},
}};

double& value_in(Scenario& s, std::size_t parameter) {
  const std::array<double*, Tuning::kParameters> all{
      &s.bone.stiffness_N_per_m,       &s.bone.damping_Ns_per_m,
      &s.bone.equilibrium_m,           &s.bone.interval_m,
      &s.breach.resistance_interval_m, &s.breach.resistance_factor_per_m,
      &s.breach.breach_interval_m,     &s.breach.breach_damping_Ns_per_m};
  core::require(parameter < all.size(), "there are eight parameters");
  return *all[parameter];
}
/// A probe stop that stood at the end of the last breach stays there when the breach changes.
void keep_stop_at_breach_end(const Scenario& before, Scenario& next) {
  if (next.kind != scenarios::Kind::lateral_breach || next.walls_m.empty()) return;
  const double end_m = before.walls_m.back() + before.breach.breach_interval_m;
  if (std::abs(before.travel_m - end_m) < 1e-9)
    next.travel_m = next.walls_m.back() + next.breach.breach_interval_m;
}
}  // namespace

std::span<const TunedParameter, Tuning::kParameters> Tuning::parameters() { return kAll; }

double Tuning::value(std::size_t parameter) const {
  Scenario copy = now_;
  return value_in(copy, parameter);
}

core::Result<void> Tuning::nudge(std::size_t parameter, int direction) {
  Scenario next = now_;
  double& value = value_in(next, parameter);
  const double step = std::max(kShare * std::abs(value), kAll[parameter].least_step);
  value += direction > 0 ? step : -step;
  keep_stop_at_breach_end(now_, next);
  TRY(next.expanded());
  before_.push_back(std::move(now_));
  now_ = std::move(next);
  return {};
}

bool Tuning::undo() {
  if (before_.empty()) return false;
  now_ = std::move(before_.back());
  before_.pop_back();
  return true;
}

core::Result<Scenario> Tuning::save(const std::string& who, std::int64_t when_utc_us) {
  if (who.empty())
    return core::Error{core::Errc::bad_input, "--who: a new version says who tuned it"};
  std::vector<scenarios::Change> changes;
  for (std::size_t k = 0; k < kParameters; ++k) {
    Scenario parent = parent_;
    if (value_in(parent, k) != value(k)) changes.push_back({kAll[k].field, value(k)});
  }
  if (now_.travel_m != parent_.travel_m) changes.push_back({"travel_m", now_.travel_m});
  if (changes.empty()) return core::Error{core::Errc::bad_input, "nothing was changed"};
  auto made = scenarios::next_version(parent_, changes, who, when_utc_us);
  if (!made) return made;
  parent_ = now_ = *made;
  before_.clear();
  return made;
}

}  // namespace session
}  // namespace tractus
