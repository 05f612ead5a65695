/// The simulated lambda.6: a handle with mass held by a simulated hand. See
/// station/devices/README.md.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <optional>

#include "station/devices/catalogue.hpp"
#include "station/devices/felt.hpp"
#include "station/devices/palpation_plan.hpp"

namespace tractus {
namespace devices {
namespace {
using math::Quat;
using math::Vec3;

// The machine. The lambda.6's own data sheet is not public: saturation is that of its sister, the
// lambda.7.
constexpr double kMass_kg = 0.2;
constexpr double kInertia_kgm2 = 2e-4;
constexpr double kFriction_Ns_per_m = 0.8;
constexpr double kFriction_Nms_per_rad = 0.002;
const Limits kLimits{.max_force_N = 20.0, .max_torque_Nm = 0.2, .rate_Hz = 4000.0};
constexpr double kMaxStep_s = 1.25e-4;  // 8 kHz
constexpr core::Instant_ns kMaxGap_ns =
    20'000'000;  // a longer stall stops hand and handle with the machine

// The hand: springs and dampers to where it wants the handle. Plausible values of ours.
constexpr double kHand_N_per_m = 350.0;
constexpr double kHand_Ns_per_m = 14.0;
constexpr double kHand_Nm_per_rad = 4.0;
constexpr double kHand_Nms_per_rad = 0.04;

// It bends the probe until the wall pushes back with the least force of the surgeons' means, 0.3 to
// 0.5 N in the simulator [Zoller2020, Table 2]; little by little, so that a hole is felt.
constexpr double kPress_N = 0.30;
constexpr double kBendRate_m_per_s = 0.02;
constexpr double kFirstBend_m = 0.010, kMostBend_m = 0.030;
// A wall that held and holds no more for a moment let the tip through: the hand eases off, goes out
// of the bone and in again, and presses less from then on; so it does, once in a stroke, where
// nothing held from the beginning.
constexpr double kHeld_N = 0.15, kLoose_N = 0.06, kLoose_s = 0.04;
constexpr double kEase_s = 0.15, kWayOut_s = 1.0, kLess = 0.8, kLeastMost_m = 0.010;

Vec3 clamped(const Vec3& v, double most) {
  const double length = v.norm();
  return length > most ? Vec3(v * (most / length)) : v;
}

Vec3 rotation_vector(const Quat& q) {
  const Eigen::AngleAxisd turn(q);
  const double angle = std::remainder(turn.angle(), 2.0 * std::numbers::pi);
  return angle * turn.axis();
}

class SimLambda6 final : public Device, public SimulatedTrainee {
 public:
  explicit SimLambda6(const DeviceOptions& options)
      : options_(options), plan_(options), felt_(options) {}

  core::Result<Limits> open() override {
    grip_ = {.bend_m = kFirstBend_m};
    intent_ = plan_.at(0.0, grip_);
    X_DH_ = intent_.X_DH;
    velocity_.setZero(), turn_.setZero(), wrench_ = {};
    elapsed_s_ = 0.0, last_ = -1, felt_ = FeltWalls(options_);
    rechecking_ = tapping_ = false, done_ = false, progress_ = 0.0;
    most_bend_m_ = kMostBend_m, loose_s_ = 0.0, slipped_s_ = -1.0, lost_stroke_ = -1,
    held_m_.reset();
    open_ = true;
    return kLimits;
  }

  Status read(core::Instant_ns now, Sample& out) noexcept override {
    if (!open_) return Status::fault;
    if (rests_)
      velocity_.setZero(), turn_.setZero();
    else if (last_ >= 0)
      advance(static_cast<double>(std::min(now - last_, kMaxGap_ns)) * 1e-9);
    last_ = now;
    out = {.stamp = now,
           .X_DH = X_DH_,
           .velocity_m_s = velocity_,
           .angular_velocity_rad_s = turn_,
           .saturated = saturated_,
           .buttons = intent_.button ? 1u : 0u};
    return Status::ok;
  }

