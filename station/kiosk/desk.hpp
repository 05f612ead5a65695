/// The machine between two sides: the page commands, the session tells and waits. Safe from several
/// threads; the haptic loop's is none of them.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>

#include "station/kiosk/machine.hpp"

namespace tractus::kiosk {

class Desk {
 public:
  /// `clock` outlives this.
  Desk(const core::Clock& clock, Machine machine) : clock_(clock), machine_(std::move(machine)) {}

  /// A command of the page. Errors: those of Machine::take.
  core::Result<void> take(const Command& command);
  /// Something that the session's thread says of itself.
  void tell(const std::function<void(Machine&, core::Instant_ns)>& event);
  /// Something that the session's thread looks up.
  template <class Look>
  auto look(const Look& look) const {
    const std::lock_guard held(mutex_);
    return look(machine_);
  }
  /// Until `done` holds; meanwhile the time-outs run. False when `stopped` came first, which is
  /// asked ten times a second.
  bool wait(const std::function<bool(const Machine&)>& done, const std::function<bool()>& stopped);

  /// Who is told each change, as the page's JSON, at once and from then on; one at a time, the
  /// newest. It must not wait and must not call back. Empty: nobody.
  using Listener = std::function<void(const std::string& shown)>;
  void listen(Listener listener);

 private:
  void publish();

  const core::Clock& clock_;
  mutable std::mutex mutex_;  ///< guards what follows
  std::condition_variable changed_;
  Machine machine_;
  Listener listener_;
};

}  // namespace tractus::kiosk
