#include "cases/making.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/try.hpp"

namespace tractus {
namespace cases {
namespace {

using volume::Breach;
using volume::Wall;

constexpr double kRing_m = 0.012;       // inner faces of a ring lie within it
constexpr double kOuterRing_m = 0.014;  // outer faces of a ring of filled bone
constexpr double kPastMouth_m = 0.005;  // of the ring's first depth begin the places that are felt
constexpr double kRingStep_m = 0.001;
constexpr double kMove_m = 0.001;
constexpr double kShort = 100.0;     // what is lost in score by a share short of kLeastForetold
constexpr double kBoneShare = 0.1;   // of a making's progress
constexpr double kTapped_m = 0.003;  // WallCertificate::kLeastEndForce_N within

/// Depths at which every side wall is found, with what `bound` says of each.
template <class Bound>
std::vector<double> enclosed_depths(const volume::WallFinder& finder, const volume::Tract& tract,
                                    const Bound& bound) {
  std::vector<double> depths_m, out;
  for (double at = 0.0; at <= tract.length_m; at += kRingStep_m) depths_m.push_back(at);
  std::vector<char> enclosed(depths_m.size(), 1);
  tbb::parallel_for(std::size_t(0), depths_m.size(), [&](std::size_t k) {
    for (std::size_t w = 0; w < kSideWalls && enclosed[k]; ++w) {
      const auto found = finder.wall_at(tract, volume::kWalls[w], depths_m[k]);
      enclosed[k] = found && bound(*found);
    }
  });
  for (std::size_t k = 0; k < depths_m.size(); ++k)
    if (enclosed[k]) out.push_back(depths_m[k]);
  return out;
}

/// The whole tract, palpated once, and breaches tried in it.
class Tried {
 public:
  /// `bone` is not drilled. All must outlive this.
  static core::Result<Tried> make(const volume::Volume& bone, const models::PalpationModel& model,
                                  const Placed& placed, double from_m,
                                  const Perception& perception) {
    Tried out(bone, placed, Observer(model, placed.tract, from_m));
    volume::drill(out.drilled_, placed.tract, placed.mouth_m, std::nullopt, placed.empty_value);
    out.field_ = std::make_unique<volume::ForceField>(
        TRY(volume::ForceField::make(out.drilled_, model.transfer, model.field)));
    out.palpated_ = TRY(out.observer_.palpate(*out.field_));
    out.felt_ = out.felt(perception);
    out.perception_ = perception;
    return out;
  }

  /// What a breach feels like.
  core::Result<Palpated> palpated(const Breach& breach) {
    redrill(breach, true);
    auto out = observer_.palpate_near(*field_, palpated_, breach.wall.wall, breach.wall.at_m);
    redrill(breach, false);
    return out;
  }
  Observer::Felt felt(const Perception& perception) const {
    return observer_.felt(palpated_, perception);
  }
  /// @param whole  `felt` with the same perception
  WallCertificate certify(const Breach& breach, const Palpated& palpated,
                          const Observer::Felt& whole, const Perception& perception) const {
    WallCertificate out{.wall = breach.wall.wall, .at_m = breach.wall.at_m};
    const auto breached = observer_.felt(palpated, perception);
    out.told = observer_.detect(whole, breached, out.wall, *out.at_m, perception);
    out.foretold = observer_.foretold(whole, breached, out.wall, *out.at_m, perception);
    out.end_force_N = observer_.end_force_N(whole, kTapped_m);
    return out;
  }
  WallCertificate certify(const Breach& breach, const Palpated& palpated) const {
    return certify(breach, palpated, felt_, perception_);
  }

