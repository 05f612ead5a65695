#include "station/kiosk/desk.hpp"

#include <chrono>

namespace tractus {
namespace kiosk {
namespace {
constexpr auto kLookAgain = std::chrono::milliseconds(100);
}

void Desk::publish() {
  changed_.notify_all();
  if (listener_) listener_(machine_.to_json().dump());
}

core::Result<void> Desk::take(const Command& command) {
  const std::lock_guard held(mutex_);
  auto taken = machine_.take(command, clock_.now());
  if (taken) publish();
  return taken;
}

void Desk::tell(const std::function<void(Machine&, core::Instant_ns)>& event) {
  const std::lock_guard held(mutex_);
  event(machine_, clock_.now());
  publish();
}

bool Desk::wait(const std::function<bool(const Machine&)>& done,
                const std::function<bool()>& stopped) {
  std::unique_lock held(mutex_);
  while (!done(machine_)) {
    if (stopped()) return false;
    if (machine_.tick(clock_.now())) publish();
    if (!done(machine_)) changed_.wait_for(held, kLookAgain);
  }
  return true;
}

void Desk::listen(Listener listener) {
  const std::lock_guard held(mutex_);
  listener_ = std::move(listener);
  if (listener_) listener_(machine_.to_json().dump());
}

}  // namespace kiosk
}  // namespace tractus
