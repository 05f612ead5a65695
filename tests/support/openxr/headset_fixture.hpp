/// The station's headset before the test runtime: no display, unless the tests are run on X.
#pragma once

#include <gtest/gtest.h>

#include <checkout.hpp>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "core/bytes.hpp"
#include "station/headset/headset.hpp"
#include "station/headset/xr.hpp"
#include "tests/support/openxr/control.hpp"

namespace tractus::headset {

/// What test and runtime share; of this process, gone with it.
struct ControlFile {
  ~ControlFile() { std::filesystem::remove(path); }
  const std::string path =
      (std::filesystem::temp_directory_path() / ("tractus_openxr_" + core::new_id())).string();
};

class WithRuntime : public testing::Test {
 protected:
  void SetUp() override {
    static const ControlFile file;
    ::setenv("TRACTUS_OPENXR_TEST", file.path.c_str(), 1);
    static fakexr::Control* const mapped = support::mapped_in<fakexr::Control>(file.path);
    ASSERT_NE(mapped, nullptr);
    control_ = new (mapped) fakexr::Control;
    control_->paced = 0;
    ::setenv("XR_RUNTIME_JSON", (std::string(checkout::kStandIn) + "/openxr_runtime.json").c_str(),
             1);
    on_x_ = std::getenv("TRACTUS_TEST_ON_X") != nullptr;
    if (!on_x_) ::unsetenv("DISPLAY");
    std::filesystem::create_directories(folder_);
    folder_.string().copy(control_->folder, sizeof(control_->folder) - 1);
    volume_.geometry.dims = {8, 8, 8};
    volume_.geometry.spacing_m = math::Vec3::Constant(1e-3);
    volume_.intercept = -1024;  // air
    volume_.counts.resize(volume_.geometry.voxel_count());
    probe_.points = 1;
    probe_.radius_m = 0.005;
  }
  void TearDown() override {
    forget_runtime();
    EXPECT_EQ(control_->violations, 0) << control_->words;
    std::filesystem::remove_all(folder_);
  }

  /// The loader keeps a runtime, and what it offered, until an instance of it was destroyed.
  static void forget_runtime() {
    auto info = typed<XrInstanceCreateInfo>(XR_TYPE_INSTANCE_CREATE_INFO);
    std::strcpy(info.applicationInfo.applicationName, "test");
    info.applicationInfo.apiVersion = XR_CURRENT_API_VERSION;
    XrInstance instance = XR_NULL_HANDLE;
    if (XR_SUCCEEDED(xrCreateInstance(&info, &instance))) xrDestroyInstance(instance);
  }
  /// Nothing but the probe, its tip (a red ball of 7 mm) where `tip_m_` is, its shank upwards; the
  /// room's frame, the device's and the volume's are one.
  Shown shown() {
    tract_.entry_m = {0.0, -5.0, 0.0};  // far below
    return {.scene = {volume_, transfer_, tract_, probe_},
            .X_VD = {},
            .X_SD = math::Pose{},
            .latest = [this]() -> std::optional<Moment> {
              Moment now;
              now.state.X_VH.q =
                  math::Quat::FromTwoVectors(math::Vec3::UnitZ(), math::Vec3::UnitY());
              now.state.X_VH.p = tip_m_ - probe_.length_m * math::Vec3::UnitY();
              now.tip_m = tip_m_;
              return now;
            },
            .carved = {}};
  }
  std::unique_ptr<Headset> made(const Shown& what) {
    auto out = Headset::make(what, clock_);
    EXPECT_TRUE(out) << out.error().what;
    return out ? std::move(*out) : nullptr;
  }
  /// Why it is not made.
  std::string why_not() {
    auto out = Headset::make(shown(), clock_);
    return out ? "made" : out.error().what;
  }
  /// Steps until the runtime has had so many frames in all, or it is over.
  static bool step_to(Headset& headset, const fakexr::Control& control, std::uint64_t frames) {
    for (int i = 0; i < 10'000 && control.frames < frames; ++i)
      if (!headset.step()) return false;
    return true;
  }
  /// Leaves in good order.
  static bool left(Headset& headset) {
    headset.ask_to_leave();
    for (int i = 0; i < 100; ++i)
      if (!headset.step()) return true;
    return false;
  }

  fakexr::Control* control_ = nullptr;
  bool on_x_ = false;
  core::ManualClock clock_;
  volume::Volume volume_;
  volume::TransferFunction transfer_ = volume::TransferFunction::bone();
  volume::Tract tract_;
  laws::PalpationParameters probe_;
  math::Vec3 tip_m_{0.05, 1.5, -0.4};
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("tractus_eyes_" + core::new_id());
};

}  // namespace tractus::headset
