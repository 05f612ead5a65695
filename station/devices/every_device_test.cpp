/// What every simulated handle of the catalogue keeps to.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "station/devices/catalogue.hpp"

namespace tractus {
namespace devices {
namespace {

using math::Vec3;

class EveryDevice : public testing::TestWithParam<std::string> {
 protected:
  const DeviceInfo info_ = *find(GetParam());
};

TEST_P(EveryDevice, RefusesOptionsThatMeanNothing) {
  for (const DeviceOptions& options :
       {DeviceOptions{.duration_s = std::nan("")}, DeviceOptions{.duration_s = -1.0},
        DeviceOptions{.probe_length_m = std::nan("")}}) {
    const auto made = info_.make(options);
    ASSERT_FALSE(made) << "duration " << options.duration_s << " s, probe "
                       << options.probe_length_m << " m";
    EXPECT_EQ(made.error().code, core::Errc::out_of_range) << made.error().what;
  }
}

TEST_P(EveryDevice, IsClosedBeforeItIsOpenedAndMayBeClosedTwice) {
  auto made = info_.make({});
  ASSERT_TRUE(made) << made.error().what;
  Device& device = *made->device;
  Sample sample;
  EXPECT_TRUE(device.read(0, sample) == Status::fault) << "read before it is opened";
  EXPECT_TRUE(device.open());
  EXPECT_TRUE(device.write({Vec3::Constant(NAN), Vec3::Zero()}) == Status::fault)
      << "a force that is not a number";
  device.close();
  device.close();
  EXPECT_TRUE(device.write({}) == Status::fault) << "a force after it is closed";
}

std::vector<std::string> simulated_handles() {
  std::vector<std::string> out;
  for (const DeviceInfo& info : all(DeviceKind::handle))
    if (info.simulated) out.push_back(info.id);
  return out;
}
INSTANTIATE_TEST_SUITE_P(Catalogue, EveryDevice, testing::ValuesIn(simulated_handles()),
                         [](const auto& one) {
                           std::string name = one.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace devices
}  // namespace tractus
