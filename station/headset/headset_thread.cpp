#include "station/headset/headset_thread.hpp"

#include <future>

#include "core/try.hpp"

namespace tractus {
namespace headset {
namespace {
using std::chrono::steady_clock;
constexpr auto kBreath = std::chrono::milliseconds(4);
constexpr auto kFarewell = std::chrono::seconds(2);
}  // namespace

/// Hands the outcome of opening to the one who waits for it.
class Opened {
 public:
  std::promise<core::Result<void>> said;
};

core::Result<std::unique_ptr<HeadsetThread>> HeadsetThread::start(Shown shown) {
  std::unique_ptr<HeadsetThread> made(new HeadsetThread);
  Opened opened;
  auto outcome = opened.said.get_future();
  made->thread_ = std::thread(
      [&opened, self = made.get(), shown = std::move(shown)] { self->work(shown, opened); });
  TRY(outcome.get());
  return made;
}

void HeadsetThread::work(const Shown& shown, Opened& opened) {
  const core::MonotonicClock clock;
  auto made = Headset::make(shown, clock);
  if (!made) return opened.said.set_value(made.error());
  opened.said.set_value({});
  Headset& headset = **made;
  bool leaving = false;
  for (auto until = steady_clock::time_point::max(); steady_clock::now() < until;) {
    const bool more = headset.step();
    seen_ = headset.seen();
    if (!more) break;
    if (to_end_ && !leaving) {
      leaving = true;
      until = steady_clock::now() + (headset.running() ? kFarewell : kBreath);
      headset.ask_to_leave();
    }
    if (!headset.running()) std::this_thread::sleep_for(kBreath);
  }
  figures_ = headset.figures();
  if (!leaving) figures_.ended = headset.why();
}

bool HeadsetThread::wait_until_seen(std::chrono::milliseconds longest) const {
  const auto until = steady_clock::now() + longest;
  while (seen() == DisplayState::waiting && steady_clock::now() < until)
    std::this_thread::sleep_for(kBreath);
  return seen() == DisplayState::shown || seen() == DisplayState::tracking_lost;
}

const Figures& HeadsetThread::end() {
  to_end_ = true;
  if (thread_.joinable()) thread_.join();
  return figures_;
}

HeadsetThread::~HeadsetThread() { end(); }

}  // namespace headset
}  // namespace tractus
