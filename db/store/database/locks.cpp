#include "db/store/database/locks.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <mutex>
#include <thread>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/database/postgres_link.hpp"

namespace tractus {
namespace store {
namespace {

/// One of a few mutexes for every name: names that share one wait for each other, which harms
/// nobody.
class Stripes {
 public:
  std::unique_lock<std::mutex> hold(const std::string& name) {
    return std::unique_lock(mutexes_[std::hash<std::string>()(name) % mutexes_.size()]);
  }

 private:
  std::array<std::mutex, 64> mutexes_;
};

class LocalLocks final : public Locks {
 public:
  core::Result<std::unique_ptr<NamedLock>> hold(const std::string& name) override {
    return std::unique_ptr<NamedLock>(std::make_unique<Held>(stripes_.hold(name)));
  }

 private:
  struct Held final : NamedLock {
    explicit Held(std::unique_lock<std::mutex> own) : stripe(std::move(own)) {}
    std::unique_lock<std::mutex> stripe;
  };
  Stripes stripes_;
};

/// Advisory locks of one session (PostgreSQL's manual, 13.3.5): asked for without waiting, so that
/// one line serves every thread.
class PostgresLocks final : public Locks {
 public:
  explicit PostgresLocks(const std::string& address) : link_(address) {}

  core::Result<std::unique_ptr<NamedLock>> hold(const std::string& name) override {
    constexpr std::chrono::seconds kPatience{10};
    constexpr std::chrono::milliseconds kBetween{20};
    auto stripe = stripes_.hold(name);
    const auto until = std::chrono::steady_clock::now() + kPatience;
    while (true) {
      auto session = TRY(try_lock(key_of(name)));
      if (session != 0)
        return std::unique_ptr<NamedLock>(
            std::make_unique<Held>(*this, key_of(name), session, std::move(stripe)));
      if (std::chrono::steady_clock::now() > until)
        return core::Error{core::Errc::unavailable,
                           "another server has held this lock for ten seconds"};
      std::this_thread::sleep_for(kBetween);
    }
  }

 private:
  struct Held final : NamedLock {
    Held(PostgresLocks& own, std::int64_t own_key, unsigned own_session,
         std::unique_lock<std::mutex> own_stripe)
        : locks(own), key(own_key), session(own_session), stripe(std::move(own_stripe)) {}
    ~Held() override { locks.unlock(key, session); }
    PostgresLocks& locks;
    std::int64_t key;
    unsigned session;
    std::unique_lock<std::mutex> stripe;  // let go after the database's lock
  };

  static std::int64_t key_of(const std::string& name) {
    const std::string hash = core::sha256(core::bytes_of(name));
    return static_cast<std::int64_t>(std::stoull(hash.substr(0, 16), nullptr, 16));
  }

  /// The session that holds it now; 0: another process does.
  core::Result<unsigned> try_lock(std::int64_t key) {
    const std::lock_guard held(mutex_);
    const std::vector<Value> values{key};
    for (int tries = 0;; ++tries) {
      TRY(link_.connect());
      auto rows = link_.query("select pg_try_advisory_lock(?)", values);
      if (rows) return rows->front().truth(0) ? link_.session() : 0u;
      if (link_.connected() || tries > 0) return rows.error();
    }
  }
  void unlock(std::int64_t key, unsigned session) {
    const std::lock_guard held(mutex_);
    if (!link_.connected() || link_.session() != session) return;  // went with its session
    link_.send_off(fmt::format("select pg_advisory_unlock({})", key));
  }

  Stripes stripes_;
  std::mutex mutex_;  ///< guards link_
  PostgresLink link_;
};

}  // namespace

std::unique_ptr<Locks> local_locks() { return std::make_unique<LocalLocks>(); }
std::unique_ptr<Locks> postgres_locks(const std::string& address) {
  return std::make_unique<PostgresLocks>(address);
}

}  // namespace store
}  // namespace tractus
