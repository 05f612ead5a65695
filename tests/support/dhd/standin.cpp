/// Force Dimension's C interface with a simulated lambda.6 behind it. See README.md.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "tests/support/dhd/control.hpp"

namespace standin = tractus::standin;

namespace {
using standin::Control;

constexpr double kMass_kg = 0.2, kHand_Ns_per_m = 14.0, kFriction_Ns_per_m = 0.8;
constexpr double kInertia_kgm2 = 2e-4, kHand_Nm_per_rad = 4.0, kHand_Nms_per_rad = 0.04;
constexpr double kMaxForce_N = 20.0, kMaxTorque_Nm = 0.2, kStep_s = 1.25e-4;
constexpr std::int64_t kWatchdogStep_ns = 125'000;
constexpr int kErrorCom = 2, kErrorNoDevice = 5, kErrorInUse = 20, kCauseWatchdog = 3;

Control& control() {
  static Control own;
  static Control* const at = [] {
    const char* path = std::getenv("TRACTUS_DHD_STANDIN");
    Control* mapped = path ? tractus::support::mapped_in<standin::Control>(path) : nullptr;
    return mapped ? mapped : &own;
  }();
  return *at;
}

/// The handle in the hand: springs and dampers to where the hand wants it, in six degrees.
struct Handle {
  std::array<double, 3> p{}, v{}, r{}, w{}, force{}, torque{};  // r: turn, rad
  double opened_s = 0.0;
  std::int64_t now_ns = 0, commanded_ns = 0;
  bool started = false, tripped = false;
};
Handle handle;
int last_error = 0;

int fail(int code) {
  last_error = code;
  return -1;
}

/// The error that every call ends with just now, or 0.
int trouble() {
  if (!control().plugged) return kErrorCom;
  if (!control().opened) return kErrorNoDevice;
  return control().error;
}

/// Rodrigues' formula: the matrix of a turn about `r` by its length.
void turned(const std::array<double, 3>& r, double m[3][3]) {
  const double angle = std::hypot(r[0], r[1], r[2]);
  const double s = angle > 1e-9 ? std::sin(angle) / angle : 1.0;
  const double c = angle > 1e-9 ? (1.0 - std::cos(angle)) / (angle * angle) : 0.5;
  const double cross[3][3] = {{0, -r[2], r[1]}, {r[2], 0, -r[0]}, {-r[1], r[0], 0}};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      m[i][j] = (i == j ? 1.0 - c * angle * angle : 0.0) + s * cross[i][j] + c * r[i] * r[j];
}

std::int64_t clock_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// Where the hand wants the handle.
double wanted_m(std::size_t axis) {
  const double far = handle.opened_s < 1.0 ? double{control().roaming_m} : 0.0;
  return control().hand_m[axis] + far * std::sin(2.0 * std::numbers::pi * handle.opened_s);
}

void integrate(double dt_s) {
  const double k = control().hand_N_per_m;
  const bool on = control().force_on && !handle.tripped && !control().force_off_cause;
  handle.opened_s += dt_s;
  for (std::size_t a = 0; a < 3; ++a) {
    const double push = on ? control().motor[a] * handle.force[a] : 0.0;
    const double pull = k * (wanted_m(a) - handle.p[a]) + push;
    handle.v[a] = (handle.v[a] + dt_s / kMass_kg * pull) /
                  (1.0 + dt_s / kMass_kg * (kHand_Ns_per_m + kFriction_Ns_per_m));
    const double turn = on ? control().motor[a + 3] * handle.torque[a] : 0.0;
    handle.w[a] = (handle.w[a] + dt_s / kInertia_kgm2 * (turn - kHand_Nm_per_rad * handle.r[a])) /
                  (1.0 + dt_s / kInertia_kgm2 * kHand_Nms_per_rad);
    if (control().jammed >> a & 1u) handle.v[a] = 0.0;
    if (control().jammed >> (a + 3) & 1u) handle.w[a] = 0.0;
    handle.p[a] += dt_s * handle.v[a];
    handle.r[a] += dt_s * handle.w[a];
    control().handle_m[a] = handle.p[a];
  }
}

/// Brings the handle, and the firmware's watchdog, to now.
void advance() {
  const std::int64_t own = control().step_ns;
  const std::int64_t now = own > 0 ? handle.now_ns + own : clock_ns();
  if (!handle.started) handle.now_ns = now, handle.started = true;
  double left_s = std::min(0.02, double(now - handle.now_ns) * 1e-9);
  handle.now_ns = now;
  const std::int64_t most = control().watchdog_steps * kWatchdogStep_ns;
  if (most > 0 && control().force_on && now - handle.commanded_ns > most && !handle.tripped) {
    handle.tripped = true;
    ++control().watchdog_trips;
  }
  for (; left_s > 1e-9; left_s -= kStep_s) integrate(std::min(kStep_s, left_s));
}
}  // namespace

