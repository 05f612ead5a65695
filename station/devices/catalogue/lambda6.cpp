/// Force Dimension's lambda.6 through the vendor's SDK, loaded at run time. See
/// station/devices/README.md.
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "core/try.hpp"
#include "station/devices/catalogue.hpp"
#include "station/devices/dhd_library.hpp"
#include "station/devices/usb_presence.hpp"

namespace tractus {
namespace devices {
namespace {
using math::Vec3;

// The lambda.6's own data sheet is not public: its sister's, the lambda.7's, figures.
constexpr double kMaxForce_N = 20.0, kMaxTorque_Nm = 0.2, kRate_Hz = 4000.0;
constexpr double kWatchdog_s = 0.01;
constexpr double kGravity_m_s2 = 9.81;
constexpr int kStatusEvery = 8;  // reads: 2 ms

core::Error not_ready(const std::string& why) {
  return {core::Errc::unavailable, "lambda6: " + why};
}

/// The handle frame H seen from the SDK's wrist frame: z along the shank, which points away from
/// the operator (−x), x up.
const math::Quat& shank_in_wrist() {
  static const math::Quat q = [] {
    math::Mat3 axes;
    axes << 0, 0, -1,  //
        0, 1, 0,       //
        1, 0, 0;
    return math::Quat(axes);
  }();
  return q;
}

class Lambda6 final : public Device {
 public:
  explicit Lambda6(const DeviceOptions& options) : options_(options) {}
  ~Lambda6() override { close(); }

  core::Result<Limits> open() override {
    close();
    auto library = TRY(DhdLibrary::load(options_.sdk));
    library_.emplace(std::move(library));
    api_ = &library_->api();
    TRY(find_on_usb());
    const int id = api_->open();
    if (id < 0) return refused("cannot be opened");
    id_ = static_cast<char>(id);
    if (auto ready = make_ready(); !ready) {
      close();
      return ready.error();
    }
    open_ = true;
    const std::string name = api_->system_name(id_);
    return Limits{.max_force_N = kMaxForce_N,
                  .max_torque_Nm = kMaxTorque_Nm,
                  .rate_Hz = kRate_Hz,
                  .name = fmt::format("{}, serial number {}", name, serial_number()),
                  .simulated = name.find("SIMULATED") != std::string::npos};
  }

  Status read(core::Instant_ns now, Sample& out) noexcept override {
    if (!open_) return Status::fault;
    if (!watch_->present()) return Status::gone;
    double p[3], v[3], w[3], axes[3][3];
    const int posed = api_->pose(&p[0], &p[1], &p[2], axes, id_);
    if (posed < 0) return trouble();
    if (api_->velocity(&v[0], &v[1], &v[2], id_) < 0) return trouble();
    if (api_->turn(&w[0], &w[1], &w[2], id_) < 0) return trouble();
    if (posed != DhdApi::kTimeGuard || !sampled_) stamp_ = now;  // else what came is the last one
    sampled_ = true;
    math::Mat3 wrist;
    wrist << axes[0][0], axes[0][1], axes[0][2], axes[1][0], axes[1][1], axes[1][2], axes[2][0],
        axes[2][1], axes[2][2];
    out.stamp = stamp_;
    out.X_DH = {Vec3(p[0], p[1], p[2]), math::Quat(wrist) * shank_in_wrist()};
    out.velocity_m_s = Vec3(v[0], v[1], v[2]);
    out.angular_velocity_rad_s = Vec3(w[0], w[1], w[2]);
    out.saturated = saturated_;
    out.buttons = api_->buttons(id_);
    out.gripper_gap_m = has_gripper_ ? gap() : 0.0;
    if (++reads_ % kStatusEvery == 0) return check_status();
    return Status::ok;
  }

  Status write(const math::Wrench& on_hand_D) noexcept override {
    if (!open_) return Status::fault;
    const Vec3 &f = on_hand_D.force_N, &t = on_hand_D.torque_Nm;
    if (!f.allFinite() || !t.allFinite()) return Status::fault;
    if (!forces_on_ && api_->enable_force(1, id_) < 0) return trouble();
    forces_on_ = true;
    const int given = api_->set_wrench(f.x(), f.y(), f.z(), t.x(), t.y(), t.z(), 0.0, id_);
    saturated_ = given == DhdApi::kSaturated;
    return given < 0 ? trouble() : Status::ok;
  }

