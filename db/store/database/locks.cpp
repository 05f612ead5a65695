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
  core::Result<HeldRows> hold_and_query(const std::string& name, const Statement&) override {
    auto lock = TRY(hold(name));
    return HeldRows{std::move(lock), std::nullopt};
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
    return std::move(TRY(held(name, nullptr)).lock);
  }
  core::Result<HeldRows> hold_and_query(const std::string& name,
                                        const Statement& statement) override {
    return held(name, &statement);
  }

 private:
  core::Result<HeldRows> held(const std::string& name, const Statement* statement) {
    constexpr std::chrono::seconds kPatience{10};
    constexpr std::chrono::milliseconds kBetween{20};
    auto stripe = stripes_.hold(name);
    const auto until = std::chrono::steady_clock::now() + kPatience;
    while (true) {
      std::optional<Rows> rows;
      const auto session = TRY(try_lock(key_of(name), statement, rows));
      if (session != 0)
        return HeldRows{std::make_unique<Held>(*this, key_of(name), session, std::move(stripe)),
                        std::move(rows)};
      if (std::chrono::steady_clock::now() > until)
        return core::Error{core::Errc::unavailable,
                           "another server has held this lock for ten seconds"};
      std::this_thread::sleep_for(kBetween);
    }
  }

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

  /// The session that holds it now; 0: another process does. `rows` of the statement, if there is
  /// one and the name is held.
  core::Result<unsigned> try_lock(std::int64_t key, const Statement* statement,
                                  std::optional<Rows>& rows) {
    const std::lock_guard held(mutex_);
    for (int tries = 0;; ++tries) {
      TRY(link_.connect());
      bool locked = false;
      auto found = statement
                       ? link_.query_after(fmt::format("select pg_try_advisory_lock({})", key),
                                           locked, statement->sql, statement->values)
                       : link_.query("select pg_try_advisory_lock(?)", std::vector<Value>{key});
      if (found && !statement) locked = found->front().truth(0);
      if (found && statement && locked) rows = std::move(*found);
      if (found) return locked ? link_.session() : 0u;
      if (locked && link_.connected()) unlock_now(key);
      if (link_.connected() || tries > 0) return found.error();
    }
  }
  void unlock(std::int64_t key, unsigned session) {
    const std::lock_guard held(mutex_);
    if (!link_.connected() || link_.session() != session) return;  // went with its session
    unlock_now(key);
  }
  void unlock_now(std::int64_t key) {
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
