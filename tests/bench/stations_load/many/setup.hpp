/// The set-up of deploy/large on this machine: PostgreSQL that flushes, servers on one data folder,
/// nginx by the template that is handed out.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/bench/stations_load/many/options.hpp"
#include "tests/bench/stations_load/tools.hpp"
#include "tests/support/postgres/postgres_server.hpp"

namespace tractus::many {

class Setup {
 public:
  static core::Result<std::unique_ptr<Setup>> start(const Options& options);
  ~Setup();
  Setup(const Setup&) = delete;
  Setup& operator=(const Setup&) = delete;

  const std::string& url() const { return url_; }  ///< the proxy's
  std::filesystem::path authority() const { return data_ / "tls" / "authority.pem"; }
  const std::filesystem::path& data() const { return data_; }
  const std::filesystem::path& folder() const { return folder_; }
  std::string database() const { return postgres_.address(database_); }
  const std::string& case_id() const { return case_id_; }
  const std::string& token(std::size_t station) const { return tokens_[station]; }

  pid_t server_pid(std::size_t which) const { return servers_[which].pid; }
  pid_t proxy_pid() const { return proxy_.pid; }
  pid_t database_pid() const;
  std::size_t servers() const { return servers_.size(); }
  void kill_server(std::size_t which);  ///< SIGKILL, and waits for its end
  core::Result<void> start_server(std::size_t which);

 private:
  explicit Setup(const Options& options);
  core::Result<void> furnish();
  core::Result<void> enrol_stations();
  core::Result<void> start_proxy();
  /// With the soft limit of descriptors that a service starts with.
  load::Child limited(const std::vector<std::string>& words, const std::string& log) const;
  std::string server_address(std::size_t which) const;

  Options options_;
  std::filesystem::path folder_, data_;
  test_support::PostgresServer postgres_;
  std::string database_, url_, case_id_;
  std::vector<std::string> tokens_;
  std::vector<int> ports_;
  std::vector<load::Child> servers_;
  load::Child proxy_;
};

}  // namespace tractus::many