  Status write(const math::Wrench& on_hand_D) noexcept override {
    if (!open_) return Status::fault;
    if (!on_hand_D.force_N.allFinite() || !on_hand_D.torque_Nm.allFinite()) return Status::fault;
    wrench_.force_N = clamped(on_hand_D.force_N, kLimits.max_force_N);
    wrench_.torque_Nm = clamped(on_hand_D.torque_Nm, kLimits.max_torque_Nm);
    saturated_ = wrench_.force_N != on_hand_D.force_N || wrench_.torque_Nm != on_hand_D.torque_Nm;
    return Status::ok;
  }

  void close() noexcept override {
    wrench_ = {};
    open_ = false;
  }

  std::string name() const override {
    return fmt::format("simulated hand, seed {}", options_.seed);
  }
  bool done() const noexcept override { return done_; }
  double progress() const noexcept override { return progress_; }
  void rest(bool on) noexcept override { rests_ = on; }
  SimulatedAnswer answer() const override { return felt_.answer(); }

 private:
  void advance(double gap_s) noexcept {
    const int steps = static_cast<int>(std::ceil(gap_s / kMaxStep_s - 1e-9));
    if (steps <= 0) return;
    elapsed_s_ += gap_s;
    if (!rechecking_ && elapsed_s_ >= plan_.rechecks_from_s()) {
      plan_.recheck(felt_.suspects());
      rechecking_ = true;
    }
    const Intent before = intent_;
    come_back(gap_s);
    intent_ = plan_.at(elapsed_s_, grip_);
    if (slipped_s_ >= 0.0) intent_.act = Act::approach;
    const Vec3 velocity = (intent_.X_DH.p - before.X_DH.p) / gap_s;
    for (int i = 0; i < steps; ++i) integrate(velocity, gap_s / steps);
    feel();
    press(gap_s);
    progress_ = std::min(1.0, elapsed_s_ / plan_.duration_s());
    done_ = elapsed_s_ >= plan_.duration_s();
  }

  // Semi-implicit Euler, the dampers implicit: v⁺ = (v + h (f + b v*) / m) / (1 + h b / m), then x⁺
  // = x + h v⁺.
  void integrate(const Vec3& intended_m_s, double h) noexcept {
    const Vec3 pull = kHand_N_per_m * (intent_.X_DH.p - X_DH_.p) + kHand_Ns_per_m * intended_m_s +
                      wrench_.force_N;
    velocity_ = (velocity_ + h / kMass_kg * pull) /
                (1.0 + h / kMass_kg * (kHand_Ns_per_m + kFriction_Ns_per_m));
    X_DH_.p += h * velocity_;
    const Vec3 twist = kHand_Nm_per_rad * rotation_vector(intent_.X_DH.q * X_DH_.q.conjugate()) +
                       wrench_.torque_Nm;
    turn_ = (turn_ + h / kInertia_kgm2 * twist) /
            (1.0 + h / kInertia_kgm2 * (kHand_Nms_per_rad + kFriction_Nms_per_rad));
    const double angle = h * turn_.norm();
    if (angle > 0.0)
      X_DH_.q = (Quat(Eigen::AngleAxisd(angle, turn_.normalized())) * X_DH_.q).normalized();
  }

  void press(double gap_s) noexcept {
    if (intent_.press < 0.5) {
      held_m_.reset();
      return;
    }
    const double felt_N = -wrench_.force_N.dot(intent_.towards);
    if (intent_.act == Act::stroke) heed_slip(felt_N, gap_s);
    const double want = std::clamp(1.0 - felt_N / kPress_N, -1.0, 1.0);
    grip_.bend_m = std::clamp(grip_.bend_m + gap_s * kBendRate_m_per_s * want, 0.0, most_bend_m_);
  }

  void heed_slip(double felt_N, double gap_s) noexcept {
    if (felt_N > kHeld_N) held_m_ = felt_depth_m();
    loose_s_ = felt_N < kLoose_N ? loose_s_ + gap_s : 0.0;
    const int stroke = intent_.wall * PalpationPlan::kLooks + intent_.look;
    if (slipped_s_ >= 0.0 || loose_s_ < kLoose_s || (!held_m_ && stroke == lost_stroke_)) return;
    if (held_m_) felt_.note_through(intent_, *held_m_);
    most_bend_m_ = std::max(kLess * grip_.bend_m, kLeastMost_m);
    slipped_s_ = 0.0, held_m_.reset(), lost_stroke_ = stroke;
  }

