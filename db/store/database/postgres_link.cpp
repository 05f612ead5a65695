/// The one file that includes libpq's header.
#include "db/store/database/postgres_link.hpp"

#include <endian.h>
#include <fmt/format.h>
#include <libpq-fe.h>
#include <poll.h>

#include <bit>
#include <cstring>

#include "core/require.hpp"
#include "core/try.hpp"
#include "db/store/database/connection.hpp"

namespace tractus {
namespace store {
namespace {

/// Types by their fixed numbers (catalog/pg_type.dat of PostgreSQL's source).
enum Type : Oid {
  kBool = 16,
  kBytea = 17,
  kName = 19,
  kInt8 = 20,
  kInt2 = 21,
  kInt4 = 23,
  kText = 25,
  kFloat4 = 700,
  kFloat8 = 701,
  kVarchar = 1043,
  kVoid = 2278,
};
constexpr int kBinary = 1;

Oid type_of(const Value& value) {
  constexpr Oid kTypes[] = {0, kInt8, kFloat8, kText, kBytea};
  return kTypes[value.index()];
}

/// One value as the server takes it in binary.
struct Bound {
  std::uint64_t number = 0;
  const char* data = nullptr;  ///< null for null
  int size = 0;

  void set(const Value& value) {
    if (const auto* whole = std::get_if<std::int64_t>(&value))
      set_number(static_cast<std::uint64_t>(*whole));
    else if (const auto* real = std::get_if<double>(&value))
      set_number(std::bit_cast<std::uint64_t>(*real));
    else if (const auto* text = std::get_if<std::string>(&value))
      set_bytes(text->data(), text->size());
    else if (const auto* bytes = std::get_if<core::Bytes>(&value))
      set_bytes(bytes->data(), bytes->size());
  }

