#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "models/palpation_runtime.hpp"
#include "station/loop/haptic_loop.hpp"
#include "tests/fuzz/safety_scenarios.hpp"

namespace tractus {
namespace fuzz {
namespace {
using devices::Status;
using math::Vec3;
using math::Wrench;

constexpr core::Instant_ns kPeriod = 250'000;
constexpr int kQuiet = 22, kRamp = 12, kWild = 40;
constexpr double kSide_m = 0.018;

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<>()(random_);
  }
  double anywhere(double low, double high) {
    if (rarely(0.1)) return rarely(0.5) ? low : high;
    if (low > 0.0 && high / low > 100.0) return low * std::pow(high / low, between(0, 1));
    return between(low, high);
  }
  bool rarely(double share) { return between(0.0, 1.0) < share; }
  Vec3 vector(double size) {
    return {between(-size, size), between(-size, size), between(-size, size)};
  }

 private:
  std::mt19937_64 random_;
};

/// Simulated bone of porous texture, 0.4 mm voxels: full on one side, empty on the other.
volume::Volume block() {
  volume::Volume v;
  v.geometry.dims = {48, 48, 48};
  v.geometry.spacing_m = Vec3::Constant(4e-4);
  v.intercept = -1000.0;
  std::mt19937 random(11);
  for (int k = 0; k < 48; ++k)
    for (int j = 0; j < 48; ++j)
      for (int i = 0; i < 48; ++i)
        v.counts.push_back(static_cast<std::uint16_t>(i < 20 ? 1000 : 1100 + random() % 1000));
  return v;
}

models::PalpationModel draw_model(Dice& dice) {
  models::PalpationModel m;
  m.name = "fuzzed";
  m.base = {.force_factor_Nm = dice.anywhere(1e-4, 1.0),
            .force_scale = dice.anywhere(0.0, 10.0),
            .torque_scale = dice.anywhere(0.0, 10.0),
            .points = 1 + int(dice.between(0.0, 6.99)),
            .point_spacing_m = dice.anywhere(1e-4, 0.02),
            .youngs_modulus_Pa = dice.anywhere(1e9, 4e11),
            .length_m = dice.anywhere(0.02, 0.3),
            .radius_m = dice.anywhere(2e-4, 5e-3),
            .pose_offset_m = dice.vector(0.005)};
  for (const effects::PalpationEffectInfo& info : effects::palpation_effects()) {
    if (!dice.rarely(0.15)) continue;
    effects::EffectInstance use{.id = info.facts.id, .values = {}};
    for (const effects::Param& p : info.facts.params)
      for (int c = 0; c < p.components; ++c) use.values.push_back(dice.anywhere(p.low, p.high));
    m.effects.push_back(std::move(use));
  }
  return m;
}

/// A device whose poses go anywhere, and which holds what it is given against the promises.
class WildDevice final : public devices::Device {
 public:
  WildDevice(Dice& dice, const loop::Limiter& limiter, double length_m, Outcome& outcome)
      : dice_(dice), limiter_(limiter), length_m_(length_m), outcome_(outcome) {}
  core::Result<devices::Limits> open() override { return devices::Limits{}; }
  void close() noexcept override {}

  Status read(core::Instant_ns now, devices::Sample& out) noexcept override {
    out = {};
    out.stamp = now;
    elapsed_ = now - now_;
    now_ = now;
    ++ticks_;
    status_ = Status::ok;
    if (ticks_ > kQuiet + kRamp) step_wildly(out);
    out.X_DH = {tip_ - Vec3(0, 0, length_m_), math::Quat::Identity()};
    if (dice_.rarely(0.001)) out.X_DH.p.x() = std::numeric_limits<double>::quiet_NaN();
    return status_;
  }

  Status write(const Wrench& w) noexcept override {
    const loop::HandLimits& most = limiter_.limits();
    const double f = w.force_N.norm(), t = w.torque_Nm.norm();
    const bool zero = f == 0.0 && t == 0.0;
    const double dt_s = double(std::min(elapsed_, 2 * kPeriod)) * 1e-9 + 1e-9;
    if (!(f <= most.max_force_N)) outcome_.broken = "force above the clamp";
    if (!(t <= most.max_torque_Nm)) outcome_.broken = "torque above the clamp";
    if (!zero && !((w.force_N - last_.force_N).norm() <= most.max_force_slew_N_per_s * dt_s))
      outcome_.broken = "force faster than the slew";
    if (!zero && !((w.torque_Nm - last_.torque_Nm).norm() <= most.max_torque_slew_Nm_per_s * dt_s))
      outcome_.broken = "torque faster than the slew";
    if (!zero && (limiter_.guard() == loop::Guard::latched || status_ != Status::ok))
      outcome_.broken = "force in a bad tick or after a fault";
    last_ = w;
    outcome_.moved = outcome_.moved || !zero;
    outcome_.highest = std::max({outcome_.highest, f / most.max_force_N, t / most.max_torque_Nm});
    return Status::ok;
  }