  /// After a slip: eases off, out of the bone and in again, presses anew. The plan goes on.
  void come_back(double gap_s) noexcept {
    if (slipped_s_ < 0.0) return;
    slipped_s_ += gap_s;
    const double back_s = slipped_s_ - kEase_s - kWayOut_s;
    grip_.firmness =
        back_s < 0.0 ? std::max(0.0, 1.0 - slipped_s_ / kEase_s) : std::min(1.0, back_s / kEase_s);
    const double way = std::clamp((slipped_s_ - kEase_s) / kWayOut_s, 0.0, 1.0);
    grip_.reach = 0.5 * (1.0 + std::cos(2.0 * std::numbers::pi * way));
    grip_.bend_m = std::min(grip_.bend_m, most_bend_m_);
    if (back_s > kEase_s) slipped_s_ = -1.0;
  }

  /// Of the tip, by where its own hand is, not where it meant it to be.
  double felt_depth_m() const noexcept {
    return intent_.depth_m + (X_DH_.p - intent_.X_DH.p).dot(options_.channel.axis);
  }

  void feel() noexcept {
    const Vec3& axis = options_.channel.axis;
    const double outward_N = -wrench_.force_N.dot(axis);
    if (intent_.act == Act::tap) felt_.note_tap(outward_N);
    if (tapping_ && intent_.act != Act::tap) felt_.end_tap();
    tapping_ = intent_.act == Act::tap;
    if (intent_.act != Act::stroke) return;
    felt_.note_stroke(intent_, felt_depth_m(), -wrench_.force_N.dot(intent_.towards), outward_N);
  }

  DeviceOptions options_;
  PalpationPlan plan_;
  FeltWalls felt_;
  Intent intent_;  ///< of the last tick
  math::Pose X_DH_;
  Vec3 velocity_ = Vec3::Zero(), turn_ = Vec3::Zero();
  math::Wrench wrench_;
  double elapsed_s_ = 0.0;
  Grip grip_;
  double most_bend_m_ = kMostBend_m, loose_s_ = 0.0;
  int lost_stroke_ = -1;               ///< in which nothing held
  double slipped_s_ = -1.0;            ///< since the last slip; negative: it is over
  std::optional<double> held_m_ = {};  ///< depth at which the wall last held
  core::Instant_ns last_ = -1;
  bool open_ = false, saturated_ = false, tapping_ = false, rechecking_ = false;
  std::atomic<bool> done_ = false, rests_ = false;
  std::atomic<double> progress_ = 0.0;
};

core::Result<MadeDevice> make_sim_lambda6(const DeviceOptions& options) {
  const auto refuse = [](const char* what, double value, const char* range) {
    return core::Error{core::Errc::out_of_range,
                       fmt::format("sim-lambda6: {} {} is outside {}", what, value, range)};
  };
  if (!(options.duration_s >= 1.0 && options.duration_s <= 3600.0))
    return refuse("duration_s", options.duration_s, "1 … 3600");
  if (!(options.probe_length_m > 0.0 && options.probe_length_m <= 1.0))
    return refuse("probe_length_m", options.probe_length_m, "0 … 1");
  if (!(options.channel.length_m > 0.0 && options.channel.length_m < options.probe_length_m))
    return refuse("channel length_m", options.channel.length_m, "0 … the probe's length");
  if (!(options.channel.radius_m > 0.0 && options.channel.radius_m <= 0.02))
    return refuse("channel radius_m", options.channel.radius_m, "0 … 0.02");
  auto device = std::make_unique<SimLambda6>(options);
  SimulatedTrainee* trainee = device.get();
  return MadeDevice{std::move(device), trainee};
}

}  // namespace

DeviceInfo sim_lambda6_device() {
  return {.id = "sim-lambda6",
          .summary =
              "SIMULATED lambda.6: a handle with mass and friction, held by a simulated hand that "
              "palpates, or drills",
          .kind = DeviceKind::handle,
          .simulated = true,
          .addressed_by = AddressedBy::nothing,
          .make = make_sim_lambda6};
}

}  // namespace devices
}  // namespace tractus
