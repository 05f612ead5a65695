#include "cases/making.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/try.hpp"

namespace tractus {
namespace cases {
namespace {

using volume::Breach;
using volume::Wall;

constexpr double kRing_m = 0.012;       // outer faces of a ring lie within it
constexpr double kPastMouth_m = 0.005;  // of the ring's first depth begin the places that are felt
constexpr double kRingStep_m = 0.001;
constexpr double kTapped_m = 0.003;  // WallCertificate::kLeastEndForce_N within

/// Depths at which every side wall is found, with what `bound` says of each.
template <class Bound>
std::vector<double> enclosed_depths(const volume::WallFinder& finder, const volume::Tract& tract,
                                    const Bound& bound) {
  std::vector<double> out;
  for (double at = 0.0; at <= tract.length_m; at += kRingStep_m) {
    bool enclosed = true;
    for (std::size_t w = 0; w < kSideWalls && enclosed; ++w) {
      const auto found = finder.wall_at(tract, volume::kWalls[w], at);
      enclosed = found && bound(*found);
    }
    if (enclosed) out.push_back(at);
  }
  return out;
}

/// The whole tract, palpated once, and breaches tried in it.
class Tried {
 public:
  /// `bone` is not drilled. All must outlive this.
  static core::Result<Tried> make(const volume::Volume& bone, const models::PalpationModel& model,
                                  const Placed& placed, double from_m) {
    Tried out(bone, placed, Observer(model, placed.tract, from_m));
    volume::drill(out.drilled_, placed.tract, placed.mouth_m, std::nullopt, placed.empty_value);
    out.field_ = std::make_unique<volume::ForceField>(
        TRY(volume::ForceField::make(out.drilled_, model.transfer, model.field)));
    out.palpated_ = TRY(out.observer_.palpate(*out.field_));
    out.felt_ = out.observer_.felt(out.palpated_, {});
    return out;
  }

  /// What a breach feels like.
  core::Result<Palpated> palpated(const Breach& breach) {
    volume::Volume breached = *bone_;
    const auto box =
        volume::drill(breached, placed_->tract, placed_->mouth_m, breach, placed_->empty_value);
    field_->update(breached, box);
    auto out = observer_.palpate_near(*field_, palpated_, breach.wall.wall, breach.wall.at_m);
    field_->update(drilled_, box);
    return out;
  }
  WallCertificate certify(const Breach& breach, const Palpated& palpated,
                          const Perception& perception) const {
    WallCertificate out{.wall = breach.wall.wall, .at_m = breach.wall.at_m};
    const auto whole = observer_.felt(palpated_, perception);
    out.told = observer_.detect(whole, observer_.felt(palpated, perception), out.wall, *out.at_m,
                                perception);
    out.end_force_N = observer_.end_force_N(whole, kTapped_m);
    return out;
  }
  /// The same with the standard perception, quicker.
  WallCertificate certify(const Breach& breach, const Palpated& palpated) const {
    WallCertificate out{.wall = breach.wall.wall, .at_m = breach.wall.at_m};
    out.told =
        observer_.detect(felt_, observer_.felt(palpated, {}), out.wall, *out.at_m, Perception{});
    out.end_force_N = observer_.end_force_N(felt_, kTapped_m);
    return out;
  }

 private:
  Tried(const volume::Volume& bone, const Placed& placed, Observer observer)
      : bone_(&bone), placed_(&placed), observer_(std::move(observer)), drilled_(bone) {}
  const volume::Volume* bone_;
  const Placed* placed_;
  Observer observer_;
  volume::Volume drilled_;  // without a breach
  std::unique_ptr<volume::ForceField> field_;
  Palpated palpated_;
  Observer::Felt felt_;
};

double score(const WallCertificate& wall) {
  const auto d = wall.d_prime();
  if (!d) return -1e300;
  return wall.told.fa ? std::min(*d, *wall.told.b - *wall.told.fa + 2.0) : *d;
}

/// A breach that was tried, the best of its wall.
struct Best {
  Breach breach;
  Palpated palpated;
  WallCertificate certificate;
};

core::Result<std::optional<Best>> best_of(Tried& tried, const std::vector<Breach>& breaches) {
  std::optional<Best> best;
  for (const Breach& breach : breaches) {
    auto palpated = TRY(tried.palpated(breach));
    auto certificate = tried.certify(breach, palpated);
    if (!best || score(certificate) > score(best->certificate))
      best = Best{breach, std::move(palpated), std::move(certificate)};
  }
  return best;
}

/// d′ of every wall under other assumptions.
std::vector<Sensitivity> sensitivities(const Tried& tried,
                                       const std::vector<std::optional<Best>>& best) {
  const std::vector<std::pair<const char*, double Perception::*>> fields{
      {"force_weber", &Perception::force_weber},
      {"force_threshold_N", &Perception::force_threshold_N},
      {"wander_m", &Perception::wander_m}};
  std::vector<Sensitivity> out;
  for (const auto& [assumption, field] : fields)
    for (const double factor : {0.5, 2.0}) {
      Perception other;
      other.*field *= factor;
      Sensitivity one{.assumption = assumption, .value = other.*field};
      for (std::size_t w = 0; w < best.size(); ++w)
        if (best[w])
          one.d_prime[w] = tried.certify(best[w]->breach, best[w]->palpated, other).d_prime();
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
      return (filled ? found.outer_m : found.inner_m) <= kRing_m;
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
                      volume::name(wall), from_m() * 1e3, kRing_m * 1e3)};
    return out;
  }

