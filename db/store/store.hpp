/// Transactions: what reads and what writes are different types.
#pragma once

#include <array>
#include <concepts>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <mutex>
#include <type_traits>

#include "db/store/connection.hpp"
#include "db/store/signals.hpp"

namespace store {

/// A transaction that sees one unchanging state and cannot change it. Lent by Store::read for the
/// length of a call.
class Reading {
 public:
  explicit Reading(Connection& connection) : connection_(connection) {}
  Reading(const Reading&) = delete;
  Reading& operator=(const Reading&) = delete;
  core::Result<Rows> query(std::string_view sql, std::initializer_list<Value> values = {}) {
    return connection_.query(sql, std::span(values.begin(), values.size()));
  }

 private:
  Connection& connection_;
};

/// A transaction that may change things: all of it happens, or none. Lent by Store::write for the
/// length of a call.
class Writing : public Reading {
 public:
  using Reading::Reading;

 private:
  friend class Store;
  friend core::Result<void> notify(Writing& tx, const std::string& channel,
                                   const std::string& payload);
  std::vector<Signals::Noted> noted_;  ///< said when this commits
};

/// The key of the audit trail's chain (audit.hpp).
using AuditKey = std::array<std::byte, 32>;
/// Notes the act of this thread (audit.hpp) that has not been noted yet, if there is one.
core::Result<void> note_act(Writing& tx, const AuditKey& key);
void act_was_noted() noexcept;

/// One database. Safe from several threads: one writes at a time, one reads at a time, neither
/// waits for the other.
class Store {
 public:
  /// Opens or makes the database and brings its schema up to date.
  static core::Result<Store> open(const std::filesystem::path& path);
  /// Over given connections, already migrated: for tests.
  Store(std::unique_ptr<Connection> reader, std::unique_ptr<Connection> writer);

  /// Runs `work(Reading&)`, which returns a Result, and hands its answer through.
  template <std::invocable<Reading&> Work>
  std::invoke_result_t<Work, Reading&> read(Work&& work) {
    const std::lock_guard held(reader_->mutex);
    return in_transaction<Reading>(*reader_->connection, Access::read, std::forward<Work>(work));
  }

  /// Runs `work(Writing&)`, which returns a Result; commits when it and the commit succeed,
  /// otherwise nothing has happened and the Error says why. What is being done by whom
  /// (store::Acting) is noted in the audit trail, in the same transaction.
  template <std::invocable<Writing&> Work>
  std::invoke_result_t<Work, Writing&> write(Work&& work) {
    using Answer = std::invoke_result_t<Work, Writing&>;
    std::vector<Signals::Noted> said;
    const std::lock_guard held(writer_->mutex);
    auto answer =
        in_transaction<Writing>(*writer_->connection, Access::write, [&](Writing& tx) -> Answer {
          auto done = work(tx);
          if (!done) return done;
          if (auto ready = finish(tx, said); !ready) return ready.error();
          return done;
        });
    if (!answer) return answer;
    act_was_noted();
    if (!said.empty()) signals_->committed(said);
    return answer;
  }

  /// Words to and from the other processes on this database (signals.hpp).
  Signals& signals() { return *signals_; }

  /// Before anything is audited.
  void set_audit_key(const AuditKey& key) { audit_key_ = key; }
  const AuditKey& audit_key() const { return audit_key_; }

 private:
  /// What goes with every write: its row of the audit trail, and what it wants said.
  core::Result<void> finish(Writing& tx, std::vector<Signals::Noted>& said);

  struct Guarded {
    std::mutex mutex;  ///< guards the connection
    std::unique_ptr<Connection> connection;
  };

  template <class Transaction, class Work>
  static std::invoke_result_t<Work, Transaction&> in_transaction(Connection& connection,
                                                                 Access access, Work&& work) {
    if (auto begun = connection.begin(access); !begun) return begun.error();
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

  std::unique_ptr<Guarded> reader_, writer_;
  std::unique_ptr<Signals> signals_ = local_signals();
  AuditKey audit_key_{};
};

}  // namespace store
