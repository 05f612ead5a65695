#include "station/devices/dhd_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <vector>

#include "core/try.hpp"

namespace tractus {
namespace devices {
namespace {
namespace fs = std::filesystem;

/// File names that may be tried, first things first.
std::vector<std::string> candidates(const fs::path& given) {
  const std::vector<std::string> names{"libdrd.so.3", "libdrd.so", "libdhd.so.3", "libdhd.so"};
  std::vector<std::string> out;
  const auto in_sdk = [&](const fs::path& sdk) {
    for (const char* folder : {"lib/release/lin-x86_64-gcc", "lib", ""})
      for (const std::string& name : names) out.push_back((sdk / folder / name).string());
  };
  std::error_code failed;
  if (!given.empty() && !fs::is_directory(given, failed)) return {given.string()};
  if (!given.empty()) {
    in_sdk(given);
    return out;
  }
  if (const char* sdk = std::getenv("FDSDK"); sdk && *sdk) in_sdk(sdk);
  out.insert(out.end(), names.begin(), names.end());
  return out;
}

/// Sets `function` to the symbol; notes the name when there is none.
template <class F>
void find(void* library, const char* name, F& function, std::string& missing) {
  function = reinterpret_cast<F>(::dlsym(library, name));
  if (!function) missing += (missing.empty() ? "" : ", ") + std::string(name);
}
}  // namespace

void DhdLibrary::Close::operator()(void* handle) const noexcept { ::dlclose(handle); }

core::Result<DhdLibrary> DhdLibrary::load(const fs::path& given) {
  DhdLibrary out;
  std::string why;
  for (const std::string& name : candidates(given)) {
    out.handle_.reset(::dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL));
    if (out.handle_) {
      out.name_ = name;
      break;
    }
    const std::string said = ::dlerror();
    std::error_code failed;
    if (why.empty() || fs::exists(name, failed)) why = said;
  }
  if (!out.handle_)
    return core::Error{
        core::Errc::unavailable,
        fmt::format("lambda6: Force Dimension's SDK was not found ({}); install it and name its "
                    "folder with --sdk or FDSDK",
                    why)};
  TRY(out.resolve());
  return out;
}

core::Result<void> DhdLibrary::resolve() {
  void* const lib = handle_.get();
  std::string missing, none;
  find(lib, "drdIsInitialized", api_.is_initialised, none);
  find(lib, "drdAutoInit", api_.initialise, none);
  find(lib, "drdStop", api_.stop_regulation, none);
  find(lib, "drdOpen", api_.open, none);
  if (none.empty()) {
    find(lib, "drdClose", api_.close, missing);
  } else {  // the haptic part alone
    api_ = {};
    find(lib, "dhdOpen", api_.open, missing);
    find(lib, "dhdClose", api_.close, missing);
  }
  find(lib, "dhdStop", api_.stop, missing);
  find(lib, "dhdErrorGetLast", api_.last_error, missing);
  find(lib, "dhdErrorGetLastStr", api_.last_error_text, missing);
  find(lib, "dhdGetSystemName", api_.system_name, missing);
  find(lib, "dhdGetSerialNumber", api_.serial_number, missing);
  find(lib, "dhdHasActiveWrist", api_.has_active_wrist, missing);
  find(lib, "dhdHasGripper", api_.has_gripper, missing);
  find(lib, "dhdGetStatus", api_.status, missing);
  find(lib, "dhdEnableForce", api_.enable_force, missing);
  find(lib, "dhdSetStandardGravity", api_.gravity, missing);
  find(lib, "dhdSetGravityCompensation", api_.compensate_gravity, missing);
  find(lib, "dhdEnableExpertMode", api_.enable_expert_mode, missing);
  find(lib, "dhdSetWatchdog", api_.set_watchdog, missing);
  find(lib, "dhdGetWatchdog", api_.watchdog, missing);
  find(lib, "dhdGetPositionAndOrientationFrame", api_.pose, missing);
  find(lib, "dhdGetLinearVelocity", api_.velocity, missing);
  find(lib, "dhdGetAngularVelocityRad", api_.turn, missing);
  find(lib, "dhdGetButtonMask", api_.buttons, missing);
  find(lib, "dhdGetGripperGap", api_.gripper_gap, missing);
  find(lib, "dhdSetForceAndTorqueAndGripperForce", api_.set_wrench, missing);
  if (!missing.empty())
    return core::Error{core::Errc::bad_input,
                       fmt::format("lambda6: {} lacks {}: version 3.10 or later of the SDK is "
                                   "expected",
                                   name_, missing)};
  return {};
}

}  // namespace devices
}  // namespace tractus
