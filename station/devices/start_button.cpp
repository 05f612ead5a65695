#include "station/devices/start_button.hpp"

#include "core/try.hpp"

namespace tractus::devices {

StartButton::~StartButton() {
  if (handle_) handle_->close();
  if (rig_) rig_->close();
}

core::Result<void> StartButton::open() {
  if (handle_)
    TRY(handle_->open());
  else
    TRY(rig_->open());
  return {};
}

std::optional<bool> StartButton::is_down(core::Instant_ns now) noexcept {
  if (rig_) {
    RigReading reading;
    if (rig_->exchange({}, reading) != Exchange::ok) return std::nullopt;
    return (reading.status & rig::kStartPressed) != 0;
  }
  Sample sample;
  if (handle_->read(now, sample) != Status::ok) return std::nullopt;
  return (sample.buttons & 1u) != 0;
}

std::optional<bool> StartButton::pressed(core::Instant_ns now) noexcept {
  const auto down = is_down(now);
  if (!down) return std::nullopt;
  const bool went_down = *down && !was_down_;
  was_down_ = *down;
  return went_down;
}

}  // namespace tractus::devices