 private:
  Tried(const volume::Volume& bone, const Placed& placed, Observer observer)
      : bone_(&bone), placed_(&placed), observer_(std::move(observer)), drilled_(bone) {}
  void redrill(const Breach& breach, bool breached) {
    const auto box = volume::redrill(drilled_, *bone_, placed_->tract, placed_->mouth_m, breach,
                                     breached, placed_->empty_value);
    field_->update(drilled_, box);
  }
  const volume::Volume* bone_;
  const Placed* placed_;
  Observer observer_;
  volume::Volume drilled_;  // without a breach, but while one is palpated
  std::unique_ptr<volume::ForceField> field_;
  Palpated palpated_;
  Observer::Felt felt_;
  Perception perception_;
};

double score(const WallCertificate& wall) {
  const auto d = wall.d_prime();
  if (!d) return -1e300;
  const double short_by = std::max(0.0, WallCertificate::kLeastForetold - wall.foretold);
  return (wall.told.fa ? std::min(*d, *wall.told.b - *wall.told.fa + 2.0) : *d) - kShort * short_by;
}

struct Attempt {
  Breach breach;
  Palpated palpated;
  WallCertificate certificate;
};

/// All that were tried of one wall, by depth; none: why not.
struct Wanted {
  std::vector<Attempt> attempts;
  std::string why_not;
  std::size_t chosen = 0;
  const Attempt* best() const { return attempts.empty() ? nullptr : &attempts[chosen]; }
};

std::size_t best_of(const std::vector<Attempt>& attempts) {
  const auto by_score = [](const Attempt& a) { return score(a.certificate); };
  return std::size_t(std::ranges::max_element(attempts, {}, by_score) - attempts.begin());
}

/// Of the attempts that pass, the one as hard to tell as `level`; where none does, the best.
std::size_t nearest_to(double level, const std::vector<Attempt>& attempts) {
  std::size_t out = best_of(attempts);
  const auto away = [&](std::size_t n) {
    return std::abs(attempts[n].certificate.d_prime().value_or(0.0) - level);
  };
  for (std::size_t n = 0; n < attempts.size(); ++n)
    if (attempts[n].certificate.passes() && away(n) < away(out)) out = n;
  return out;
}

/// Moves every wall's breach to where it is as hard to tell as that of the hardest wall.
void make_even(std::vector<Wanted>& walls) {
  double hardest = 1e300;
  for (const Wanted& wall : walls)
    if (wall.best()) hardest = std::min(hardest, wall.best()->certificate.d_prime().value_or(0.0));
  for (Wanted& wall : walls)
    if (wall.best()) wall.chosen = nearest_to(hardest, wall.attempts);
}

/// d′ of every wall under other assumptions.
std::vector<Sensitivity> sensitivities(const Tried& tried, const std::vector<Wanted>& walls,
                                       const Perception& perception) {
  const std::vector<std::pair<const char*, double Perception::*>> fields{
      {"force_weber", &Perception::force_weber},
      {"force_threshold_N", &Perception::force_threshold_N},
      {"wander_m", &Perception::wander_m}};
  std::vector<Sensitivity> out;
  for (const auto& [assumption, field] : fields)
    for (const double factor : {0.5, 2.0}) {
      Perception other = perception;
      other.*field *= factor;
      const auto felt = tried.felt(other);
      Sensitivity one{.assumption = assumption, .value = other.*field};
      for (std::size_t w = 0; w < walls.size(); ++w)
        if (const Attempt* best = walls[w].best())
          one.d_prime[w] = tried.certify(best->breach, best->palpated, felt, other).d_prime();
      out.push_back(std::move(one));
    }
  return out;
}

/// Where breaches of a wall are tried, and why nowhere.
class Places {
 public:
  Places(const volume::Volume& bone, const volume::TransferFunction& transfer,
         const CarvingPlan& plan, const Placed& placed)
      : bone_(bone), transfer_(transfer), plan_(plan), placed_(placed) {
    const volume::WallFinder finder(bone, transfer);
    const bool filled = placed.envelope != nullptr;
    ring_m_ = enclosed_depths(finder, placed.tract, [&](const volume::WallFound& found) {
      return filled ? found.outer_m <= kOuterRing_m : found.inner_m <= kRing_m;
    });
  }

  /// Depth of the first place that is felt.
  double from_m() const {
    return (ring_m_.empty() ? 0.25 * placed_.tract.length_m : ring_m_.front()) + kPastMouth_m;
  }
  core::Result<std::vector<Breach>> of(Wall wall) const {
    volume::BreachPlan at = plan_.breach.value_or(volume::BreachPlan{});
    const bool asked = plan_.breach && plan_.breach->wall == wall;
    at.wall = wall;
    if (!asked) at.at_m.reset();
    if (!placed_.envelope || at.at_m || wall == Wall::anterior)
      return std::vector{TRY(volume::place_breach(bone_, transfer_, placed_.tract, at))};
    std::vector<Breach> out;
    for (const double depth_m : ring_m_) {
      if (depth_m < from_m()) continue;
      at.at_m = depth_m;
      const auto breach = volume::place_breach(bone_, transfer_, placed_.tract, at);
      if (breach) out.push_back(*breach);
    }
    if (out.empty())
      return core::Error{
          core::Errc::out_of_range,
          fmt::format("{}: no part of the tract beyond {:.0f} mm has all four walls within {:.0f} "
                      "mm: move entry or target",
                      volume::name(wall), from_m() * 1e3, kOuterRing_m * 1e3)};
    return out;
  }

