/// The driver: one connection to a database, statements and answers. Knows SQL's dialect; nobody
/// else does.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include "core/result.hpp"
#include "db/store/value.hpp"

namespace store {

/// What a transaction may do. `write` waits for other writers first, so that it cannot fail
/// half-way for want of the lock.
enum class Access { read, write };

/// One connection, used by one thread at a time.
class Connection {
 public:
  Connection() = default;
  virtual ~Connection() = default;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Runs one statement with `?` placeholders. Errors: conflict (a unique or foreign key does not
  /// allow it), unavailable (locked by another process for too long), io (anything else, with the
  /// database's words).
  virtual core::Result<Rows> query(std::string_view sql, std::span<const Value> values) = 0;
  /// Runs several statements without values: a migration.
  virtual core::Result<void> script(std::string_view sql) = 0;
  virtual core::Result<void> begin(Access access) = 0;
  virtual core::Result<void> commit() = 0;
  /// Gives up the transaction, if there is one. Cannot fail: what was not committed is not there.
  virtual void rollback() noexcept = 0;
};

/// Opens (and for `write` makes) the SQLite database: WAL, synchronous FULL, foreign keys on, ten
/// seconds' patience with other processes. A connection for reading is refused every write by
/// SQLite itself. Errors: io, corrupt (not a database).
core::Result<std::unique_ptr<Connection>> open_sqlite(const std::filesystem::path& path,
                                                      Access access);

}  // namespace store