 private:
  void set_number(std::uint64_t native) {
    number = htobe64(native);
    set_bytes(&number, sizeof number);
  }
  void set_bytes(const void* bytes, std::size_t count) {
    data = count ? static_cast<const char*>(bytes) : "";  // a null pointer would be null
    size = static_cast<int>(count);
  }
};

template <class T>
T big_endian(const char* data) {
  std::make_unsigned_t<T> out = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i)
    out = static_cast<std::make_unsigned_t<T>>((out << 8) | static_cast<unsigned char>(data[i]));
  return static_cast<T>(out);
}

core::Result<Value> column(const PGresult* result, int index) {
  if (PQgetisnull(result, 0, index)) return Value();
  const char* data = PQgetvalue(result, 0, index);
  const auto size = static_cast<std::size_t>(PQgetlength(result, 0, index));
  switch (PQftype(result, index)) {
    case kInt8:
      return Value(big_endian<std::int64_t>(data));
    case kInt4:
      return Value(std::int64_t{big_endian<std::int32_t>(data)});
    case kInt2:
      return Value(std::int64_t{big_endian<std::int16_t>(data)});
    case kBool:
      return Value(std::int64_t{*data != 0});
    case kFloat8:
      return Value(std::bit_cast<double>(big_endian<std::int64_t>(data)));
    case kFloat4:
      return Value(double{std::bit_cast<float>(big_endian<std::int32_t>(data))});
    case kText:
    case kVarchar:
    case kName:
      return Value(std::string(data, size));
    case kBytea: {
      const auto* bytes = reinterpret_cast<const std::byte*>(data);
      return Value(core::Bytes(bytes, bytes + size));
    }
    case kVoid:
      return Value();
    default:
      return core::Error{core::Errc::io,
                         fmt::format("column {} has type {}: cast it", PQfname(result, index),
                                     PQftype(result, index))};
  }
}

/// By SQLSTATE (PostgreSQL's manual, appendix A).
core::Errc cause_of(const std::string& state) {
  if (state.starts_with("23")) return core::Errc::conflict;
  for (const char* busy : {"08", "40", "55P03", "57P", "57014", "53300", "25P03"})
    if (state.starts_with(busy)) return core::Errc::unavailable;
  if (state == "22021" || state == "22P05") return core::Errc::bad_input;
  if (state.starts_with("XX00")) return core::Errc::corrupt;
  return core::Errc::io;
}

std::string one_line(const char* words) {
  std::string out(words ? words : "");
  while (!out.empty() && (out.back() == '\n' || out.back() == ' ')) out.pop_back();
  for (char& c : out)
    if (c == '\n' || c == '\t') c = ' ';
  return out;
}

}  // namespace

std::string postgres_text(std::string_view sql) {
  constexpr std::string_view kOpen = "/*pg:", kClose = "*/";
  std::string out;
  int placeholders = 0;
  bool laid_open = false;
  for (std::size_t i = 0; i < sql.size(); ++i) {
    if (sql[i] == '\'') {
      const auto end = sql.find('\'', i + 1);
      core::require(end != std::string_view::npos, "a quote in a statement is closed");
      out += sql.substr(i, end - i + 1);
      i = end;
    } else if (sql.substr(i).starts_with(kOpen)) {
      laid_open = true;
      i += kOpen.size() - 1;
    } else if (laid_open && sql.substr(i).starts_with(kClose)) {
      laid_open = false;
      i += kClose.size() - 1;
    } else if (sql[i] == '?') {
      out += fmt::format("${}", ++placeholders);
    } else {
      out += sql[i];
    }
  }
  return out;
}

bool has_password(const std::string& address) {
  PQconninfoOption* options = PQconninfoParse(address.c_str(), nullptr);
  bool found = false;
  for (const PQconninfoOption* o = options; o && o->keyword; ++o)
    found = found || (std::string_view(o->keyword) == "password" && o->val && *o->val);
  PQconninfoFree(options);
  return found;
}

void PostgresLink::Closer::operator()(pg_conn* connection) const { PQfinish(connection); }
void PostgresLink::Closer::operator()(pg_result* result) const { PQclear(result); }

PostgresLink::PostgresLink(std::string address) : address_(std::move(address)) {}
PostgresLink::~PostgresLink() = default;

bool PostgresLink::connected() const {
  return connection_ && PQstatus(connection_.get()) == CONNECTION_OK;
}

bool PostgresLink::in_transaction() const {
  return connected() && PQtransactionStatus(connection_.get()) != PQTRANS_IDLE;
}

core::Result<void> PostgresLink::connect() {
  if (connected()) return {};
  // Before the address, so that it may say otherwise; a peer that is silent for half a minute is
  // given up.
  const char* names[] = {"connect_timeout",  "keepalives_idle",  "keepalives_interval",
                         "keepalives_count", "tcp_user_timeout", "fallback_application_name",
                         "dbname",           "client_encoding",  nullptr};
  const char* values[] = {"10",   "10",   "5", "3", "30000", "tractus", address_.c_str(),
                          "UTF8", nullptr};
  statements_.clear();
  connection_.reset(PQconnectdbParams(names, values, 1));
  if (!connection_) return core::Error{core::Errc::unavailable, "PostgreSQL: no memory"};
  if (PQstatus(connection_.get()) != CONNECTION_OK) {
    core::Error error{core::Errc::unavailable,
                      "PostgreSQL: " + one_line(PQerrorMessage(connection_.get()))};
    connection_.reset();
    return error;
  }
  ++session_;
  return set_up();
}

core::Result<void> PostgresLink::set_up() {
  PQsetNoticeProcessor(
      connection_.get(), [](void*, const char*) {}, nullptr);
  const char* encoding = PQparameterStatus(connection_.get(), "server_encoding");
  if (!encoding || std::string_view(encoding) != "UTF8") {
    core::Error error{core::Errc::bad_input,
                      fmt::format("PostgreSQL: the database's encoding is {}, UTF8 is expected",
                                  encoding ? encoding : "unknown")};
    connection_.reset();
    return error;
  }
  // Who waits for a lock, or stops in the middle of a transaction, does not do so for ever; a
  // commit is on the disk when it is answered, whatever the server's default is.
  // A statement sees what was committed before it began, unless its transaction says otherwise.
  TRY(execute(
      "set default_transaction_isolation = 'read committed'; set lock_timeout = '10s'; set "
      "idle_in_transaction_session_timeout = '60s'; "
      "select set_config('synchronous_commit', 'on', false) "
      "where current_setting('synchronous_commit') = 'off'; "
      "set tcp_keepalives_idle = 10; set tcp_keepalives_interval = 5; set tcp_keepalives_count = "
      "3"));
  return {};
}

core::Error PostgresLink::failure(const pg_result* result) const {
  const char* state = result ? PQresultErrorField(result, PG_DIAG_SQLSTATE) : nullptr;
  const std::string words =
      one_line(result ? PQresultErrorMessage(result) : PQerrorMessage(connection_.get()));
  if (!connected()) return {core::Errc::unavailable, "PostgreSQL: " + words};
  return {state ? cause_of(state) : core::Errc::io, "PostgreSQL: " + words};
}

core::Result<std::string> PostgresLink::prepared(std::string_view sql,
                                                 std::span<const Value> values) {
  std::vector<Oid> types;
  std::string key;
  for (const Value& value : values) {
    types.push_back(type_of(value));
    key += static_cast<char>('0' + value.index());
  }
  key += ' ';
  key += sql;
  if (const auto known = statements_.find(key); known != statements_.end()) return known->second;
  const std::string name = fmt::format("s{}", statements_.size());
  const Result result(PQprepare(connection_.get(), name.c_str(), postgres_text(sql).c_str(),
                                static_cast<int>(types.size()), types.data()));
  if (PQresultStatus(result.get()) != PGRES_COMMAND_OK) return failure(result.get());
  statements_.emplace(std::move(key), name);
  return name;
}

/// The values of a statement as libpq takes them.
struct PostgresLink::Arguments {
  explicit Arguments(std::span<const Value> values)
      : bound(values.size()), formats(values.size(), kBinary) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      bound[i].set(values[i]);
      data.push_back(bound[i].data);
      sizes.push_back(bound[i].size);
    }
  }
  bool send(pg_conn* connection, const std::string& name) const {
    return PQsendQueryPrepared(connection, name.c_str(), static_cast<int>(bound.size()),
                               data.data(), sizes.data(), formats.data(), kBinary) == 1;
  }
  std::vector<Bound> bound;
  std::vector<const char*> data;
  std::vector<int> sizes, formats;
};