 private:
  const volume::Volume& bone_;
  const volume::TransferFunction& transfer_;
  const CarvingPlan& plan_;
  const Placed& placed_;
  std::vector<double> ring_m_;
};

/// Steps of a progress, one a breach.
class Steps {
 public:
  Steps(const core::Progress& progress, std::size_t steps) : progress_(progress), steps_(steps) {}
  core::Result<void> next() {
    const double share = kBoneShare + (1.0 - kBoneShare) * double(done_++) / double(steps_);
    if (!progress_ || progress_(share)) return {};
    return core::Error{core::Errc::cancelled, "the making of a case was cancelled"};
  }

 private:
  const core::Progress& progress_;
  std::size_t steps_, done_ = 0;
};

core::Result<std::vector<Attempt>> tried_at(Tried& tried, const std::vector<Breach>& breaches,
                                            Steps& steps) {
  std::vector<Attempt> out;
  for (const Breach& breach : breaches) {
    TRY(steps.next());
    auto palpated = TRY(tried.palpated(breach));
    auto certificate = tried.certify(breach, palpated);
    out.push_back({breach, std::move(palpated), std::move(certificate)});
  }
  return out;
}

/// Tries every wall. Errors: of a wall that the plan asks for; the others' are their `why_not`.
core::Result<std::vector<Wanted>> try_walls(const Places& places, Tried& tried,
                                            const CarvingPlan& plan, Effort effort,
                                            const core::Progress& progress) {
  std::vector<core::Result<std::vector<Breach>>> all;
  std::size_t steps = 0;
  for (const Wall wall : volume::kWalls) {
    all.push_back(places.of(wall));
    const bool asked = plan.breach && plan.breach->wall == wall;
    if (!all.back() && asked) return all.back().error();
    if (all.back() && effort == Effort::first)
      *all.back() = {(*all.back())[all.back()->size() / 2]};
    steps += all.back() ? all.back()->size() : 0;
  }
  Steps counted(progress, steps);
  std::vector<Wanted> out;
  for (const auto& breaches : all) {
    Wanted wall;
    if (breaches) {
      wall.attempts = TRY(tried_at(tried, *breaches, counted));
      wall.chosen = best_of(wall.attempts);
    } else {
      wall.why_not = breaches.error().what;
    }
    out.push_back(std::move(wall));
  }
  return out;
}

WallCertificate certificate_of(Wall wall, const Wanted& wanted) {
  if (!wanted.best()) return {.wall = wall, .why_not = wanted.why_not};
  WallCertificate out = wanted.best()->certificate;
  if (wall == Wall::anterior) return out;
  for (const Attempt& attempt : wanted.attempts)
    out.places.push_back(
        {attempt.breach.wall.at_m, attempt.certificate.told, attempt.certificate.foretold});
  return out;
}

/// What every making shares: the bone before the drill, and what can be told in it.
struct Judged {
  Placed placed;
  volume::Volume bone;
  std::vector<Wanted> walls;
  Certificate certificate;
  math::Vec2 moved_m = math::Vec2::Zero();

