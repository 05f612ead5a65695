#include "tests/support/postgres/postgres_server.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <grp.h>
#include <pwd.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "core/bytes.hpp"
#include "db/store/database/connection.hpp"

namespace tractus {
namespace test_support {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void give_up(const std::string& why) {
  fmt::print(stderr, "tests of PostgreSQL: {}\n", why);
  std::exit(1);
}

/// /usr/lib/postgresql/NN/bin of the newest, where Debian puts them.
fs::path newest_programs() {
  fs::path best;
  int newest = 0;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator("/usr/lib/postgresql", failure)) {
    const int version = std::atoi(entry.path().filename().c_str());
    if (version <= newest || !fs::exists(entry.path() / "bin/initdb")) continue;
    newest = version;
    best = entry.path() / "bin";
  }
  if (best.empty()) give_up("/usr/lib/postgresql holds none; install postgresql");
  return best;
}

/// What a test program that was killed has left: clusters whose server is gone.
void sweep(const fs::path& place) {
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(place, failure)) {
    if (!entry.path().filename().string().starts_with("tractus-pg-")) continue;
    pid_t server = 0;
    std::ifstream(entry.path() / "data/postmaster.pid") >> server;
    const auto changed = fs::last_write_time(entry.path() / "data", failure);
    const bool old = fs::file_time_type::clock::now() - changed > std::chrono::minutes(5);
    // Without a number it is being made, or it ended when its test did.
    if (server > 0 ? ::kill(server, 0) != 0 && errno == ESRCH : !failure && old)
      fs::remove_all(entry.path(), failure);
  }
}

const passwd& user_without_privileges() {
  if (const passwd* user = ::getpwnam("postgres")) return *user;
  if (const passwd* user = ::getpwnam("nobody")) return *user;
  give_up("neither a user postgres nor nobody");
}

/// A program as another user (when that is not this one), its words into a file, ended with us.
pid_t spawn(const std::vector<std::string>& words, uid_t user, gid_t group, const fs::path& log) {
  std::vector<char*> argv;
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  const pid_t pid = ::fork();
  if (pid != 0) return pid;
  const int out = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(out, STDERR_FILENO);
  if (::geteuid() == 0 &&
      (::setgroups(0, nullptr) != 0 || ::setgid(group) != 0 || ::setuid(user) != 0))
    ::_exit(127);
  ::prctl(PR_SET_PDEATHSIG, SIGQUIT);  // after setuid, which clears it
  ::execv(argv.front(), argv.data());
  ::_exit(127);
}

std::string tail_of(const fs::path& log) {
  std::ifstream file(log);
  std::string text((std::istreambuf_iterator<char>(file)), {});
  return text.size() > 2000 ? text.substr(text.size() - 2000) : text;
}

}  // namespace

fs::path place_of(Durable durable) {
  constexpr std::uintmax_t kRoom_bytes = 512u << 20;
  std::error_code failure;
  const fs::path memory = "/dev/shm";
  const auto space = fs::space(memory, failure);
  const bool fits = !failure && space.available >= kRoom_bytes;
  return durable == Durable::no && fits && ::access(memory.c_str(), W_OK) == 0 ? memory : "/tmp";
}

PostgresServer::PostgresServer(Durable durable)
    : programs_(newest_programs()),
      // The random end of an id: its beginning is the millisecond, in which two tests can begin.
      folder_(place_of(durable) / ("tractus-pg-" + core::new_id().substr(20))) {
  sweep(folder_.parent_path());
  fs::create_directories(folder_);
  if (::geteuid() == 0) {
    user_ = user_without_privileges().pw_uid;
    group_ = user_without_privileges().pw_gid;
    if (::chown(folder_.c_str(), user_, group_) != 0) give_up("cannot give the folder away");
  }
  settings_ = {"listen_addresses=",
               "unix_socket_directories=" + folder_.string(),
               "max_connections=80",
               "shared_buffers=32MB",
               "log_min_messages=warning",
               "dynamic_shared_memory_type=mmap"};  // within the folder: nothing else to clean up
  if (durable == Durable::no)
    for (const char* off : {"fsync=off", "full_page_writes=off", "autovacuum=off"})
      settings_.emplace_back(off);
  const pid_t made = spawn({programs_ / "initdb", "-D", folder_ / "data", "-U", "tractus",
                            "--auth=trust", "--encoding=UTF8", "--locale=C", "--no-sync"},
                           user_, group_, folder_ / "initdb.log");
  int status = 0;
  if (::waitpid(made, &status, 0) != made || status != 0)
    give_up("initdb failed: " + tail_of(folder_ / "initdb.log"));
  start();
}

PostgresServer::~PostgresServer() {
  stop(SIGINT);
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void PostgresServer::start() {
  std::vector<std::string> words{programs_ / "postgres", "-D", folder_ / "data"};
  for (const std::string& setting : settings_) {
    words.emplace_back("-c");
    words.push_back(setting);
  }
  pid_ = spawn(words, user_, group_, folder_ / "server.log");
  for (int tries = 0; tries < 600; ++tries) {
    auto connection = store::postgres_connection(address(), store::Access::beside);
    if (connection->begin(store::Access::beside)) return;
    if (::waitpid(pid_, nullptr, WNOHANG) == pid_) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  give_up("it does not start: " + tail_of(folder_ / "server.log"));
}

void PostgresServer::stop(int signal) {
  if (pid_ < 0) return;
  ::kill(pid_, signal);
  ::waitpid(pid_, nullptr, 0);
  pid_ = -1;
}

std::string PostgresServer::address(const std::string& database) const {
  return fmt::format("postgresql:///{}?host={}&user=tractus", database, folder_.string());
}

void PostgresServer::run(const std::string& sql) {
  if (!line_) line_ = store::postgres_connection(address(), store::Access::write);
  if (!line_->begin(store::Access::beside) || !line_->commit()) give_up("it cannot be reached");
  if (auto done = line_->script(sql); !done) give_up(sql + ": " + done.error().what);
}

std::string PostgresServer::add_database(const std::string& of) {
  const std::string name = fmt::format("test_{}_{}", ::getpid(), ++made_);
  run(fmt::format("create database {} template {}", name, of));
  return name;
}

void PostgresServer::drop_database(const std::string& name) {
  run(fmt::format("drop database if exists {} with (force)", name));
}

PostgresServer& postgres_server() {
  static PostgresServer server(Durable::no);
  return server;
}

}  // namespace test_support
}  // namespace tractus