extern "C" {

int drdOpen() {
  if (!control().plugged) return fail(kErrorNoDevice);
  if (control().in_use) return fail(kErrorInUse);
  handle = {};
  control().opened = 1;
  return 0;
}
int dhdOpen() { return drdOpen(); }

int drdClose(char) {
  control().opened = 0;
  control().force_on = 0;
  return 0;
}
int dhdClose(char id) { return drdClose(id); }

int dhdStop(char) {
  ++control().stops;
  control().force_on = 0;
  return 0;
}

int dhdErrorGetLast() { return last_error; }
const char* dhdErrorGetLastStr() {
  switch (last_error) {
    case kErrorCom:
      return "communication error";
    case kErrorNoDevice:
      return "no device found";
    case kErrorInUse:
      return "device in use";
    default:
      return "error";
  }
}

const char* dhdGetSystemName(char) { return "SIMULATED lambda.6"; }
int dhdGetSerialNumber(unsigned short* number, char) {
  *number = 0;
  return 0;
}
bool dhdHasActiveWrist(char) { return control().active_wrist; }
bool dhdHasGripper(char) { return true; }

int dhdGetStatus(int status[16], char) {
  if (const int error = trouble()) return fail(error);
  std::fill_n(status, 16, 0);
  const int cause = control().force_off_cause;
  status[0] = status[1] = status[2] = 1;
  status[5] = control().force_on && !cause && !handle.tripped;
  status[14] = handle.tripped ? kCauseWatchdog : cause;
  return 0;
}

int dhdEnableForce(unsigned char on, char) {
  if (const int error = trouble()) return fail(error);
  control().force_on = on;
  handle.tripped = false;
  handle.commanded_ns = handle.now_ns;
  return 0;
}
int dhdSetStandardGravity(double g, char) { return g > 9.0 && g < 10.0 ? 0 : fail(1); }
int dhdSetGravityCompensation(int on, char) {
  control().gravity = on;
  return 0;
}
int dhdEnableExpertMode() { return 0; }
int dhdSetVelocityThreshold(unsigned, char) {
  ++control().velocity_guard_writes;
  return 0;
}
int dhdSetWatchdog(unsigned char steps, char) {
  control().watchdog_steps = steps;
  return 0;
}
int dhdGetWatchdog(unsigned char* steps, char) {
  *steps = static_cast<unsigned char>(control().watchdog_steps);
  return 0;
}

int dhdGetPositionAndOrientationFrame(double* x, double* y, double* z, double matrix[3][3], char) {
  if (const int error = trouble()) return fail(error);
  ++control().reads;
  if (!control().stuck) advance();
  *x = handle.p[0], *y = handle.p[1], *z = handle.p[2];
  turned(handle.r, matrix);
  return control().stuck ? 1 : 0;
}
int dhdGetLinearVelocity(double* x, double* y, double* z, char) {
  if (const int error = trouble()) return fail(error);
  *x = handle.v[0], *y = handle.v[1], *z = handle.v[2];
  return 0;
}
int dhdGetAngularVelocityRad(double* x, double* y, double* z, char) {
  if (const int error = trouble()) return fail(error);
  *x = handle.w[0], *y = handle.w[1], *z = handle.w[2];
  return 0;
}
unsigned dhdGetButtonMask(char) { return control().buttons; }
int dhdGetGripperGap(double* gap, char) {
  *gap = control().gap_m;
  return 0;
}

int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx, double ty,
                                        double tz, double, char) {
  if (const int error = trouble()) return fail(error);
  ++control().writes;
  const double f = std::hypot(fx, fy, fz), t = std::hypot(tx, ty, tz);
  const double part =
      std::min({1.0, kMaxForce_N / std::max(f, 1e-9), kMaxTorque_Nm / std::max(t, 1e-9)});
  handle.force = {part * fx, part * fy, part * fz};
  handle.torque = {part * tx, part * ty, part * tz};
  handle.commanded_ns = control().step_ns > 0 ? handle.now_ns : clock_ns();
  for (std::size_t a = 0; a < 3; ++a) {
    control().force_N[a] = handle.force[a];
    control().torque_Nm[a] = handle.torque[a];
  }
  return part < 1.0 ? 2 : 0;
}

bool drdIsInitialized(char) { return control().initialised; }
int drdAutoInit(char) {
  ++control().homings;
  control().initialised = 1;
  return 0;
}
int drdStop(bool, char) { return 0; }

}  // extern "C"