 private:
  const volume::Volume& bone_;
  const volume::TransferFunction& transfer_;
  const CarvingPlan& plan_;
  const Placed& placed_;
  std::vector<double> ring_m_;
};

struct Judged {
  Certificate certificate;
  std::optional<Breach> breach;  ///< the one that the plan asks for, in its place
};

/// Tries every wall. Errors: of the wall that the plan asks for; the others' are their `why_not`.
core::Result<Judged> judge(const Places& places, Tried& tried, const CarvingPlan& plan) {
  Judged out;
  out.certificate.preparation = plan.preparation;
  std::vector<std::optional<Best>> best;
  for (const Wall wall : volume::kWalls) {
    const bool asked = plan.breach && plan.breach->wall == wall;
    const auto breaches = places.of(wall);
    if (!breaches && asked) return breaches.error();
    best.emplace_back();
    if (breaches) best.back() = TRY(best_of(tried, *breaches));
    out.certificate.walls.push_back(best.back() ? best.back()->certificate
                                                : WallCertificate{.wall = wall});
    if (!breaches) out.certificate.walls.back().why_not = breaches.error().what;
    if (asked && best.back()) out.breach = best.back()->breach;
  }
  out.certificate.sensitivities = sensitivities(tried, best);
  return out;
}

}  // namespace

core::Result<Made> make(const volume::Volume& ct, const models::PalpationModel& model,
                        const CarvingPlan& plan, const core::Progress& progress) {
  Made made{{TRY(place(ct, model.transfer, plan)), {}}, {}};
  made.volume = TRY(bone_about(ct, model.transfer, plan, made, progress));
  if (!made.drilled) return made;
  const auto bone = TRY(prepared_ct(ct, model.transfer, made));
  const Places places(bone, model.transfer, plan, made);
  auto tried = TRY(Tried::make(made.volume, model, made, places.from_m()));
  auto judged = TRY(judge(places, tried, plan));
  made.certificate = std::move(judged.certificate);
  made.breach = judged.breach;
  volume::drill(made.volume, made.tract, made.mouth_m, made.breach, made.empty_value);
  return made;
}

core::Result<WallCertificate> certify_drilled(const volume::Volume& drilled,
                                              const models::PalpationModel& model,
                                              const volume::Tract& tract, Wall wall, double at_m) {
  if (wall == Wall::anterior)
    return core::Error{core::Errc::bad_input,
                       "an anterior breach is told from the same bone without it: make the case "
                       "anew from its CT"};
  const volume::WallFinder finder(drilled, model.transfer);
  const auto enclosed = enclosed_depths(
      finder, tract, [](const volume::WallFound& found) { return found.inner_m <= kRing_m; });
  const double mouth_m = enclosed.empty() ? 0.25 * tract.length_m : enclosed.front();
  const Observer observer(model, tract, mouth_m + kPastMouth_m);
  const auto field = TRY(volume::ForceField::make(drilled, model.transfer, model.field));
  const auto felt = observer.felt(TRY(observer.palpate(field)), {});
  return WallCertificate{.wall = wall,
                         .at_m = at_m,
                         .told = observer.detect(felt, felt, wall, at_m, {}),
                         .end_force_N = observer.end_force_N(felt, kTapped_m)};
}

}  // namespace cases
}  // namespace tractus
