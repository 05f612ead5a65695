/// The real server as a child process, and a client that speaks to it.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "db/store/database/connection.hpp"
#include "tests/support/database/database.hpp"

namespace tractus::world {

struct Ended {
  int code;         ///< exit code; -1 when a signal ended it
  std::string out;  ///< standard output and error together
};
/// Runs a program of ours to its end.
Ended run_program(const std::string& name, const std::vector<std::string>& arguments);

struct Answer {
  int status = 0;                              ///< 0: no answer, the connection broke
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string body;
  core::Json json() const { return core::Json::parse(body, nullptr, false); }
};

using Headers = std::map<std::string, std::string>;

/// One keep-alive connection, reopened when it breaks.
class Client {
 public:
  Client();
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  void speak_to(int port) { port_ = port; }
  /// Connects from another of this machine's own addresses, as "127.0.1.7".
  void come_from(const std::string& address) { from_ = address; }
  /// By TLS, to a server whose certificate is of this authority.
  void trust(const std::filesystem::path& authority) { authority_ = authority; }
  /// The path is sent as it is, "/../x" too.
  Answer ask(const std::string& method, const std::string& path, const Headers& headers = {},
             const std::string& body = "");

 private:
  void* curl_;
  int port_ = 0;
  std::filesystem::path authority_;
  std::string from_;
};

enum class Transport { plain, tls };

/// `tractus-server serve` on a free port. Killed when it goes.
class ServerProcess {
 public:
  /// Waits for its line "listening on"; fails the test when it does not come.
  explicit ServerProcess(const std::filesystem::path& data, std::vector<std::string> more = {},
                         Transport transport = Transport::plain);
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;
  int port() const { return port_; }
  pid_t pid() const { return pid_; }
  void kill_now();
  /// SIGTERM, then waits; its exit code. All that it printed, but the line
  /// with the address it listens on, is then in `output`.
  int stop();
  const std::string& output() const { return said_; }
  /// Largest resident memory so far, bytes.
  std::size_t peak_memory_bytes() const;

 private:
  pid_t pid_ = -1;
  int port_ = 0;
  int output_ = -1;
  std::string said_;
};

/// What an open socket sends back until it is closed, or nothing more comes for `patience_ms`.
struct RawAnswer {
  std::string text;
  bool closed = false;
};
/// Sends bytes as they are over a connection of their own.
RawAnswer send_raw(int port, const std::string& bytes, int patience_ms);

/// A data folder with account "admin" (kPassword), stations "station-1" and "station-2", and one
/// published case.
struct ServedWorld {
  /// Its records in a PostgreSQL database of its own when the environment asks for that
  /// (test_support::database_kind), else in the folder.
  ServedWorld();
  /// Its records in this PostgreSQL database, which must be empty.
  explicit ServedWorld(const std::string& address);
  ~ServedWorld();
  ServedWorld(const ServedWorld&) = delete;
  ServedWorld& operator=(const ServedWorld&) = delete;

  static constexpr const char* kPassword = "a password of a test";
  std::filesystem::path folder, data;
  std::string case_id;
  Headers station_1, station_2;  ///< their credentials

 private:
  void begin();
  void read();
  std::unique_ptr<test_support::TestDatabase> database_;
  std::string address_;  ///< empty: SQLite

 public:
  /// To its records, behind everybody's back.
  std::unique_ptr<store::Connection> connection() const;
  /// Signs in and returns the cookie with the header that changes need.
  Headers admin(Client& client) const;
};

/// The server's answers to a station that hands over a trial.
std::string upload_path(const std::string& trial_id);
Answer announce(Client& client, const Headers& station, const std::string& trial_id,
                const std::string& case_id, const std::string& bytes);
Answer send_piece(Client& client, const Headers& station, const std::string& trial_id,
                  std::uint64_t offset, const std::string& piece);
Answer commit(Client& client, const Headers& station, const std::string& trial_id);

}  // namespace tractus::world
