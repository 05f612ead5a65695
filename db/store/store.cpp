#include "db/store/store.hpp"

#include "core/require.hpp"
#include "core/try.hpp"
#include "db/store/database/migrations.hpp"
#include "db/store/operations/coverage.hpp"

namespace tractus {
namespace store {
namespace {

std::unique_ptr<Pool> pool_of(std::unique_ptr<Connection> one) {
  std::vector<std::unique_ptr<Connection>> all;
  all.push_back(std::move(one));
  return std::make_unique<Pool>(std::move(all));
}

std::unique_ptr<Pool> pool_of(const std::string& address, Access access, int count) {
  std::vector<std::unique_ptr<Connection>> all;
  for (int i = 0; i < count; ++i) all.push_back(postgres_connection(address, access));
  return std::make_unique<Pool>(std::move(all));
}

}  // namespace

Connection* Pool::take() {
  std::unique_lock held(mutex_);
  changed_.wait(held, [this] { return !free_.empty(); });
  Connection* taken = free_.back();
  free_.pop_back();
  return taken;
}

void Pool::give_back(Connection* connection) {
  {
    const std::lock_guard held(mutex_);
    free_.push_back(connection);
  }
  changed_.notify_one();
}

core::Result<Rows> Reading::query_with(std::string_view sql, std::span<const Value> values) {
  for (const Value& value : values)
    if (const auto* text = std::get_if<std::string>(&value); text && !is_text(*text))
      return core::Error{core::Errc::bad_input,
                         "a text is not UTF-8 or contains a zero byte: it cannot be stored"};
  return connection_.query(sql, values);
}

core::Result<Rows> Reading::query(std::string_view sql, std::initializer_list<Value> values) {
  return query_with(sql, std::span(values.begin(), values.size()));
}

core::Result<Rows> Writing::query(std::string_view sql, std::initializer_list<Value> values) {
  const CoveredTable* table = changed_table(sql);
  if (!table) return Reading::query(sql, values);
  auto rows = Reading::query(returning_keys(sql, *table), values);
  if (!rows) return rows;
  for (const Row& row : *rows) {
    std::vector<Value> key;
    for (std::size_t i = row.size() - table->keys.size(); i < row.size(); ++i)
      key.push_back(row.value(i));
    changed_.emplace(table, std::move(key));
  }
  return rows;
}

Store::Store(std::unique_ptr<Connection> reader, std::unique_ptr<Connection> writer)
    : readers_(pool_of(std::move(reader))), writers_(pool_of(std::move(writer))) {}

core::Result<Store> Store::open(const std::filesystem::path& path) {
  auto writer = TRY(open_sqlite(path, Access::write));
  if (auto done = migrate(*writer, migrations()); !done)
    return core::Error{done.error().code, path.string() + ": " + done.error().what};
  auto reader = TRY(open_sqlite(path, Access::read));
  return Store(std::move(reader), std::move(writer));
}

core::Result<Store> Store::open_postgres(const std::string& address) {
  constexpr int kReaders = 4, kBesides = 2;  // the threads that handle requests are four
  auto writer = postgres_connection(address, Access::write);
  TRY(migrate(*writer, migrations()));
  Store out(postgres_connection(address, Access::read), std::move(writer));
  out.readers_ = pool_of(address, Access::read, kReaders);
  out.besides_ = pool_of(address, Access::beside, kBesides);
  out.locks_ = postgres_locks(address);
  out.signals_ = postgres_signals(address);
  return out;
}

core::Result<void> Store::finish(Writing& tx, Access access, std::vector<Signals::Noted>& said) {
  core::require(access == Access::write || tx.changed_.empty(),
                "rows that the audit trail covers are changed by Store::write");
  auto changes = TRY(changes_text(tx, audit_key_, tx.changed_));
  TRY(note_act(tx, audit_key_, changes));
  if (tx.noted_.empty()) return {};
  said = std::move(tx.noted_);
  return signals_->committing(tx, said);
}

}  // namespace store
}  // namespace tractus