core::Result<void> PostgresLink::each(std::string_view sql, std::span<const Value> values,
                                      const Seen& seen) {
  if (beginning_.empty()) return run(sql, values, seen);
  // A connection that broke while nobody looked is only found out by using it.
  for (int tries = 0;; ++tries) {
    const bool fresh = !connected();
    core::Result<void> outcome = connect();
    bool any = false;
    Value begun;
    if (outcome)
      outcome = run_after(beginning_, begun, sql, values,
                          [&](Row row) { return any = true, seen(std::move(row)); });
    if (outcome || fresh || any || connected() || tries > 0) return forget_beginning(), outcome;
  }
}

core::Result<void> PostgresLink::run(std::string_view sql, std::span<const Value> values,
                                     const Seen& seen) {
  settle();
  if (!connected()) return core::Error{core::Errc::unavailable, "PostgreSQL: the connection broke"};
  auto name = TRY(prepared(sql, values));
  if (!Arguments(values).send(connection_.get(), name)) return failure(nullptr);
  PQsetSingleRowMode(connection_.get());
  core::Result<void> outcome;
  while (const Result result{PQgetResult(connection_.get())})
    if (outcome) outcome = take(result.get(), seen);  // else the rest is taken off the line
  return outcome;
}

/// By libpq's pipeline mode (PostgreSQL's manual, 34.5): both are sent, then both are answered.
/// `first` becomes the value that the first one answers with, if it answers with a row.
core::Result<void> PostgresLink::run_after(const std::string& first_sql, Value& first,
                                           std::string_view sql, std::span<const Value> values,
                                           const Seen& seen) {
  settle();
  auto name = TRY(prepared(sql, values));
  pg_conn* line = connection_.get();
  if (PQenterPipelineMode(line) != 1 ||
      PQsendQueryParams(line, first_sql.c_str(), 0, nullptr, nullptr, nullptr, nullptr, kBinary) !=
          1 ||
      !Arguments(values).send(line, name) || PQpipelineSync(line) != 1) {
    const core::Error error{core::Errc::unavailable, failure(nullptr).what};
    connection_.reset();  // half of it may be on its way
    return error;
  }
  core::Result<void> outcome;
  const Seen ignored = [](const Row&) { return core::Result<void>(); };
  for (int answered = 0; connected();) {
    const Result result(PQgetResult(line));
    if (!result && ++answered == 1) PQsetSingleRowMode(line);  // of the one that comes now
    if (!result) continue;
    if (PQresultStatus(result.get()) == PGRES_PIPELINE_SYNC) break;
    if (answered == 0 && PQntuples(result.get()) == 1)
      if (auto value = column(result.get(), 0)) first = std::move(*value);
    // The mode of the statement before the pipeline may still hold for the first.
    if (outcome) outcome = take(result.get(), answered == 0 ? ignored : seen);
  }
  if (outcome && !connected()) return failure(nullptr);
  if (connected()) PQexitPipelineMode(line);
  return outcome;
}

