#include "station/devices/catalogue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace tractus {
namespace devices {
namespace {

TEST(DeviceCatalogue, SaysOfEachDeviceWhatItIsAndHowItIsMade) {
  std::set<std::string> ids;
  for (const DeviceInfo& info : all()) {
    EXPECT_TRUE(ids.insert(info.id).second) << info.id;
    EXPECT_FALSE(info.summary.empty()) << info.id;
    EXPECT_EQ(info.make != nullptr, info.kind == DeviceKind::handle) << info.id;
    EXPECT_EQ(info.make_rig != nullptr, info.kind == DeviceKind::rig) << info.id;
    EXPECT_EQ(info.addressed_by == AddressedBy::nothing, info.simulated) << info.id;
    EXPECT_EQ(info.summary.find("SIMULATED") != std::string::npos, info.simulated) << info.id;
  }
}

TEST(DeviceCatalogue, FindsADeviceByItsNameAndKind) {
  EXPECT_EQ(find("sim-rig")->kind, DeviceKind::rig);
  EXPECT_FALSE(find("sim_rig"));
  EXPECT_TRUE(find("rig", DeviceKind::rig));
  const auto refused = find("rig", DeviceKind::handle);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Errc::not_found);
  EXPECT_EQ(refused.error().what, "--device rig: " + listed(DeviceKind::handle) + " is expected");
}

TEST(DeviceCatalogue, KnowsRigsAndSimulatedDevicesByName) {
  EXPECT_TRUE(is_rig("rig"));
  EXPECT_TRUE(is_rig("sim-rig"));
  EXPECT_FALSE(is_rig("lambda6"));
  EXPECT_FALSE(is_rig(""));
  EXPECT_TRUE(is_simulated("sim-lambda6"));
  EXPECT_TRUE(is_simulated("sim-rig"));
  EXPECT_FALSE(is_simulated("rig"));
  EXPECT_FALSE(is_simulated("unknown"));
}

TEST(DeviceCatalogue, ListsDevicesForAPerson) {
  const DeviceInfo lambda6 = *find("lambda6"), rig = *find("rig"), sim_rig = *find("sim-rig");
  EXPECT_EQ(listed({lambda6, rig, sim_rig}), "lambda6, rig or sim-rig");
  EXPECT_EQ(listed({rig, sim_rig}), "rig or sim-rig");
  EXPECT_EQ(listed({rig}), "rig");
  EXPECT_EQ(listed(std::vector<DeviceInfo>{}), "");
}

TEST(DeviceCatalogue, ARigOfNoAddressIsRefused) {
  const auto refused = find("rig")->make_rig({.address = "nowhere"});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Errc::bad_input);
}

}  // namespace
}  // namespace devices
}  // namespace tractus
