/// Names that one at a time may hold, among all threads of all processes that share a database: for
/// work on files, which no transaction covers.
#pragma once

#include <memory>
#include <string>

#include "core/result.hpp"

namespace tractus::store {

/// Held while it lives.
class NamedLock {
 public:
  NamedLock() = default;
  virtual ~NamedLock() = default;
  NamedLock(const NamedLock&) = delete;
  NamedLock& operator=(const NamedLock&) = delete;
};

/// Safe from several threads. A thread holds one name at a time.
class Locks {
 public:
  Locks() = default;
  virtual ~Locks() = default;
  Locks(const Locks&) = delete;
  Locks& operator=(const Locks&) = delete;
  /// Waits until nobody holds the name. Errors: unavailable: another process held it for ten
  /// seconds, or the database cannot be reached.
  virtual core::Result<std::unique_ptr<NamedLock>> hold(const std::string& name) = 0;
};

/// Among the threads of this process: for a database that one process serves.
std::unique_ptr<Locks> local_locks();
/// Among all processes on a PostgreSQL database. A process that dies, or is cut off from the
/// database, holds nothing any more: what is done under a lock must be right even then (a piece of
/// an upload is written where it belongs, twice or not).
std::unique_ptr<Locks> postgres_locks(const std::string& address);

}  // namespace tractus::store
