/// Named locks among all threads of all processes that share a database: for work on files, which
/// no transaction covers.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "db/store/database/value.hpp"

namespace tractus::store {

/// Holds a name; the destructor releases it.
class NamedLock {
 public:
  NamedLock() = default;
  virtual ~NamedLock() = default;
  NamedLock(const NamedLock&) = delete;
  NamedLock& operator=(const NamedLock&) = delete;
};

/// A statement that reads, and its values.
struct Statement {
  std::string sql;
  std::vector<Value> values;
};

/// A held name, and what a statement found while it was held.
struct HeldRows {
  std::unique_ptr<NamedLock> lock;
  std::optional<Rows> rows;  ///< nothing: these locks do not know the database
};

/// Thread-safe. A thread may hold only one name at a time.
class Locks {
 public:
  Locks() = default;
  virtual ~Locks() = default;
  Locks(const Locks&) = delete;
  Locks& operator=(const Locks&) = delete;
  /// Waits until the name is free. Errors: unavailable: another process held the name for ten
  /// seconds, or the database cannot be reached.
  virtual core::Result<std::unique_ptr<NamedLock>> hold(const std::string& name) = 0;
  /// As `hold`; the statement sees what everybody did who held the name before. On PostgreSQL both
  /// are one round trip.
  virtual core::Result<HeldRows> hold_and_query(const std::string& name,
                                                const Statement& statement) = 0;
};

/// Locks among the threads of this process: for a database that only one process uses.
std::unique_ptr<Locks> local_locks();
/// Among all processes on a PostgreSQL database. A process that dies, or is cut off from the
/// database, holds nothing any more: what is done under a lock must be right even then (a piece of
/// an upload is written where it belongs, twice or not).
std::unique_ptr<Locks> postgres_locks(const std::string& address);

}  // namespace tractus::store
