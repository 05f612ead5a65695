/// The driver: one connection to a database, statements and answers. Knows SQL's dialect; nobody
/// else does. Two databases, one text: what SQLite and PostgreSQL both understand, with `?` for
/// values. What PostgreSQL alone needs stands in a comment, as `/*pg: for update skip locked */`,
/// whose inside only its driver reads.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "core/result.hpp"
#include "db/store/database/value.hpp"

namespace tractus::store {

/// What a transaction may do. `write` waits for other writers first, in every process, so that it
/// sees what they did and cannot fail half-way for want of the lock. `beside` writes without
/// waiting for them, where the database can (PostgreSQL); see Store::write_beside.
enum class Access { read, write, beside };

struct Table {
  std::string name;
  std::vector<std::string> columns;
};

/// One connection, used by one thread at a time.
class Connection {
 public:
  Connection() = default;
  virtual ~Connection() = default;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Runs one statement with `?` placeholders. Errors: conflict (a unique or foreign key does not
  /// allow it; the transaction can then only be given up), unavailable (locked by another process
  /// for too long, or the database cannot be reached), io (anything else, with the database's
  /// words).
  virtual core::Result<Rows> query(std::string_view sql, std::span<const Value> values) = 0;
  /// The same, row by row, with bounded memory; `seen` may end it with an Error. The connection
  /// must not run other statements meanwhile.
  virtual core::Result<void> each(std::string_view sql, std::span<const Value> values,
                                  const std::function<core::Result<void>(Row)>& seen) = 0;
  /// Runs several statements without values: a migration.
  virtual core::Result<void> script(std::string_view sql) = 0;
  virtual core::Result<void> begin(Access access) = 0;
  /// The tables and their columns in order, without the system tables of the database.
  virtual core::Result<std::vector<Table>> tables() = 0;
  /// Until the transaction ends, rows may refer to rows that come later. Call `check_references`
  /// before the commit.
  virtual core::Result<void> defer_references() = 0;
  virtual core::Result<void> check_references() = 0;
  virtual core::Result<void> commit() = 0;
  /// Rolls the transaction back, if there is one. Cannot fail: uncommitted changes are discarded
  /// anyway.
  virtual void rollback() noexcept = 0;
};

/// Opens (and for `write` makes) the SQLite database: WAL, synchronous FULL, foreign keys on, ten
/// seconds' patience with other processes. A connection for reading is refused every write by
/// SQLite itself. Errors: io, corrupt (not a database).
core::Result<std::unique_ptr<Connection>> open_sqlite(const std::filesystem::path& path,
                                                      Access access);

/// A connection to a PostgreSQL database by its address (postgresql://…, or libpq's words); made at
/// the first `begin`, and again when it broke. What the address leaves out, libpq takes from the
/// environment and PGPASSFILE. Reading is one unchanging state, READ ONLY; it begins with its
/// first statement, in one round trip. Errors come from `begin`, or from that statement:
/// unavailable; bad_input (an address it cannot read, a database that is not UTF-8).
std::unique_ptr<Connection> postgres_connection(const std::string& address, Access access);
/// Whether an address contains a password, so that the address must not be shown. False for an
/// invalid address.
bool has_password(const std::string& address);

}  // namespace tractus::store