  void close() noexcept override {
    if (id_ >= 0) {
      api_->set_wrench(0, 0, 0, 0, 0, 0, 0, id_);
      api_->stop(id_);
      api_->close(id_);
    }
    id_ = -1;
    open_ = sampled_ = saturated_ = forces_on_ = false;
    watch_.reset();
  }

 private:
  core::Result<void> find_on_usb() {
    auto found = TRY(look_for_usb(kForceDimension));
    if (found.presence != UsbPresence::present)
      return core::Error{core::Errc::unavailable, text_of(found, "lambda6")};
    auto watch = TRY(UsbWatch::start(kForceDimension));
    watch_ = std::move(watch);
    return {};
  }

  core::Error refused(const char* what) const {
    if (api_->last_error() == DhdApi::kInUse || api_->last_error() == DhdApi::kBusy)
      return not_ready("another program has it: end that first");
    return not_ready(fmt::format("{}: {}", what, api_->last_error_text()));
  }

  core::Result<void> make_ready() {
    if (!api_->has_active_wrist(id_))
      return not_ready(
          fmt::format("{} has no active wrist: six driven degrees of freedom are "
                      "expected",
                      api_->system_name(id_)));
    has_gripper_ = api_->has_gripper(id_);
    TRY(home());
    if (api_->gravity(kGravity_m_s2, id_) < 0 || api_->compensate_gravity(1, id_) < 0)
      return refused("its gravity compensation cannot be switched on");
    TRY(set_watchdog());
    // The factory's velocity guard stays as it is. Forces wait for the first command: from then on
    // somebody keeps the watchdog quiet.
    if (api_->enable_force(0, id_) < 0) return refused("its forces cannot be switched");
    return {};
  }

  core::Result<void> home() {
    if (!api_->is_initialised) return {};
    if (options_.homing == Homing::refuse) {
      if (api_->is_initialised(id_)) return {};
      return not_ready(
          "not calibrated since it was switched on: run `tractus-station calibrate`; its handle "
          "will move by itself");
    }
    if (api_->initialise(id_) < 0) return refused("cannot find its zero");
    if (api_->stop_regulation(true, id_) < 0) return refused("cannot let go of its handle");
    return {};
  }

  core::Result<void> set_watchdog() {
    const auto steps =
        static_cast<unsigned char>(std::lround(kWatchdog_s / DhdApi::kWatchdogStep_s));
    unsigned char now = 0;
    api_->enable_expert_mode();
    if (api_->set_watchdog(steps, id_) < 0 || api_->watchdog(&now, id_) < 0 || now == 0 ||
        now > steps)
      return refused("its watchdog cannot be set to 10 ms");
    return {};
  }

  unsigned serial_number() const {
    unsigned short number = 0;
    return api_->serial_number(&number, id_) < 0 ? 0u : number;
  }

  double gap() const noexcept {
    double gap_m = 0.0;
    return api_->gripper_gap(&gap_m, id_) < 0 ? 0.0 : gap_m;
  }

  /// Of an error that a call just gave.
  Status trouble() const noexcept {
    const int error = api_->last_error();
    return error == DhdApi::kCom || error == DhdApi::kNoDevice ? Status::gone : Status::fault;
  }

  Status check_status() const noexcept {
    int status[DhdApi::kStatusCount] = {};
    if (api_->status(status, id_) < 0) return trouble();
    if (!status[DhdApi::kConnected] || status[DhdApi::kForceOffCause] == DhdApi::kForceOffUnplugged)
      return Status::gone;
    return status[DhdApi::kForce] || !forces_on_ ? Status::ok : Status::forces_off;
  }

  DeviceOptions options_;
  std::optional<DhdLibrary> library_;
  const DhdApi* api_ = nullptr;
  std::unique_ptr<UsbWatch> watch_;
  core::Instant_ns stamp_ = 0;
  unsigned reads_ = 0;
  char id_ = -1;
  bool open_ = false, sampled_ = false, saturated_ = false, forces_on_ = false;
  bool has_gripper_ = false;
};

core::Result<MadeDevice> make_lambda6(const DeviceOptions& options) {
  return MadeDevice{.device = std::make_unique<Lambda6>(options)};
}

}  // namespace

DeviceInfo lambda6_device() {
  return {.id = "lambda6",
          .summary = "Force Dimension lambda.6, six driven degrees of freedom, held by a person",
          .kind = DeviceKind::handle,
          .simulated = false,
          .addressed_by = AddressedBy::sdk,
          .make = make_lambda6};
}

}  // namespace devices
}  // namespace tractus
