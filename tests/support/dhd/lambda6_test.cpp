/// The lambda.6's driver through the stand-in library and a USB of umockdev's making.
#include <gtest/gtest.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <umockdev.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <checkout.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <thread>

#include "station/devices/catalogue.hpp"
#include "station/devices/dhd_library.hpp"
#include "station/devices/usb_presence.hpp"
#include "station/loop/haptic_loop.hpp"
#include "tests/support/dhd/control.hpp"

namespace tractus {
namespace devices {
namespace {
using math::Vec3;
namespace fs = std::filesystem;

constexpr core::Instant_ns kPeriod = 250'000;
const std::string kDevice = "/sys/devices/pci0000:00/0000:00:14.0/usb1/1-2";

std::string text_of_file(const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

class Lambda6 : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const std::string path = "/tmp/tractus-dhd-standin-" + std::to_string(::getpid());
    ::unlink(path.c_str());
    ::setenv("TRACTUS_DHD_STANDIN", path.c_str(), 1);
    control_ = support::mapped_in<standin::Control>(path);
    ASSERT_NE(control_, nullptr);
    path_ = path;
  }
  static void TearDownTestSuite() { ::unlink(path_.c_str()); }
  void SetUp() override {
    new (control_) standin::Control;
    control_->step_ns = kPeriod;  // a read moves its time by one tick
    bed_ = umockdev_testbed_new();
    plug_in();
  }
  void TearDown() override { g_object_unref(bed_); }

