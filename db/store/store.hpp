/// Transactions: reading and writing transactions have different types.
#pragma once

#include <array>
#include <concepts>
#include <condition_variable>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <type_traits>

#include "core/try.hpp"
#include "db/store/database/connection.hpp"
#include "db/store/database/locks.hpp"
#include "db/store/database/signals.hpp"

namespace tractus::store {

/// A read-only transaction on one snapshot of the database. Store::read lends it for the duration
/// of a call.
class Reading {
 public:
  explicit Reading(Connection& connection) : connection_(connection) {}
  Reading(const Reading&) = delete;
  Reading& operator=(const Reading&) = delete;
  /// Errors: those of Connection::query; bad_input for a text that is not UTF-8 or contains a zero
  /// byte, which PostgreSQL does not accept.
  core::Result<Rows> query(std::string_view sql, std::initializer_list<Value> values = {});
  core::Result<Rows> query_with(std::string_view sql, std::span<const Value> values);
  /// Calls `seen` with each row, with bounded memory. An error of `seen` ends the query and is
  /// returned.
  core::Result<void> each(std::string_view sql,
                          const std::function<core::Result<void>(Row)>& seen) {
    return connection_.each(sql, {}, seen);
  }
  core::Result<std::vector<Table>> tables() { return connection_.tables(); }

 protected:
  Connection& connection_;
};

struct CoveredTable;  // coverage.hpp
/// Keys of rows that a transaction has changed in tables that the audit trail covers.
using ChangedRows = std::set<std::pair<const CoveredTable*, std::vector<Value>>>;

/// A writing transaction, which is atomic. Store::write lends it for the duration of a call.
class Writing : public Reading {
 public:
  using Reading::Reading;
  /// As Reading::query. A statement that changes rows of a covered table must begin with "insert
  /// into", "update" or "delete from"; the answer's rows then end with the keys of those rows.
  core::Result<Rows> query(std::string_view sql, std::initializer_list<Value> values = {});

 private:
  friend class Store;
  friend core::Result<std::uint64_t> copy_rows(Reading& from, Writing& to);
  friend core::Result<void> notify(Writing& tx, const std::string& channel,
                                   const std::string& payload);
  std::vector<Signals::Noted> noted_;  ///< signals that are sent when this transaction commits
  ChangedRows changed_;
};

/// The key of the audit trail's chain (audit.hpp).
using AuditKey = std::array<std::byte, 32>;
/// Writes the action of this thread (audit.hpp) into the audit trail, if it is not written yet, and
/// the digests of the rows that this transaction changed, if there are any.
core::Result<void> note_act(Writing& tx, const AuditKey& key, const std::string& changes);
void act_was_noted() noexcept;
bool act_waits() noexcept;

/// A pool of connections of one kind. A caller waits until a connection is free.
class Pool {
 public:
  explicit Pool(std::vector<std::unique_ptr<Connection>> connections)
      : all_(std::move(connections)) {
    for (const auto& one : all_) free_.push_back(one.get());
  }
  class Lent {
   public:
    explicit Lent(Pool& pool) : pool_(pool), connection_(pool.take()) {}
    ~Lent() { pool_.give_back(connection_); }
    Lent(const Lent&) = delete;
    Lent& operator=(const Lent&) = delete;
    Connection& operator*() const { return *connection_; }

   private:
    Pool& pool_;
    Connection* connection_;
  };

 private:
  Connection* take();
  void give_back(Connection* connection);
  std::vector<std::unique_ptr<Connection>> all_;
  std::mutex mutex_;  ///< guards free_
  std::condition_variable changed_;
  std::vector<Connection*> free_;
};

/// One database. Thread-safe; on PostgreSQL several processes may each have a Store. Only one write
/// transaction runs at a time, among all processes; readers and writers do not block each other.
class Store {
 public:
  /// Opens or creates the SQLite database and migrates its schema. For one process.
  static core::Result<Store> open(const std::filesystem::path& path);
  /// Opens a PostgreSQL database, which must exist, and migrates its schema.
  static core::Result<Store> open_postgres(const std::string& address);
  /// Uses given connections to a migrated database: for tests.
  Store(std::unique_ptr<Connection> reader, std::unique_ptr<Connection> writer);

