/// A tool's pose and forces out by OpenIGTLink, heard by the protocol's own library.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <checkout.hpp>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <sstream>

#include "core/file.hpp"
#include "core/json.hpp"
#include "station/sensors/igtl_sender.hpp"
#include "station/sensors/socket.hpp"

namespace tractus {
namespace {
namespace fs = std::filesystem;
using math::Vec3;

class IgtlOut : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  int shell(const std::string& line) {
    return WEXITSTATUS(
        std::system(fmt::format("cd {} || exit 9; {}", folder_.string(), line).c_str()));
  }
  std::vector<core::Json> heard(const std::string& file) const {
    std::vector<core::Json> out;
    const auto bytes = core::read_file(folder_ / file);
    std::istringstream lines(bytes ? std::string(core::text_of(*bytes)) : "");
    for (std::string line; std::getline(lines, line);)
      if (auto json = core::parse_json(line, file)) out.push_back(*json);
    return out;
  }
  static std::string listener(int port, int count) {
    return fmt::format("{}/../tests/igtl_listener {} {}", checkout::kBin, port, count);
  }
  const fs::path folder_ = fs::temp_directory_path() / ("tractus_igtl_" + core::new_id());
};

/// A tip at (46, 200, −61) mm LPS, turned by 90° about z: x of the tool points along +y of LPS.
sensors::ToolMoment moment() {
  return {.X_VT = {Vec3(0.046, 0.2, -0.061),
                   math::Quat(std::numbers::sqrt2 / 2, 0, 0, std::numbers::sqrt2 / 2)},
          .force_N = Vec3(0.5, -0.25, 1.0),
          .torque_Nm = Vec3(0.001, 0.002, -0.003)};
}

TEST_F(IgtlOut, TheProtocolsLibraryHearsPoseForceAndTorqueWithTheirUnits) {
  auto sender = sensors::IgtlSender::start("127.0.0.1", 0, [] { return std::optional(moment()); });
  ASSERT_TRUE(sender) << sender.error().what;
  ASSERT_EQ(shell(listener((*sender)->port(), 3) + " >heard"), 0);
  const auto messages = heard("heard");
  ASSERT_EQ(messages.size(), 3u);
  for (const auto& message : messages) {
    EXPECT_EQ(message["whole"], true) << message;  // its checksum holds
    if (message["device"] == "TractusTip") {
      // RAS: x and y of LPS turn round, so the tool's x is −y and its y is +x; mm.
      const double expected[] = {0, 1, 0, -46, -1, 0, 0, -200, 0, 0, 1, -61};
      for (std::size_t k = 0; k < 12; ++k)
        EXPECT_NEAR(message["m"][k].get<double>(), expected[k], 1e-4) << k;
    } else if (message["device"] == "TractusForce") {
      EXPECT_EQ(message["values"], core::Json::array({-0.5, 0.25, 1.0}));
      EXPECT_EQ(message["unit"], core::Json::array({0x0B, 1, 0, 0}));  // igtl_unit.h: newton
    } else {
      EXPECT_EQ(message["device"], "TractusTorque");
      EXPECT_EQ(message["values"], core::Json::array({-0.001, -0.002, -0.003}));
      EXPECT_EQ(message["unit"], core::Json::array({0x0B, 1, 0x01, 1}));  // newton, metre
    }
  }
}

TEST_F(IgtlOut, AListenerThatDoesNotReadSlowsNobody) {
  auto sender = sensors::IgtlSender::start("127.0.0.1", 0, [] { return std::optional(moment()); });
  ASSERT_TRUE(sender) << sender.error().what;
  const int port = (*sender)->port();
  std::vector<sensors::Socket> deaf;
  for (int k = 0; k < 3; ++k) {
    auto one = sensors::Socket::connect("test", "127.0.0.1", port, sensors::Transport::tcp);
    ASSERT_TRUE(one) << one.error().what;
    deaf.push_back(std::move(*one));
    const std::string rubbish(5000, 'x');
    ASSERT_GT(::send(deaf.back().fd(), rubbish.data(), rubbish.size(), MSG_NOSIGNAL), 0);
  }
  EXPECT_EQ(shell(listener(port, 120) + " >heard"), 0);
  for (const auto& message : heard("heard")) EXPECT_EQ(message["whole"], true);
  EXPECT_EQ(heard("heard").size(), 120u);
}

TEST_F(IgtlOut, APortThatIsTakenIsRefusedInWords) {
  auto first = sensors::IgtlSender::start("127.0.0.1", 0, [] { return std::optional(moment()); });
  ASSERT_TRUE(first);
  const auto second = sensors::IgtlSender::start("127.0.0.1", (*first)->port(), {});
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().what.find("cannot listen: Address already in use"), std::string::npos);
  EXPECT_FALSE(sensors::IgtlSender::start("somewhere", 0, {}));
}

TEST_F(IgtlOut, ATrialsTipIsHeardWhileItRuns) {
  const std::string bin = checkout::kBin;
  ASSERT_EQ(shell(fmt::format("{}/tractus carve --volume {}/tests/data/ct/tptbox_L3/sub-ct_label-"
                              "22_ct.nii.gz --entry 46,200,-61 --target 38.5,158,-61 --key key "
                              "--out case >out 2>err",
                              bin, checkout::kSource)),
            0);
  ASSERT_EQ(shell(bin + "/tractus-station trust --data st --case case >out 2>err"), 0);
  const std::string station =
      bin +
      "/tractus-station --device sim-lambda6 --case case --data st --duration 20 --answer "
      "none --igtl-out 0";
  // The listener connects as soon as the station says where; the trial is stopped once it was heard.
  const std::string script = fmt::format(
      "{} >out 2>err & station=$!; for k in $(seq 300); do port=$(sed -n "
      "'s/^OpenIGTLink: sends at 127.0.0.1:\\([0-9]*\\)$/\\1/p' err); [ -n \"$port\" ] && break; "
      "sleep 0.1; done; {}/../tests/igtl_listener $port 600 >heard; code=$?; kill -INT $station; "
      "wait $station; exit $code",
      station, bin);
  ASSERT_EQ(shell(script), 0);
  Vec3 low = Vec3::Constant(1e9), high = -low;
  for (const auto& message : heard("heard")) {
    if (message["type"] != "TRANSFORM") continue;
    const Vec3 at(message["m"][3].get<double>(), message["m"][7].get<double>(),
                  message["m"][11].get<double>());
    low = low.cwiseMin(at), high = high.cwiseMax(at);
  }
  EXPECT_GT((high - low).norm(), 5.0);  // mm: the simulated hand moves the tip about
  const Vec3 entry_ras_mm(-46, -200, -61);
  EXPECT_LT(((low + high) / 2 - entry_ras_mm).norm(), 120.0);  // at this vertebra, not mirrored
}

}  // namespace
}  // namespace tractus
