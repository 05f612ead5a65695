/// A PostgreSQL server of a test's own.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "db/store/database/connection.hpp"

namespace tractus::test_support {

/// Whether what is committed must outlast the server's death: only then does it flush to the disk.
enum class Durable { no, yes };

/// A folder to make others in: in memory for what need not last, where there is room; else /tmp,
/// for a socket's path must be short.
std::filesystem::path place_of(Durable durable);

/// A cluster made by initdb in a folder of its own under /tmp, listening on a Unix socket there and
/// nowhere else. When the test runs as root, it runs as `postgres`, or `nobody`, as it must. Ends
/// with this object, and with the test program however that ends.
class PostgresServer {
 public:
  /// Ends the test program with a line when PostgreSQL is not installed or does not start.
  explicit PostgresServer(Durable durable);
  ~PostgresServer();
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;

  /// Of one of its databases, as the user that owns it.
  std::string address(const std::string& database = "postgres") const;
  /// A new database's name, a copy of `of`.
  std::string add_database(const std::string& of = "template0");
  void drop_database(const std::string& name);
  const std::filesystem::path& folder() const { return folder_; }

 private:
  void start();
  void stop(int signal);
  /// Statements outside of any transaction.
  void run(const std::string& sql);
  std::filesystem::path programs_, folder_;
  std::vector<std::string> settings_;
  uid_t user_ = 0;
  gid_t group_ = 0;
  pid_t pid_ = -1;
  int made_ = 0;
  std::unique_ptr<store::Connection> line_;  ///< kept: a session is dear to begin
};

/// The one of this test program, made when first asked for; not durable.
PostgresServer& postgres_server();

}  // namespace tractus::test_support
