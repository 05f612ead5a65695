/// The simulated lambda.6: a handle with mass held by a simulated hand. See
/// station/devices/README.md.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>

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

// It follows a surface with a light touch: leans less where it feels more than this, more where
// less.
constexpr double kTouch_N = 0.05;
constexpr double kEase_per_s = 1.5;

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
  explicit SimLambda6(const DeviceOptions& options) : options_(options), plan_(options) {}

  core::Result<Limits> open() override {
    X_DH_ = plan_.at(0.0, lean_).X_DH;
    velocity_.setZero(), turn_.setZero(), wrench_ = {};
    elapsed_s_ = 0.0, lean_ = 1.0, last_ = -1, felt_ = {}, button_ = false, done_ = false,
    progress_ = 0.0;
    open_ = true;
    return kLimits;
  }

  Status read(core::Instant_ns now, Sample& out) noexcept override {
    if (!open_) return Status::fault;
    if (last_ >= 0) advance(static_cast<double>(std::min(now - last_, kMaxGap_ns)) * 1e-9);
    last_ = now;
    out = {.stamp = now,
           .X_DH = X_DH_,
           .velocity_m_s = velocity_,
           .angular_velocity_rad_s = turn_,
           .saturated = saturated_,
           .buttons = button_ ? 1u : 0u};
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
  SimulatedAnswer answer() const override { return felt_.answer(options_.seed); }

 private:
  void advance(double gap_s) noexcept {
    const int steps = static_cast<int>(std::ceil(gap_s / kMaxStep_s - 1e-9));
    if (steps <= 0) return;
    const double h = gap_s / steps;
    Intent intent;
    for (int i = 0; i < steps; ++i) {
      elapsed_s_ += h;
      intent = plan_.at(elapsed_s_, lean_);
      integrate(intent, h);
    }
    button_ = intent.button;
    feel(intent);
    ease(intent, gap_s);
    progress_ = std::min(1.0, elapsed_s_ / plan_.duration_s());
    done_ = elapsed_s_ >= plan_.duration_s();
  }

  // Semi-implicit Euler, the dampers implicit: v⁺ = (v + h (f + b v*) / m) / (1 + h b / m), then x⁺
  // = x + h v⁺.
  void integrate(const Intent& intent, double h) noexcept {
    const Vec3 pull = kHand_N_per_m * (intent.X_DH.p - X_DH_.p) +
                      kHand_Ns_per_m * intent.velocity_m_s + wrench_.force_N;
    velocity_ = (velocity_ + h / kMass_kg * pull) /
                (1.0 + h / kMass_kg * (kHand_Ns_per_m + kFriction_Ns_per_m));
    X_DH_.p += h * velocity_;
    const Vec3 twist =
        kHand_Nm_per_rad * rotation_vector(intent.X_DH.q * X_DH_.q.conjugate()) + wrench_.torque_Nm;
    turn_ = (turn_ + h / kInertia_kgm2 * twist) /
            (1.0 + h / kInertia_kgm2 * (kHand_Nms_per_rad + kFriction_Nms_per_rad));
    const double angle = h * turn_.norm();
    if (angle > 0.0)
      X_DH_.q = (Quat(Eigen::AngleAxisd(angle, turn_.normalized())) * X_DH_.q).normalized();
  }

  void ease(const Intent& intent, double gap_s) noexcept {
    const double felt_N = -wrench_.force_N.dot(intent.press);
    const double want = std::clamp(1.0 - felt_N / kTouch_N, -3.0, 1.0);
    lean_ = std::clamp(lean_ + gap_s * kEase_per_s * want, 0.0, 1.0);
  }

  void feel(const Intent& intent) noexcept {
    const KnownTract& channel = options_.channel;
    const Vec3 tip = X_DH_ * Vec3(0.0, 0.0, options_.probe_length_m) - channel.entry_m;
    const double depth_m = tip.dot(channel.axis);
    if (intent.act == Act::tap) {
      felt_.note(intent, 0.0, depth_m - channel.length_m, -wrench_.force_N.dot(channel.axis));
      return;
    }
    const double share =
        (depth_m - plan_.shallowest_m()) / (plan_.deepest_m() - plan_.shallowest_m());
    felt_.note(intent, share, tip.dot(intent.press) - channel.radius_m,
               -wrench_.force_N.dot(intent.press));
  }

  DeviceOptions options_;
  PalpationPlan plan_;
  FeltResistance felt_;
  math::Pose X_DH_;
  Vec3 velocity_ = Vec3::Zero(), turn_ = Vec3::Zero();
  math::Wrench wrench_;
  double elapsed_s_ = 0.0;
  double lean_ = 1.0;  ///< share of the plan's tilt
  core::Instant_ns last_ = -1;
  bool open_ = false, saturated_ = false, button_ = false;
  std::atomic<bool> done_ = false;
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
