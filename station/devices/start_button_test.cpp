#include "station/devices/start_button.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace tractus {
namespace devices {
namespace {

/// Buttons as they are told, one a call; then it is gone.
class PlayedHandle final : public Device {
 public:
  PlayedHandle(std::vector<std::uint32_t> buttons, bool& closed)
      : buttons_(std::move(buttons)), closed_(closed) {}
  core::Result<Limits> open() override { return Limits{}; }
  Status read(core::Instant_ns now, Sample& out) noexcept override {
    if (next_ == buttons_.size()) return Status::gone;
    out = {};
    out.stamp = now;
    out.buttons = buttons_[next_++];
    return Status::ok;
  }
  Status write(const math::Wrench&) noexcept override {
    ADD_FAILURE() << "no force is given between two trials";
    return Status::ok;
  }
  void close() noexcept override { closed_ = true; }

 private:
  std::vector<std::uint32_t> buttons_;
  std::size_t next_ = 0;
  bool& closed_;
};

class PlayedRig final : public RigDevice {
 public:
  explicit PlayedRig(std::vector<Exchange> how) : how_(std::move(how)) {}
  core::Result<RigIdentity> open() override { return RigIdentity{}; }
  Exchange exchange(const RigCommand& command, RigReading& out) noexcept override {
    EXPECT_FALSE(command.enable || command.reset_fault || command.rotary_on);
    const Exchange how = next_ < how_.size() ? how_[next_] : Exchange::gone;
    out.status = next_++ == 1 ? rig::kStartPressed : 0;
    return how;
  }
  void close() noexcept override {}

 private:
  std::vector<Exchange> how_;
  std::size_t next_ = 0;
};

TEST(StartButton, CountsAPressOnceAndOnlyAfterARelease) {
  bool closed = false;
  {
    // Held since the last trial, released, the second button, pressed and held, released, pressed.
    StartButton button(
        std::make_unique<PlayedHandle>(std::vector<std::uint32_t>{1, 1, 0, 2, 1, 1, 0, 1}, closed));
    ASSERT_TRUE(button.open());
    std::vector<bool> seen;
    while (const auto pressed = button.pressed(0)) seen.push_back(*pressed);
    EXPECT_EQ(seen, (std::vector<bool>{false, false, false, false, true, false, false, true}));
    EXPECT_FALSE(closed);
  }
  EXPECT_TRUE(closed) << "the trial opens the device anew";
}

TEST(StartButton, OfARigIsReadWithoutACommandAndSilenceIsNoPress) {
  StartButton button(
      std::make_unique<PlayedRig>(std::vector{Exchange::ok, Exchange::ok, Exchange::silent}));
  ASSERT_TRUE(button.open());
  EXPECT_EQ(button.pressed(0), false);
  EXPECT_EQ(button.pressed(0), true);
  EXPECT_EQ(button.pressed(0), std::nullopt);
}

}  // namespace
}  // namespace devices
}  // namespace tractus