  void plug_in() {
    static const std::string text =
        text_of_file(std::string(checkout::kSource) + "/tests/support/dhd/lambda6.umockdev");
    GError* error = nullptr;
    ASSERT_TRUE(umockdev_testbed_add_from_string(bed_, text.c_str(), &error))
        << (error ? error->message : "");
    umockdev_testbed_uevent(bed_, kDevice.c_str(), "add");
  }
  void pull_out() {
    umockdev_testbed_uevent(bed_, kDevice.c_str(), "remove");
    umockdev_testbed_remove_device(bed_, kDevice.c_str());
  }
  std::unique_ptr<Device> made(Homing homing = Homing::refuse) {
    return std::move(find("lambda6")->make({.sdk = checkout::kStandIn, .homing = homing})->device);
  }
  /// Waits for another thread's doing, for at most five seconds.
  static bool eventually(const std::function<bool()>& holds) {
    for (int k = 0; k < 500 && !holds(); ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return holds();
  }

  static standin::Control* control_;
  static std::string path_;
  UMockdevTestbed* bed_ = nullptr;
};
standin::Control* Lambda6::control_ = nullptr;
std::string Lambda6::path_;

TEST_F(Lambda6, OpensWithGravityAndWatchdogOnAndTheFactorysVelocityGuardUntouched) {
  const auto device = made();
  const auto limits = device->open();
  ASSERT_TRUE(limits) << limits.error().what;
  EXPECT_TRUE(limits->simulated);
  EXPECT_EQ(limits->name, "SIMULATED lambda.6, serial number 0");
  EXPECT_EQ(control_->gravity, 1);
  EXPECT_EQ(control_->watchdog_steps, 80);  // 10 ms in steps of 125 µs
  EXPECT_EQ(control_->force_on, 0);         // until somebody commands
  EXPECT_EQ(control_->velocity_guard_writes, 0);
  ASSERT_EQ(device->write({}), Status::ok);
  EXPECT_EQ(control_->force_on, 1);
  device->close();
  EXPECT_EQ(control_->force_on, 0);
  EXPECT_EQ(control_->opened, 0);
  device->close();  // twice is fine
}

// A volume is made ready and a file is made between the two: seconds, to a watchdog of 10 ms.
TEST_F(Lambda6, WaitsAsLongAsItTakesBetweenOpeningAndTheFirstCommand) {
  const auto device = made();
  ASSERT_TRUE(device->open());
  Sample sample;
  control_->step_ns = 1'000'000'000;
  for (int k = 0; k < 100; ++k) ASSERT_EQ(device->read(k, sample), Status::ok);
  control_->step_ns = kPeriod;
  for (int tick = 0; tick < 400; ++tick) {
    ASSERT_EQ(device->write({{0, 1.0, 0}, Vec3::Zero()}), Status::ok);
    ASSERT_EQ(device->read(tick * kPeriod, sample), Status::ok);
  }
  EXPECT_EQ(control_->watchdog_trips, 0);
}

TEST_F(Lambda6, GivesPoseWrenchButtonsAndGripper) {
  const auto device = made();
  ASSERT_TRUE(device->open());
  control_->hand_m[1] = 0.02;
  control_->buttons = 5;
  Sample sample;
  ASSERT_EQ(device->read(0, sample), Status::ok);  // nothing pushed it yet
  EXPECT_LT((sample.X_DH.q * Vec3::UnitZ() + Vec3::UnitX()).norm(), 1e-12);
  EXPECT_LT((sample.X_DH.q * Vec3::UnitX() - Vec3::UnitZ()).norm(), 1e-12);
  for (int tick = 1; tick <= 4000; ++tick) {
    ASSERT_EQ(device->read(tick * kPeriod, sample), Status::ok);
    ASSERT_EQ(device->write({{1.0, 0, -2.0}, {0, 0.05, 0}}), Status::ok);
  }
  EXPECT_EQ(sample.stamp, 4000 * kPeriod);
  // The spring of 350 N/m at rest: 1/350 m and -2/350 m from where the hand wants it.
  EXPECT_NEAR(sample.X_DH.p.x(), 1.0 / 350, 1e-5);
  EXPECT_NEAR(sample.X_DH.p.y(), 0.02, 1e-5);
  EXPECT_NEAR(sample.X_DH.p.z(), -2.0 / 350, 1e-5);
  // The wrist's spring of 4 N·m/rad at rest: 0.05/4 = 12.5 mrad about y, from the frame in which
  // the shank points away from the operator, who is at +x, and up stays up.
  const math::Quat turn(Eigen::AngleAxisd(0.05 / 4, Vec3::UnitY()));
  EXPECT_LT((sample.X_DH.q * Vec3::UnitZ() + turn * Vec3::UnitX()).norm(), 1e-6);
  EXPECT_LT((sample.X_DH.q * Vec3::UnitX() - turn * Vec3::UnitZ()).norm(), 1e-6);
  EXPECT_EQ(sample.buttons, 5u);
  EXPECT_NEAR(sample.gripper_gap_m, 0.012, 1e-12);
  EXPECT_EQ(control_->torque_Nm[1], 0.05);
  EXPECT_EQ(device->write({{50.0, 0, 0}, Vec3::Zero()}), Status::ok);
  device->read(4001 * kPeriod, sample);
  EXPECT_TRUE(sample.saturated);
}

TEST_F(Lambda6, TellsAbsenceFromInUseFromLostCalibrationFromTooFewDegrees) {
  const auto why = [&](Homing homing = Homing::refuse) {
    const auto device = made(homing);
    const auto opened = device->open();
    return opened ? std::string("open") : opened.error().what;
  };
  control_->in_use = 1;
  EXPECT_NE(why().find("another program has it"), std::string::npos);
  control_->in_use = 0;
  control_->active_wrist = 0;
  EXPECT_NE(why().find("six driven degrees"), std::string::npos);
  control_->active_wrist = 1;
  control_->initialised = 0;
  EXPECT_NE(why().find("tractus-station calibrate"), std::string::npos);
  EXPECT_EQ(control_->homings, 0);  // nothing moves by itself unasked
  EXPECT_EQ(why(Homing::move), "open");
  EXPECT_EQ(control_->homings, 1);
  EXPECT_EQ(why(Homing::move), "open");  // a calibration looks for it anew, lost or not
  EXPECT_EQ(control_->homings, 2);
  pull_out();
  EXPECT_NE(why().find("plug it in"), std::string::npos);
}

TEST_F(Lambda6, NamesTheSdkThatIsNotThere) {
  const auto none = DhdLibrary::load("/nowhere/sdk");
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().what.find("--sdk"), std::string::npos);
  const auto other = DhdLibrary::load("libz.so.1");
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().what.find("dhdOpen"), std::string::npos);
}

TEST_F(Lambda6, AStuckSampleKeepsItsOldStampUntilTheLimiterLatches) {
  const auto device = made();
  ASSERT_TRUE(device->open());
  Sample sample;
  device->read(kPeriod, sample);
  control_->stuck = 1;
  EXPECT_EQ(device->read(2 * kPeriod, sample), Status::ok);
  EXPECT_EQ(sample.stamp, kPeriod);
}

/// Pushes 2 N at all times once it may.
class Pusher final : public loop::Contact {
 public:
  laws::PalpationStep step(const effects::HandleMotion&, double) noexcept override {
    laws::PalpationStep out;
    out.wrench_H.force_N = {0, 0, ++ticks > 40 ? 2.0 : 0.0};
    return out;
  }
  int ticks = 0;
};

/// The live loop over driver and stand-in, tick by tick.
struct Live {
  core::ManualClock clock;
  Pusher contact;
  loop::Limiter limiter{{.ramp_s = 0.2}, kPeriod};
  loop::SampleRing ring{8192};
  loop::LiveState live;
  std::unique_ptr<Device> device;
  loop::HapticLoop loop;
  std::uint32_t number = 0;

