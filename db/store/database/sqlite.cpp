/// The one file that includes SQLite's header.
#include <fmt/format.h>
#include <sqlite3.h>

#include <map>

#include "core/require.hpp"
#include "core/try.hpp"
#include "db/store/database/connection.hpp"
#include "db/store/database/copy.hpp"

namespace tractus {
namespace store {
namespace {

constexpr int kPatience_ms = 10'000;

struct Closer {
  void operator()(sqlite3* db) const { sqlite3_close_v2(db); }
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, Closer>;

/// Resets a cached statement however its use ends.
class Use {
 public:
  explicit Use(sqlite3_stmt* statement) : statement_(statement) {}
  ~Use() {
    sqlite3_reset(statement_);
    sqlite3_clear_bindings(statement_);
  }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;

 private:
  sqlite3_stmt* statement_;
};

core::Errc cause_of(int code) {
  switch (code & 0xff) {
    case SQLITE_CONSTRAINT:
      return core::Errc::conflict;
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return core::Errc::unavailable;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return core::Errc::corrupt;
    default:
      return core::Errc::io;
  }
}

int bind(sqlite3_stmt* statement, int index, const Value& value) {
  struct Binder {
    sqlite3_stmt* statement;
    int index;
    int operator()(std::monostate) const { return sqlite3_bind_null(statement, index); }
    int operator()(std::int64_t v) const { return sqlite3_bind_int64(statement, index, v); }
    int operator()(double v) const { return sqlite3_bind_double(statement, index, v); }
    int operator()(const std::string& v) const {
      return sqlite3_bind_text64(statement, index, v.data(), v.size(), SQLITE_TRANSIENT,
                                 SQLITE_UTF8);
    }
    int operator()(const core::Bytes& v) const {
      const void* data = v.empty() ? static_cast<const void*>("") : v.data();
      return sqlite3_bind_blob64(statement, index, data, v.size(), SQLITE_TRANSIENT);
    }
  };
  return std::visit(Binder{statement, index}, value);
}

Value column(sqlite3_stmt* statement, int index) {
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement, index));
  switch (sqlite3_column_type(statement, index)) {
    case SQLITE_INTEGER:
      return std::int64_t{sqlite3_column_int64(statement, index)};
    case SQLITE_FLOAT:
      return sqlite3_column_double(statement, index);
    case SQLITE_TEXT:
      return std::string(reinterpret_cast<const char*>(sqlite3_column_text(statement, index)),
                         size);
    case SQLITE_BLOB: {
      const auto* data = static_cast<const std::byte*>(sqlite3_column_blob(statement, index));
      return data ? core::Bytes(data, data + size) : core::Bytes();
    }
    default:
      return {};
  }
}

class Sqlite final : public Connection {
 public:
  Sqlite(std::unique_ptr<sqlite3, Closer> db, std::string name)
      : db_(std::move(db)), name_(std::move(name)) {}

  core::Result<Rows> query(std::string_view sql, std::span<const Value> values) override {
    Rows rows;
    TRY(each(sql, values, [&](Row row) {
      rows.push_back(std::move(row));
      return core::Result<void>();
    }));
    return rows;
  }

  core::Result<void> each(std::string_view sql, std::span<const Value> values,
                          const std::function<core::Result<void>(Row)>& seen) override {
    auto prepared = TRY(prepare(sql));
    sqlite3_stmt* statement = prepared;
    const Use use(statement);
    core::require(sqlite3_bind_parameter_count(statement) == static_cast<int>(values.size()),
                  "a statement gets as many values as it has placeholders");
    for (std::size_t i = 0; i < values.size(); ++i)
      if (bind(statement, static_cast<int>(i + 1), values[i]) != SQLITE_OK) return failure();
    return each_row(statement, seen);
  }

  core::Result<void> script(std::string_view sql) override {
    if (sqlite3_exec(db_.get(), std::string(sql).c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
      return failure();
    return {};
  }

  core::Result<void> begin(Access access) override {
    return script(access == Access::read ? "begin" : "begin immediate");
  }
  core::Result<void> commit() override { return script("commit"); }
  core::Result<std::vector<Table>> tables() override {
    return tables_from(
        *this,
        "select m.name, c.name from sqlite_master m join pragma_table_info(m.name) c "
        "where m.type = 'table' and m.name not like 'sqlite_%' "
        "order by m.name, c.cid");
  }
  core::Result<void> defer_references() override {
    return script("pragma defer_foreign_keys = on");
  }
  core::Result<void> check_references() override { return {}; }  // at the commit
  void rollback() noexcept override {
    if (sqlite3_get_autocommit(db_.get()) == 0)
      sqlite3_exec(db_.get(), "rollback", nullptr, nullptr, nullptr);
  }

 private:
  core::Result<sqlite3_stmt*> prepare(std::string_view sql) {
    if (const auto known = cache_.find(sql); known != cache_.end()) return known->second.get();
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v3(db_.get(), sql.data(), static_cast<int>(sql.size()),
                           SQLITE_PREPARE_PERSISTENT, &statement, nullptr) != SQLITE_OK)
      return failure();
    cache_.emplace(sql, Statement(statement));
    return statement;
  }

  core::Result<void> each_row(sqlite3_stmt* statement,
                              const std::function<core::Result<void>(Row)>& seen) {
    while (true) {
      const int code = sqlite3_step(statement);
      if (code == SQLITE_DONE) return {};
      if (code != SQLITE_ROW) return failure();
      std::vector<Value> values;
      const int columns = sqlite3_column_count(statement);
      values.reserve(static_cast<std::size_t>(columns));
      for (int i = 0; i < columns; ++i) values.push_back(column(statement, i));
      TRY(seen(Row(std::move(values))));
    }
  }

  core::Error failure() const {
    return {cause_of(sqlite3_extended_errcode(db_.get())),
            fmt::format("{}: {}", name_, sqlite3_errmsg(db_.get()))};
  }

  std::unique_ptr<sqlite3, Closer> db_;  // outlives the statements: declared before them
  std::string name_;
  std::map<std::string, Statement, std::less<>> cache_;
};

}  // namespace

core::Result<std::unique_ptr<Connection>> open_sqlite(const std::filesystem::path& path,
                                                      Access access) {
  sqlite3* raw = nullptr;
  const int code =
      sqlite3_open_v2(path.c_str(), &raw,
                      SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX, nullptr);
  std::unique_ptr<sqlite3, Closer> db(raw);
  if (code != SQLITE_OK)
    return core::Error{cause_of(code),
                       fmt::format("{}: cannot open: {}", path.string(), sqlite3_errstr(code))};
  sqlite3_busy_timeout(raw, kPatience_ms);
  auto connection = std::make_unique<Sqlite>(std::move(db), path.string());
  auto set = connection->script(
      "pragma journal_mode = wal; pragma synchronous = full; pragma foreign_keys = on;");
  if (set && access == Access::read) set = connection->script("pragma query_only = on;");
  if (!set) return set.error();
  return std::unique_ptr<Connection>(std::move(connection));
}

}  // namespace store
}  // namespace tractus
