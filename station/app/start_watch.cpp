#include "station/app/start_watch.hpp"

#include "station/devices/catalogue.hpp"

namespace tractus {
namespace app {
namespace {
constexpr auto kLookEvery = std::chrono::milliseconds(10);

/// Null where there is none to read.
std::unique_ptr<devices::StartButton> button_of(const Options& options) {
  const auto info = devices::find(options.setup.device);
  if (!info || info->simulated) return nullptr;
  if (info->kind == devices::DeviceKind::rig) {
    auto made = info->make_rig({.address = options.rig.address});
    return made ? std::make_unique<devices::StartButton>(std::move(made->device)) : nullptr;
  }
  auto made = info->make({.sdk = options.setup.sdk});
  return made ? std::make_unique<devices::StartButton>(std::move(made->device)) : nullptr;
}
}  // namespace

std::unique_ptr<StartWatch> StartWatch::begin(const Options& options,
                                              std::function<void()> pressed) {
  auto button = button_of(options);
  if (!button || !button->open()) return nullptr;
  return std::unique_ptr<StartWatch>(new StartWatch(std::move(button), std::move(pressed)));
}

StartWatch::StartWatch(std::unique_ptr<devices::StartButton> button, std::function<void()> pressed)
    : button_(std::move(button)), thread_([this, pressed](const std::stop_token& stop) {
        const core::MonotonicClock clock;
        for (; !stop.stop_requested(); std::this_thread::sleep_for(kLookEvery))
          if (button_->pressed(clock.now()).value_or(false)) pressed();
      }) {}

}  // namespace app
}  // namespace tractus
