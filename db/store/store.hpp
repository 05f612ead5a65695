/// Transactions: what reads and what writes are different types.
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

/// A transaction that sees one unchanging state and cannot change it. Lent by Store::read for the
/// length of a call.
class Reading {
 public:
  explicit Reading(Connection& connection) : connection_(connection) {}
  Reading(const Reading&) = delete;
  Reading& operator=(const Reading&) = delete;
  /// Errors: those of Connection::query; bad_input for a text that is not UTF-8 or holds a zero,
  /// which PostgreSQL does not take.
  core::Result<Rows> query(std::string_view sql, std::initializer_list<Value> values = {});
  core::Result<Rows> query_with(std::string_view sql, std::span<const Value> values);
  /// Row by row, in bounded memory. Errors: those of `seen` as well, which end it.
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

/// A transaction that may change things: all of it happens, or none. Lent by Store::write for the
/// length of a call.
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
  std::vector<Signals::Noted> noted_;  ///< said when this commits
  ChangedRows changed_;
};

/// The key of the audit trail's chain (audit.hpp).
using AuditKey = std::array<std::byte, 32>;
/// Notes the act of this thread (audit.hpp) when it has not been noted yet, and the digests of the
/// rows that this transaction changed, if there are any.
core::Result<void> note_act(Writing& tx, const AuditKey& key, const std::string& changes);
void act_was_noted() noexcept;
bool act_waits() noexcept;

/// Connections of one kind. Whoever finds none free waits.
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

/// One database. Safe from several threads; on PostgreSQL several processes may each have one. One
/// writes at a time, among all of them; who reads waits for no writer, nor makes one wait.
class Store {
 public:
  /// Opens or makes the SQLite database and brings its schema up to date. For one process.
  static core::Result<Store> open(const std::filesystem::path& path);
  /// Opens a PostgreSQL database, which must be there, and brings its schema up to date.
  static core::Result<Store> open_postgres(const std::string& address);
  /// Over given connections, already migrated: for tests.
  Store(std::unique_ptr<Connection> reader, std::unique_ptr<Connection> writer);

  /// Runs `work(Reading&)`, which returns a Result, and hands its answer through.
  template <std::invocable<Reading&> Work>
  std::invoke_result_t<Work, Reading&> read(Work&& work) {
    const Pool::Lent lent(*readers_);
    return in_transaction<Reading>(*lent, Access::read, std::forward<Work>(work));
  }

  /// Runs `work(Writing&)`, which returns a Result; commits when it and the commit succeed,
  /// otherwise nothing has happened and the Error says why. What is being done by whom
  /// (store::AuditScope) is noted in the audit trail, in the same transaction. No other write runs
  /// meanwhile, in any process: what it reads stays so until it is done.
  template <std::invocable<Writing&> Work>
  std::invoke_result_t<Work, Writing&> write(Work&& work) {
    return written(*writers_, Access::write, std::forward<Work>(work));
  }

  /// As `write`, but on PostgreSQL without waiting for other writes, nor making them wait: for what
  /// is right whatever others do meanwhile, and comes often: a change of one row by its key, with
  /// what it expects there in its `where`. What has to be audited is a `write` all the same.
  template <std::invocable<Writing&> Work>
  std::invoke_result_t<Work, Writing&> write_beside(Work&& work) {
    if (!besides_ || act_waits()) return write(std::forward<Work>(work));
    return written(*besides_, Access::beside, std::forward<Work>(work));
  }

  /// Keeps a name to oneself, among all processes on this database (locks.hpp). Not while holding
  /// another, nor within a transaction.
  core::Result<std::unique_ptr<NamedLock>> hold(const std::string& name) {
    return locks_->hold(name);
  }
  /// Whether other processes may work on this database at the same time.
  bool shared() const { return bool(besides_); }

  /// Words to and from the other processes on this database (signals.hpp).
  Signals& signals() { return *signals_; }

  /// Before anything is audited.
  void set_audit_key(const AuditKey& key) { audit_key_ = key; }
  const AuditKey& audit_key() const { return audit_key_; }

 private:
  /// What goes with every write: its row of the audit trail, and what it wants said.
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
