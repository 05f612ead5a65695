/// One line to a PostgreSQL server, with what libpq needs known in one place. For the driver, the
/// signals and the locks on it; nobody else includes this.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/result.hpp"
#include "db/store/database/value.hpp"

struct pg_conn;
struct pg_result;

namespace tractus::store {

/// Used by one thread at a time. Connects when first asked to, and again when the connection broke.
class PostgresLink {
 public:
  explicit PostgresLink(std::string address);
  ~PostgresLink();
  PostgresLink(const PostgresLink&) = delete;
  PostgresLink& operator=(const PostgresLink&) = delete;

  /// Connects if need be. Errors: unavailable, bad_input.
  core::Result<void> connect();
  /// False: never connected, or the connection is known to be broken.
  bool connected() const;
  /// How often it connected: what a session holds (locks, LISTEN) is gone when this has changed.
  unsigned session() const { return session_; }

  /// One prepared statement with `?` placeholders; statements are kept for the session.
  core::Result<void> each(std::string_view sql, std::span<const Value> values,
                          const std::function<core::Result<void>(Row)>& seen);
  core::Result<Rows> query(std::string_view sql, std::span<const Value> values);
  /// The rows of a statement that is sent together with another one before it, in one round trip;
  /// `first` is what that one answers: one row with one truth. `first` is right even if the
  /// statement itself fails. The statement sees what was committed before the other one ended.
  core::Result<Rows> query_after(const std::string& first_sql, bool& first, std::string_view sql,
                                 std::span<const Value> values);
  /// Statements as they are; the answer is the last one's tag, as "COMMIT".
  core::Result<std::string> script(const std::string& sql);
  /// Sends this statement with the next one, in one round trip. That one connects if need be, and
  /// again if the connection turns out to be broken.
  void begin_with_next(std::string sql) { beginning_ = std::move(sql); }
  /// Whether it waits for the next one still; forgets it.
  bool forget_beginning() { return !std::exchange(beginning_, {}).empty(); }
  /// Sends this statement and waits for no answer: for one whose failure changes nothing.
  void send_off(const std::string& sql);
  bool in_transaction() const;

  struct Notification {
    std::string channel, payload;
  };
  /// Waits for notifications until some came or `wake_fd` can be read. Errors: unavailable: it
  /// broke.
  core::Result<std::vector<Notification>> notifications(int wake_fd);

 private:
  struct Closer {
    void operator()(pg_conn* connection) const;
    void operator()(pg_result* result) const;
  };
  using Result = std::unique_ptr<pg_result, Closer>;

  core::Result<void> set_up();
  core::Result<std::string> prepared(std::string_view sql, std::span<const Value> values);
  using Seen = std::function<core::Result<void>(Row)>;
  struct Arguments;
  core::Result<void> run(std::string_view sql, std::span<const Value> values, const Seen& seen);
  core::Result<void> run_after(const std::string& first_sql, Value& first, std::string_view sql,
                               std::span<const Value> values, const Seen& seen);
  core::Result<void> take(const pg_result* result, const Seen& seen);
  core::Result<std::string> execute(const std::string& sql);
  void settle();
  core::Error failure(const pg_result* result) const;

  std::string address_;
  std::unique_ptr<pg_conn, Closer> connection_;
  std::map<std::string, std::string, std::less<>> statements_;  ///< types and text → name
  unsigned session_ = 0;
  std::string beginning_;  ///< goes with the next statement
};

/// A statement as PostgreSQL reads it: `?` outside of quotes becomes $1, $2, …, and what stands in
/// `/*pg: … */` is laid open.
std::string postgres_text(std::string_view sql);

}  // namespace tractus::store