/// One answer: a row, the end of the rows, or what was wrong.
core::Result<void> PostgresLink::take(const pg_result* result, const Seen& seen) {
  const ExecStatusType status = PQresultStatus(result);
  if (status == PGRES_TUPLES_OK || status == PGRES_COMMAND_OK) return {};
  if (status != PGRES_SINGLE_TUPLE) return failure(result);
  std::vector<Value> values;
  for (int i = 0; i < PQnfields(result); ++i) {
    auto value = TRY(column(result, i));
    values.push_back(std::move(value));
  }
  return seen(Row(std::move(values)));
}

void PostgresLink::send_off(const std::string& sql) {
  settle();
  if (connected()) PQsendQuery(connection_.get(), sql.c_str());
}

/// Takes the answers to what was sent off.
void PostgresLink::settle() {
  if (!connected()) return;
  while (const Result result{PQgetResult(connection_.get())}) {
  }
}

core::Result<Rows> PostgresLink::query(std::string_view sql, std::span<const Value> values) {
  Rows rows;
  TRY(each(sql, values, [&](Row row) {
    rows.push_back(std::move(row));
    return core::Result<void>();
  }));
  return rows;
}

core::Result<Rows> PostgresLink::query_after(const std::string& first_sql, bool& first,
                                             std::string_view sql, std::span<const Value> values) {
  Rows rows;
  Value answered;
  const auto done = run_after(first_sql, answered, sql, values, [&](Row row) {
    rows.push_back(std::move(row));
    return core::Result<void>();
  });
  const auto* truth = std::get_if<std::int64_t>(&answered);
  first = truth && *truth != 0;
  if (!done) return done.error();
  return rows;
}

core::Result<std::string> PostgresLink::script(const std::string& sql) {
  if (beginning_.empty()) return execute(sql);
  TRY(connect());
  return execute(std::exchange(beginning_, {}) + "; " + sql);
}

core::Result<std::string> PostgresLink::execute(const std::string& sql) {
  settle();
  if (!connected()) return core::Error{core::Errc::unavailable, "PostgreSQL: the connection broke"};
  const Result result(PQexec(connection_.get(), sql.c_str()));
  const ExecStatusType status = PQresultStatus(result.get());
  if (status != PGRES_COMMAND_OK && status != PGRES_TUPLES_OK && status != PGRES_EMPTY_QUERY)
    return failure(result.get());
  return std::string(PQcmdStatus(result.get()));
}

core::Result<std::vector<PostgresLink::Notification>> PostgresLink::notifications(int wake_fd) {
  std::vector<Notification> out;
  while (connected()) {
    while (PGnotify* one = PQnotifies(connection_.get())) {
      out.push_back({one->relname, one->extra});
      PQfreemem(one);
    }
    if (!out.empty()) return out;
    pollfd waits[] = {{PQsocket(connection_.get()), POLLIN, 0}, {wake_fd, POLLIN, 0}};
    if (::poll(waits, 2, -1) < 0 && errno != EINTR) break;
    if (waits[1].revents) return out;
    if (PQconsumeInput(connection_.get()) != 1) break;
  }
  return core::Error{core::Errc::unavailable, "PostgreSQL: the connection broke"};
}

}  // namespace store
}  // namespace tractus
