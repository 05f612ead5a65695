/// PostgreSQL behind the driver's interface.
#include <fmt/format.h>

#include "core/try.hpp"
#include "db/store/database/connection.hpp"
#include "db/store/database/copy.hpp"
#include "db/store/database/postgres_link.hpp"

namespace tractus {
namespace store {
namespace {

/// The number of the lock that writers of all processes stand in line for.
constexpr std::int64_t kWritersLock = 0x7472616374757301;  // "tractus", 1

class Postgres final : public Connection {
 public:
  Postgres(const std::string& address, Access most) : link_(address), most_(most) {}

  core::Result<Rows> query(std::string_view sql, std::span<const Value> values) override {
    return link_.query(sql, values);
  }
  core::Result<void> each(std::string_view sql, std::span<const Value> values,
                          const std::function<core::Result<void>(Row)>& seen) override {
    return link_.each(sql, values, seen);
  }
  core::Result<void> script(std::string_view sql) override {
    TRY(link_.script(std::string(sql)));
    return {};
  }

  core::Result<void> begin(Access access) override {
    reads_ = most_ == Access::read || access == Access::read;
    const std::string words = beginning(reads_ ? Access::read : access);
    if (reads_) return link_.begin_with_next(words), core::Result<void>();
    core::Result<std::string> begun =
        core::Error{core::Errc::unavailable, "PostgreSQL: the transaction could not begin"};
    // A connection that broke while nobody looked is only found out by using it.
    for (int tries = 0; tries < 2; ++tries) {
      const bool fresh = !link_.connected();
      TRY(link_.connect());
      begun = link_.script(words);
      if (begun) return {};
      if (fresh || link_.connected()) break;
    }
    rollback();
    return begun.error();
  }

  core::Result<void> commit() override {
    if (reads_) {  // it changed nothing: no answer is waited for
      if (!link_.forget_beginning()) link_.send_off("commit");
      return {};
    }
    auto done = TRY(link_.script("commit"));
    // A transaction in which a statement failed answers COMMIT with ROLLBACK, as a success.
    if (done == "COMMIT") return {};
    return core::Error{core::Errc::io, "PostgreSQL: a statement of the transaction had failed"};
  }

  core::Result<std::vector<Table>> tables() override {
    return tables_from(*this,
                       "select c.table_name::text, c.column_name::text from "
                       "information_schema.columns c join information_schema.tables t on "
                       "t.table_schema = c.table_schema and t.table_name = c.table_name where "
                       "t.table_type = 'BASE TABLE' and c.table_schema = current_schema() "
                       "order by c.table_name::text collate \"C\", c.ordinal_position");
  }
  core::Result<void> defer_references() override {
    TRY(alter_references("deferrable initially deferred"));
    return script("set constraints all deferred");
  }
  core::Result<void> check_references() override {
    TRY(script("set constraints all immediate"));
    return alter_references("not deferrable");
  }

  void rollback() noexcept override {
    link_.forget_beginning();
    if (link_.in_transaction()) (void)bool(link_.script("rollback"));
  }

 private:
  core::Result<void> alter_references(const std::string& how) {
    auto rows = TRY(link_.query(
        "select conrelid::regclass::text, conname::text from pg_constraint where contype = 'f' and "
        "connamespace = current_schema()::regnamespace",
        {}));
    for (const Row& row : rows) {
      TRY(script(
          fmt::format("alter table {} alter constraint {} {}", row.text(0), row.text(1), how)));
    }
    return {};
  }

  /// A write must not have a snapshot older than its lock, or it would not see what the writer
  /// before it did: READ COMMITTED takes a new one with every statement.
  static std::string beginning(Access access) {
    switch (access) {
      case Access::read:
        return "begin isolation level repeatable read read only";
      case Access::beside:
        return "begin isolation level read committed";
      case Access::write:
        break;
    }
    return fmt::format("begin isolation level read committed; select pg_advisory_xact_lock({})",
                       kWritersLock);
  }

  PostgresLink link_;
  Access most_;
  bool reads_ = false;  ///< the transaction that began last
};

}  // namespace

std::unique_ptr<Connection> postgres_connection(const std::string& address, Access access) {
  return std::make_unique<Postgres>(address, access);
}

}  // namespace store
}  // namespace tractus