  Made made(const std::optional<Breach>& breach) const {
    Made out{{placed, bone}, certificate, moved_m};
    out.breach = breach;
    volume::drill(out.volume, out.tract, out.mouth_m, out.breach, out.empty_value);
    return out;
  }
};

core::Result<Judged> judge(const volume::Volume& ct, const models::PalpationModel& model,
                           const CarvingPlan& plan, Effort effort, const Perception& perception,
                           const core::Progress& progress) {
  auto [placed, bone] = TRY(place_in_bone(ct, model.transfer, plan));
  Judged out{std::move(placed), {}, {}, {}};
  const core::Progress resampling =
      progress ? [&](double share) { return progress(kBoneShare * share); } : core::Progress();
  out.bone = TRY(bone_about(ct, model.transfer, plan, out.placed, resampling));
  const Places places(bone, model.transfer, plan, out.placed);
  auto tried = TRY(Tried::make(out.bone, model, out.placed, places.from_m(), perception));
  out.walls = TRY(try_walls(places, tried, plan, effort, progress));
  if (plan.even) make_even(out.walls);
  out.certificate.preparation = plan.preparation;
  out.certificate.perception = perception;
  out.certificate.from_m = places.from_m();
  for (std::size_t w = 0; w < out.walls.size(); ++w)
    out.certificate.walls.push_back(certificate_of(volume::kWalls[w], out.walls[w]));
  if (effort == Effort::whole)
    out.certificate.sensitivities = sensitivities(tried, out.walls, perception);
  return out;
}

/// The ways to move a tract by at most so much, in steps of a millimetre, the nearest first.
std::vector<math::Vec2> moves(double most_m) {
  std::vector<math::Vec2> out;
  const int most = int(most_m / kMove_m + 1e-9);
  for (int a = -most; a <= most; ++a)
    for (int b = -most; b <= most; ++b)
      if (const math::Vec2 move = kMove_m * math::Vec2(a, b);
          (a || b) && move.norm() <= most_m + 1e-9)
        out.push_back(move);
  std::ranges::stable_sort(out, {}, [](const math::Vec2& move) { return move.norm(); });
  return out;
}

/// The plan as it is, or, where it does not pass and may be moved, the nearest one that passes. If
/// none does: as it is.
core::Result<Judged> judge_moved(const volume::Volume& ct, const models::PalpationModel& model,
                                 const CarvingPlan& plan, const Perception& perception,
                                 const core::Progress& progress) {
  auto as_planned = judge(ct, model, plan, Effort::whole, perception, progress);
  if (as_planned && as_planned->certificate.passes()) return as_planned;
  if (!as_planned) return as_planned;
  const auto& tract = as_planned->placed.tract;
  for (const math::Vec2& move : moves(plan.may_move_m)) {
    CarvingPlan other = plan;
    const math::Vec3 by = move.x() * tract.medial + move.y() * tract.superior;
    other.entry_m += by, other.target_m += by;
    auto moved = judge(ct, model, other, Effort::whole, perception, progress);
    if (!moved && moved.error().code == core::Errc::cancelled) return moved;
    if (!moved || !moved->certificate.passes()) continue;
    moved->moved_m = move;
    return moved;
  }
  return as_planned;
}

core::Error no_channel() {
  return {core::Errc::bad_input, "a planned channel has no walls to feel"};
}

}  // namespace

core::Result<Made> make(const volume::Volume& ct, const models::PalpationModel& model,
                        const CarvingPlan& plan, const core::Progress& progress,
                        const Perception& perception) {
  if (!plan.drilled) return Made{TRY(carve(ct, model.transfer, plan, progress)), {}};
  const auto judged = TRY(judge_moved(ct, model, plan, perception, progress));
  if (!plan.breach) return judged.made({});
  return judged.made(judged.walls[std::size_t(plan.breach->wall)].best()->breach);
}

core::Result<std::vector<Made>> make_five(const volume::Volume& ct,
                                          const models::PalpationModel& model, CarvingPlan plan,
                                          const core::Progress& progress,
                                          const Perception& perception) {
  if (!plan.drilled) return no_channel();
  plan.breach.reset();
  plan.even = true;
  const auto judged = TRY(judge_moved(ct, model, plan, perception, progress));
  if (!judged.certificate.passes())
    return core::Error{core::Errc::out_of_range,
                       judged.certificate.warning() + "; move entry or target"};
  std::vector<Made> out;
  for (const Wanted& wall : judged.walls) out.push_back(judged.made(wall.best()->breach));
  return out;
}

core::Result<Certificate> certify(const volume::Volume& ct, const models::PalpationModel& model,
                                  const CarvingPlan& plan, Effort effort,
                                  const core::Progress& progress) {
  if (!plan.drilled) return no_channel();
  return TRY(judge(ct, model, plan, effort, {}, progress)).certificate;
}

core::Result<Certificate> certify_drilled(const volume::Volume& drilled, const Case& made,
                                          const Truth& truth, const Perception& perception) {
  if (made.planned) return no_channel();
  if (!truth.breached || *truth.breached == Wall::anterior)
    return core::Error{
        core::Errc::out_of_range,
        fmt::format("what can be felt of {} is not known from the drilled bone: make "
                    "the case anew from its CT",
                    truth.breached ? "an anterior breach" : "a case without a breach")};
  const auto& tract = made.tract;
  const volume::WallFinder finder(drilled, made.model.transfer);
  const auto enclosed = enclosed_depths(
      finder, tract, [](const volume::WallFound& found) { return found.inner_m <= kRing_m; });
  const double mouth_m = enclosed.empty() ? 0.25 * tract.length_m : enclosed.front();
  const Observer observer(made.model, tract, mouth_m + kPastMouth_m);
  const auto field = TRY(volume::ForceField::make(drilled, made.model.transfer, made.model.field));
  const auto felt = observer.felt(TRY(observer.palpate(field)), perception);
  const double at_m = tract.depth_of(*truth.breach_m);
  Certificate out{.preparation = made.preparation, .perception = perception};
  out.walls.push_back({.wall = *truth.breached,
                       .at_m = at_m,
                       .told = observer.detect(felt, felt, *truth.breached, at_m, perception),
                       .foretold = observer.foretold(felt, felt, *truth.breached, at_m, perception),
                       .end_force_N = observer.end_force_N(felt, kTapped_m)});
  return out;
}

}  // namespace cases
}  // namespace tractus