 private:
  void step_wildly(devices::Sample& out) noexcept {
    out.velocity_m_s = dice_.vector(0.3);
    if (dice_.rarely(0.002)) out.velocity_m_s *= 100.0;
    out.angular_velocity_rad_s = dice_.vector(5.0);
    // Into the bone and about in it, a millimetre or two a tick, now and then far away.
    const Vec3 aim(dice_.between(0.004, kSide_m), dice_.between(0.0, kSide_m),
                   dice_.between(0.0, kSide_m));
    tip_ += std::min(1.0, 0.002 / (aim - tip_).norm()) * (aim - tip_);
    if (dice_.rarely(0.003)) tip_ = dice_.vector(1.0);
    if (dice_.rarely(0.01)) status_ = Status::stale;
    if (dice_.rarely(0.001)) status_ = Status::gone;
  }

  Dice& dice_;
  const loop::Limiter& limiter_;
  double length_m_;
  Outcome& outcome_;
  Vec3 tip_{-0.01, 0.009, 0.009};  // outside, where nothing is
  Wrench last_;
  Status status_ = Status::ok;
  core::Instant_ns now_ = 0, elapsed_ = 0;
  int ticks_ = 0;
};
}  // namespace

struct Palpation::Fields {
  volume::Volume bone = block();
  volume::TransferFunction transfer = volume::TransferFunction::bone();
  volume::ForceField paper, potential;
  static volume::ForceField field(const volume::Volume& bone, volume::FieldKind kind) {
    return std::move(
        volume::ForceField::make(bone, volume::TransferFunction::bone(), kind).value());
  }
  Fields()
      : paper(field(bone, volume::FieldKind::paper)),
        potential(field(bone, volume::FieldKind::potential)) {}
};

Palpation::Palpation() : fields_(std::make_unique<Fields>()) {}
Palpation::~Palpation() = default;

Outcome Palpation::run(std::uint64_t seed) const {
  Dice dice(seed);
  Outcome out;
  const auto& field = dice.rarely(0.5) ? fields_->paper : fields_->potential;
  core::Result<models::PalpationRuntime> model = core::Error{};
  double length_m = 0.0;
  for (int tries = 0; tries < 50 && !out.made; ++tries) {
    models::PalpationModel drawn = draw_model(dice);
    drawn.field = field.kind();
    length_m = drawn.base.length_m;
    model = models::PalpationRuntime::make(drawn, field);
    out.made = bool(model);
  }
  if (!out.made) return out;

  loop::HandLimits asked;  // what a file or a server might ask: never above the ceiling
  asked.max_force_N = dice.anywhere(0.1, 1e6);
  asked.max_torque_Nm = dice.anywhere(0.01, 1e3);
  asked.max_force_slew_N_per_s = dice.anywhere(10.0, 1e9);
  asked.ramp_s = 0.2;
  core::ManualClock clock;
  loop::Limiter limiter(asked, kPeriod);
  loop::PalpationContact contact(*model);
  WildDevice device(dice, limiter, length_m, out);
  loop::SampleRing ring(128);
  loop::LiveState live;
  const auto passivity = dice.rarely(0.5) ? loop::Passivity::observed : loop::Passivity::controlled;
  loop::HapticLoop loop({clock, device, contact, limiter, ring, live, passivity}, {}, Vec3::Zero(),
                        4000.0);
  limiter.arm();
  core::Instant_ns now = 1'000'000'000;
  for (int tick = 0; tick < kQuiet + kRamp + kWild; ++tick) {
    const bool ramp = tick >= kQuiet && tick < kQuiet + kRamp;  // a stalled computer: 19 ms a tick
    now += ramp ? 19'000'000 : dice.rarely(0.05) ? 7 * kPeriod : kPeriod;
    loop.tick(now, std::uint32_t(tick), false);
  }
  if (!(limiter.limits().max_force_N <= loop::HandLimits::kCeiling.max_force_N))
    out.broken = "a limit above the ceiling";
  return out;
}

}  // namespace fuzz
}  // namespace tractus