  explicit Live(std::unique_ptr<Device> with)
      : device(std::move(with)),
        loop({clock, *device, contact, limiter, ring, live}, {}, Vec3::Zero(), 4000.0) {
    limiter.arm();
  }
  void tick() {
    ++number;
    loop.tick(number * kPeriod, number, false);
  }
};

double force_of(const standin::Control& c) {
  return std::hypot(c.force_N[0].load(), c.force_N[1].load(), c.force_N[2].load());
}

TEST_F(Lambda6, EachFaultGivesZeroWithinTwoTicksAndItsOwnWord) {
  struct Case {
    std::function<void(standin::Control&)> spoil;
    loop::Fault fault;
    int ticks;  ///< until it can be seen: what cuts its own forces is at zero by itself
  };
  const std::vector<Case> cases{
      {[](auto& c) { c.error = 7; }, loop::Fault::device, 2},
      {[](auto& c) { c.plugged = 0; }, loop::Fault::unplugged, 2},
      {[](auto& c) { c.force_off_cause = 2; }, loop::Fault::forces_off, 9},
      {[](auto& c) { c.force_off_cause = 5; }, loop::Fault::unplugged, 9},
      {[](auto& c) { c.hand_m[0] = 0.3, c.hand_N_per_m = 1e6; }, loop::Fault::speed, 40},
  };
  for (const Case& one : cases) {
    new (control_) standin::Control;
    control_->step_ns = kPeriod;
    Live live(made());
    ASSERT_TRUE(live.device->open());
    for (int k = 0; k < 2000; ++k) live.tick();
    ASSERT_EQ(live.limiter.guard(), loop::Guard::on);
    ASSERT_NEAR(force_of(*control_), 2.0, 1e-6);
    one.spoil(*control_);
    for (int k = 0; k < one.ticks; ++k) live.tick();
    EXPECT_EQ(live.limiter.fault(), one.fault) << loop::text_of(one.fault);
    // Back in order: nothing until a person arms.
    control_->error = control_->force_off_cause = 0;
    control_->plugged = 1;
    control_->hand_m[0] = control_->handle_m[0].load();
    for (int k = 0; k < 400; ++k) live.tick();
    EXPECT_EQ(force_of(*control_), 0.0);
    EXPECT_EQ(live.limiter.guard(), loop::Guard::latched);
  }
}

TEST_F(Lambda6, PulledOutItStopsAndPluggedInAgainAPersonResumes) {
  Live live(made());
  ASSERT_TRUE(live.device->open());
  for (int k = 0; k < 2000; ++k) live.tick();
  ASSERT_EQ(live.limiter.guard(), loop::Guard::on);
  pull_out();  // the SDK itself notices nothing: the USB tells
  ASSERT_TRUE(eventually([&] {
    live.tick();
    return live.limiter.guard() == loop::Guard::latched;
  }));
  EXPECT_EQ(live.limiter.fault(), loop::Fault::unplugged);
  EXPECT_EQ(force_of(*control_), 0.0);
  EXPECT_FALSE(live.device->open());
  plug_in();
  for (int k = 0; k < 100; ++k) live.tick();
  EXPECT_EQ(live.limiter.guard(), loop::Guard::latched);  // not by itself
  ASSERT_TRUE(live.device->open());
  live.limiter.arm();  // a person
  live.contact.ticks = 0;
  for (int k = 0; k < 2000; ++k) live.tick();
  EXPECT_NEAR(force_of(*control_), 2.0, 1e-6);
}

TEST_F(Lambda6, ItsOwnWatchdogCutsTheForcesOfAComputerThatHangs) {
  Live live(made());
  ASSERT_TRUE(live.device->open());
  for (int k = 0; k < 2000; ++k) live.tick();
  control_->step_ns = 11'000'000;  // the computer was away for 11 ms
  for (int k = 0; k < 9; ++k) live.tick();
  EXPECT_EQ(control_->watchdog_trips, 1);
  EXPECT_EQ(live.limiter.fault(), loop::Fault::forces_off);
}

TEST_F(Lambda6, UsbTellsWhatIsThereFromWhatIsNot) {
  const auto seen = look_for_usb(kForceDimension);
  ASSERT_TRUE(seen) << seen.error().what;
  EXPECT_EQ(seen->presence, UsbPresence::present);
  EXPECT_EQ(seen->where, "bus 1, device 5");
  EXPECT_EQ(look_for_usb(0x1452)->presence, UsbPresence::absent);
}

/// While it lives this process is nobody in particular; nothing when it is so already.
class AsNobody {
 public:
  AsNobody() : before_(::geteuid()) { becomes(kNobody); }
  ~AsNobody() { becomes(before_); }
  AsNobody(const AsNobody&) = delete;
  AsNobody& operator=(const AsNobody&) = delete;

