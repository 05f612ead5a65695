/// Where the haptic device stands in the room that the headset sees.
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cstdio>

#include "core/try.hpp"
#include "station/app/commands.hpp"
#include "station/app/exchange.hpp"
#include "station/app/trial_epilogue.hpp"
#include "station/devices/catalogue.hpp"
#include "station/headset/touching.hpp"
#include "station/headset/touching_hand.hpp"

namespace tractus {
namespace app {
namespace {

core::Result<std::unique_ptr<devices::Device>> device_for(
    const Options& options, std::span<const headset::FixturePoint> points,
    const math::Vec3& tip_H_m) {
  auto info = TRY(devices::find(options.setup.device, devices::DeviceKind::handle));
  if (info.simulated)
    return std::unique_ptr<devices::Device>(new headset::TouchingHand(points, tip_H_m));
  devices::DeviceOptions how;
  how.sdk = options.setup.sdk;
  auto made = TRY(info.make(how));
  return std::move(made.device);
}

/// Has somebody pressed Enter? An input that has ended presses nothing more.
class Enter {
 public:
  bool operator()() {
    pollfd in{STDIN_FILENO, POLLIN, 0};
    if (ended_ || ::poll(&in, 1, 0) <= 0) return false;
    char one = 0;
    ended_ = ::read(STDIN_FILENO, &one, 1) != 1;
    return !ended_ && one == '\n';
  }

 private:
  bool ended_ = false;
};

headset::TouchExchange talk_of(Enter& enter) {
  return {.ask =
              [](const headset::FixturePoint& next) {
                fmt::print(
                    stderr,
                    "Touch {} at ({:.3f}, {:.3f}, {:.3f}) m, hold still, press the button or "
                    "Enter.\n",
                    next.name, next.p_S_m.x(), next.p_S_m.y(), next.p_S_m.z());
              },
          .moved =
              [](const headset::FixturePoint& again) {
                fmt::print(stderr, "It moved. {} once more.\n", again.name);
              },
          .enter = [&enter] { return enter(); },
          .stop = [] { return asked_to_stop(); }};
}

void print(const Options& options, const headset::KeptAlignment& kept) {
  const headset::Alignment& found = kept.alignment;
  const auto path = (options.data / "alignment.json").string();
  if (options.json) {
    fmt::print("{}\n", core::Json{{"file", path},
                                  {"device", kept.device},
                                  {"simulated", kept.simulated},
                                  {"residual_rms_m", found.rms_m},
                                  {"residual_worst_m", found.worst_m},
                                  {"worst", found.worst}}
                           .dump(2));
    return;
  }
  fmt::print("aligned{}: {:.2f} mm rms, {:.2f} mm at {}\n{}\n",
             kept.simulated ? " (SIMULATED)" : "", 1e3 * found.rms_m, 1e3 * found.worst_m,
             found.worst, path);
}

}  // namespace

core::Result<int> align_room(const Options& options) {
  auto folder = TRY(session::StationFolder::open(options.data));
  auto lock = folder.lock();  // nobody has the device in a trial meanwhile
  if (!lock) return lock.error();
  auto points = TRY(headset::read_fixture(options.fixture));
  const math::Vec3 tip_H_m(0.0, 0.0, 1e-3 * options.tip_mm);
  auto device = TRY(device_for(options, points, tip_H_m));
  auto limits = TRY(device->open());
  core::MonotonicClock clock;
  Enter enter;
  auto touched = headset::touch_points(*device, clock, points, tip_H_m, talk_of(enter));
  device->close();
  if (!touched) return touched.error();
  auto found = TRY(headset::align(*touched, 1e-3 * options.limit_mm));
  const headset::KeptAlignment kept{.alignment = found,
                                    .device = options.setup.device,
                                    .simulated = limits.simulated,
                                    .made_utc_us = core::utc_us()};
  TRY(headset::keep_alignment(options.data, kept, *touched));
  print(options, kept);
  return 0;
}

}  // namespace app
}  // namespace tractus
