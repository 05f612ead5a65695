#include "db/store/database/signals.hpp"

#include <fmt/format.h>

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/database/listeners.hpp"
#include "db/store/store.hpp"

namespace tractus {
namespace store {
namespace {

/// A queue of signals and the thread that hands them to who listens.
class LocalSignals final : public Signals {
 public:
  ~LocalSignals() override {
    {
      const std::lock_guard held(mutex_);
      ending_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }

  core::Result<std::unique_ptr<Listening>> listen(const std::string& channel,
                                                  Heard heard) override {
    auto listening = listeners_.add(channel, std::move(heard));
    const std::lock_guard held(mutex_);
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
    return listening;
  }

  core::Result<void> send(const std::string& channel, const std::string& payload) override {
    TRY(check_payload(payload));
    const Noted noted{channel, payload};
    committed({&noted, 1});
    return {};
  }

  const std::string& own_id() const override { return id_; }

 protected:
  core::Result<void> committing(Writing&, std::span<const Noted>) override { return {}; }
  void committed(std::span<const Noted> noted) override {
    {
      const std::lock_guard held(mutex_);
      if (!thread_.joinable()) return;  // nobody listens, or ever did
      waiting_.insert(waiting_.end(), noted.begin(), noted.end());
    }
    changed_.notify_all();
  }

 private:
  void run() {
    std::unique_lock held(mutex_);
    while (true) {
      changed_.wait(held, [this] { return ending_ || !waiting_.empty(); });
      if (ending_) return;
      const Noted next = std::move(waiting_.front());
      waiting_.pop_front();
      held.unlock();
      listeners_.tell(next.channel, {id_, next.payload});
      held.lock();
    }
  }

  const std::string id_ = core::new_id();
  Listeners listeners_;
  std::mutex mutex_;  ///< guards what follows
  bool ending_ = false;
  std::deque<Noted> waiting_;
  std::condition_variable changed_;
  std::thread thread_;
};

}  // namespace

core::Result<void> check_payload(const std::string& payload) {
  core::require(!payload.empty(), "a signal says something");
  if (payload.size() <= Signals::kMostPayload_bytes) return {};
  return core::Error{core::Errc::too_large,
                     fmt::format("a signal of {} bytes; at most {} are carried", payload.size(),
                                 Signals::kMostPayload_bytes)};
}

std::unique_ptr<Signals> local_signals() { return std::make_unique<LocalSignals>(); }

core::Result<void> notify(Writing& tx, const std::string& channel, const std::string& payload) {
  TRY(check_payload(payload));
  tx.noted_.push_back({channel, payload});
  return {};
}

}  // namespace store
}  // namespace tractus