 private:
  static constexpr uid_t kNobody = 65534;
  void becomes(uid_t who) const {
    if (before_ != 0) return;
    EXPECT_EQ(::seteuid(who), 0);
  }
  uid_t before_;
};

// The kernel itself refuses to open the node, which stands for /dev/bus/usb/001/005 as udev makes
// it without a rule: root's alone.
TEST_F(Lambda6, UsbTellsAMissingPermissionFromAbsence) {
  const fs::path root = umockdev_testbed_get_root_dir(bed_), node = root / "dev/bus/usb/001/005";
  fs::permissions(root, fs::perms::all);  // else not even the list is to be seen
  for (const auto& one : fs::recursive_directory_iterator(root))
    if (!one.is_symlink()) fs::permissions(one.path(), fs::perms::all);
  fs::permissions(node, fs::perms::none);
  const AsNobody nobody;
  const auto seen = look_for_usb(kForceDimension);
  ASSERT_TRUE(seen) << seen.error().what;
  EXPECT_EQ(seen->presence, UsbPresence::no_permission);
  EXPECT_EQ(seen->where, "bus 1, device 5");
  const auto opened = made()->open();
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().what.find("deploy/udev/70-tractus.rules"), std::string::npos)
      << opened.error().what;
}

/// The kernel's part while another program holds the interface: EBUSY on a claim, all else is fine.
gboolean held_by_another(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer claims) {
  const bool claim = umockdev_ioctl_client_get_request(client) == USBDEVFS_CLAIMINTERFACE;
  if (claim) ++*static_cast<std::atomic<int>*>(claims);
  umockdev_ioctl_client_complete(client, claim ? -1 : 0, claim ? EBUSY : 0);
  return TRUE;
}

TEST_F(Lambda6, UsbTellsThatAnotherProgramHasItFromAMissingPermission) {
  std::atomic<int> claims = 0;
  UMockdevIoctlBase* kernel = umockdev_ioctl_base_new();
  g_signal_connect(kernel, "handle-ioctl", G_CALLBACK(held_by_another), &claims);
  constexpr const char* kNode = "/dev/bus/usb/001/005";
  ASSERT_TRUE(umockdev_testbed_attach_ioctl(bed_, kNode, kernel, nullptr));
  const auto seen = look_for_usb(kForceDimension);
  const auto opened = made()->open();
  umockdev_testbed_detach_ioctl(bed_, kNode, nullptr);
  g_object_unref(kernel);
  ASSERT_TRUE(seen) << seen.error().what;
  EXPECT_EQ(seen->presence, UsbPresence::in_use);
  EXPECT_EQ(claims, 2);
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().what.find("another program has it"), std::string::npos);
  EXPECT_EQ(control_->opened, 0) << "the SDK was not asked";
  EXPECT_EQ(look_for_usb(kForceDimension)->presence, UsbPresence::present) << "it let go";
}

/// Reported, never a gate: a read and a write through the driver, beside nothing else.
TEST_F(Lambda6, PrintsTheRoundTripThroughTheStandIn) {
  const auto device = made();
  ASSERT_TRUE(device->open());
  core::MonotonicClock clock;
  loop::TimeHistogram trip;
  Sample sample;
  for (int k = 0; k < 20'000; ++k) {
    const core::Instant_ns start = clock.now();
    ASSERT_EQ(device->read(start, sample), Status::ok);
    ASSERT_EQ(device->write({{0.5, 0, 0}, Vec3::Zero()}), Status::ok);
    trip.add(clock.now() - start);
  }
  std::printf("round trip through the stand-in: p50 %.0f us, p99 %.0f us, p99.9 %.0f us\n",
              trip.quantile_us(0.5), trip.quantile_us(0.99), trip.quantile_us(0.999));
  EXPECT_EQ(control_->reads, 20'000u);
}

}  // namespace
}  // namespace devices
}  // namespace tractus