  /// Runs `work(Reading&)`, which returns a Result, and returns this Result.
  template <std::invocable<Reading&> Work>
  std::invoke_result_t<Work, Reading&> read(Work&& work) {
    const Pool::Lent lent(*readers_);
    return in_transaction<Reading>(*lent, Access::read, std::forward<Work>(work));
  }

  /// Runs `work(Writing&)`, which returns a Result, and commits if it succeeds; on an error nothing
  /// is changed. The action of the current store::AuditScope is written into the audit trail in the
  /// same transaction. No other write transaction runs meanwhile, in any process, so that the data
  /// that `work` reads do not change.
  template <std::invocable<Writing&> Work>
  std::invoke_result_t<Work, Writing&> write(Work&& work) {
    return written(*writers_, Access::write, std::forward<Work>(work));
  }

  /// Like `write`, but on PostgreSQL it does not wait for other writes and does not make them wait.
  /// For frequent changes that are correct whatever other transactions do: a change of one row by
  /// its key, with the expected old values in its `where`. An audited change runs as `write`
  /// nevertheless.
  template <std::invocable<Writing&> Work>
  std::invoke_result_t<Work, Writing&> write_beside(Work&& work) {
    if (!besides_ || act_waits()) return write(std::forward<Work>(work));
    return written(*besides_, Access::beside, std::forward<Work>(work));
  }

  /// Locks a name among all processes on this database (locks.hpp). Must not be called while
  /// holding another name, nor within a transaction.
  core::Result<std::unique_ptr<NamedLock>> hold(const std::string& name) {
    return locks_->hold(name);
  }
  /// As `hold`, and what a statement then finds (Locks::hold_and_query).
  core::Result<std::pair<std::unique_ptr<NamedLock>, Rows>> hold_and_query(
      const std::string& name, const Statement& statement) {
    auto held = TRY(locks_->hold_and_query(name, statement));
    if (!held.rows)
      held.rows =
          TRY(read([&](Reading& tx) { return tx.query_with(statement.sql, statement.values); }));
    return std::pair(std::move(held.lock), std::move(*held.rows));
  }
  /// Whether other processes may work on this database at the same time.
  bool shared() const { return bool(besides_); }

  /// Signals to and from the other processes on this database (signals.hpp).
  Signals& signals() { return *signals_; }

  /// Must be called before the first audited change.
  void set_audit_key(const AuditKey& key) { audit_key_ = key; }
  const AuditKey& audit_key() const { return audit_key_; }

 private:
  /// Completes every write: adds its row of the audit trail and its signals.
  core::Result<void> finish(Writing& tx, Access access, std::vector<Signals::Noted>& said);

  template <class Work>
  std::invoke_result_t<Work, Writing&> written(Pool& pool, Access access, Work&& work) {
    using Answer = std::invoke_result_t<Work, Writing&>;
    std::vector<Signals::Noted> said;
    const Pool::Lent lent(pool);
    auto answer = in_transaction<Writing>(*lent, access, [&](Writing& tx) -> Answer {
      auto done = work(tx);
      if (!done) return done;
      TRY(finish(tx, access, said));
      return done;
    });
    if (!answer) return answer;
    act_was_noted();
    if (!said.empty()) signals_->committed(said);
    return answer;
  }

  template <class Transaction, class Work>
  static std::invoke_result_t<Work, Transaction&> in_transaction(Connection& connection,
                                                                 Access access, Work&& work) {
    TRY(connection.begin(access));
    Transaction transaction(connection);
    auto answer = work(transaction);
    if (!answer) {
      connection.rollback();
      return answer;
    }
    if (auto committed = connection.commit(); !committed) {
      connection.rollback();
      return committed.error();
    }
    return answer;
  }

  std::unique_ptr<Pool> readers_, writers_;
  std::unique_ptr<Pool> besides_;  ///< none: SQLite has one writer at a time anyway
  std::unique_ptr<Locks> locks_ = local_locks();
  std::unique_ptr<Signals> signals_ = local_signals();
  AuditKey audit_key_{};
};

}  // namespace tractus::store
