/// Signals by NOTIFY and LISTEN (PostgreSQL's manual, NOTIFY).
#include <sys/eventfd.h>
#include <unistd.h>

#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/database/listeners.hpp"
#include "db/store/database/postgres_link.hpp"
#include "db/store/store.hpp"

namespace tractus {
namespace store {
namespace {

constexpr const char* kNotify = "select pg_notify(?, ?)";

std::string channel_name(const std::string& channel) {
  core::require(!channel.empty() &&
                    channel.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") == std::string::npos,
                "a channel is lower-case letters and underscores");
  return "tractus_" + channel;
}

class PostgresSignals final : public Signals {
 public:
  explicit PostgresSignals(const std::string& address)
      : address_(address), wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)), sender_(address) {
    core::require(wake_ >= 0, "an event can be had");
  }
  ~PostgresSignals() override {
    {
      const std::lock_guard held(mutex_);
      ending_ = true;
    }
    wake();
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
    ::close(wake_);
  }

  core::Result<std::unique_ptr<Listening>> listen(const std::string& channel,
                                                  Heard heard) override {
    constexpr std::chrono::seconds kPatience{20};
    auto listening = listeners_.add(channel, std::move(heard));
    const std::string name = channel_name(channel);
    std::unique_lock held(mutex_);
    wanted_.insert(name);
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
    wake();
    if (changed_.wait_for(held, kPatience, [&] { return listened_.contains(name); }))
      return listening;
    return core::Error{core::Errc::unavailable, why_.empty() ? "PostgreSQL: cannot listen" : why_};
  }

  core::Result<void> send(const std::string& channel, const std::string& payload) override {
    TRY(check_payload(payload));
    const std::vector<Value> values{channel_name(channel), id_ + " " + payload};
    const std::lock_guard held(sending_);
    for (int tries = 0;; ++tries) {
      TRY(sender_.connect());
      auto sent = sender_.query(kNotify, values);
      if (sent) return {};
      if (sender_.connected() || tries > 0) return sent.error();
    }
  }

  const std::string& own_id() const override { return id_; }

 protected:
  core::Result<void> committing(Writing& tx, std::span<const Noted> noted) override {
    for (const Noted& one : noted) {
      TRY(tx.query(kNotify, {channel_name(one.channel), id_ + " " + one.payload}));
    }
    return {};
  }
  void committed(std::span<const Noted>) override {}  // the database sends them

 private:
  void wake() const {
    const std::uint64_t one = 1;
    (void)!::write(wake_, &one, sizeof one);
  }

  void run() {
    PostgresLink link(address_);
    bool was_connected = false;
    while (!ending()) {
      auto heard = listen_on(link, was_connected);
      if (!heard) {
        wait_after(heard.error());
        continue;
      }
      for (const auto& one : *heard) tell(one);
    }
  }

  /// One round: connected, listening to what is wanted, what came meanwhile.
  core::Result<std::vector<PostgresLink::Notification>> listen_on(PostgresLink& link,
                                                                  bool& was_connected) {
    const bool fresh = !link.connected();
    TRY(link.connect());
    TRY(listen_to_what_is_wanted(link, fresh));
    if (fresh && was_connected) listeners_.tell("", {});
    was_connected = true;
    auto heard = link.notifications(wake_);
    std::uint64_t drained = 0;
    (void)!::read(wake_, &drained, sizeof drained);
    return heard;
  }

  core::Result<void> listen_to_what_is_wanted(PostgresLink& link, bool fresh) {
    std::set<std::string> names;
    {
      const std::lock_guard held(mutex_);
      if (fresh) listened_.clear();
      for (const std::string& name : wanted_)
        if (!listened_.contains(name)) names.insert(name);
    }
    for (const std::string& name : names) TRY(link.script("listen " + name));
    {
      const std::lock_guard held(mutex_);
      listened_.insert(names.begin(), names.end());
    }
    changed_.notify_all();
    return {};
  }

  void tell(const PostgresLink::Notification& one) {
    const auto space = one.payload.find(' ');
    const auto prefix = std::string_view("tractus_").size();
    if (space == std::string::npos || one.channel.size() <= prefix) return;  // not one of ours
    listeners_.tell(one.channel.substr(prefix),
                    {one.payload.substr(0, space), one.payload.substr(space + 1)});
  }

  bool ending() {
    const std::lock_guard held(mutex_);
    return ending_;
  }
  void wait_after(const core::Error& error) {
    constexpr std::chrono::milliseconds kBetween{500};
    std::unique_lock held(mutex_);
    why_ = error.what;
    changed_.wait_for(held, kBetween, [this] { return ending_; });
  }

  const std::string id_ = core::new_id();
  const std::string address_;
  Listeners listeners_;
  const int wake_;
  std::mutex mutex_;  ///< guards what follows
  bool ending_ = false;
  std::set<std::string> wanted_, listened_;
  std::string why_;
  std::condition_variable changed_;
  std::mutex sending_;  ///< guards sender_
  PostgresLink sender_;
  std::thread thread_;
};

}  // namespace

std::unique_ptr<Signals> postgres_signals(const std::string& address) {
  return std::make_unique<PostgresSignals>(address);
}

}  // namespace store
}  // namespace tractus
