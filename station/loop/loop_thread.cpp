#include "station/loop/loop_thread.hpp"

#include <optional>

namespace tractus::loop {

LoopThread::LoopThread(Pace pace, std::function<void()> run)
    : thread_([this, pace, run = std::move(run)] { work(pace, run); }) {
  ready_.get_future().wait();
}

LoopThread::~LoopThread() {
  if (gone_) return;
  go_.set_value(false);
  join();
}

void LoopThread::work(Pace pace, const std::function<void()>& run) {
  std::optional<Realtime> realtime;  // as long as the loop runs
  if (pace == Pace::real_time) grant_ = realtime.emplace().grant();
  std::future<bool> go = go_.get_future();
  ready_.set_value();
  if (go.get()) run();
  realtime.reset();
  done_.set_value();
}

void LoopThread::go() {
  gone_ = true;
  go_.set_value(true);
}

bool LoopThread::ended_within(std::chrono::milliseconds wait) const {
  return ended_.wait_for(wait) == std::future_status::ready;
}

void LoopThread::join() {
  if (thread_.joinable()) thread_.join();
}

}  // namespace tractus::loop
