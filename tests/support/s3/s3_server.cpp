#include "tests/support/s3/s3_server.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <checkout.hpp>
#include <cstdlib>

#include "core/bytes.hpp"

namespace tractus {
namespace test_support {
namespace {

[[noreturn]] void give_up(const std::string& why) {
  fmt::print(stderr, "tests of the object store: {}\n", why);
  std::exit(1);
}

int free_port() {
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = ::htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof at;
  if (::bind(fd, reinterpret_cast<sockaddr*>(&at), size) != 0 ||
      ::getsockname(fd, reinterpret_cast<sockaddr*>(&at), &size) != 0)
    give_up("no free port");
  ::close(fd);
  return ::ntohs(at.sin_port);
}

/// In memory where that is a folder: the monitor flushes its notes often.
std::filesystem::path folder_of_cluster() {
  const char* place = ::access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp";
  return std::filesystem::path(place) / ("tractus-s3-" + core::new_id().substr(0, 12));
}

}  // namespace

S3Server::S3Server() : folder_(folder_of_cluster()), port_(free_port()) {
  ::signal(SIGPIPE, SIG_IGN);
  const std::string secret = core::hex(core::random_bytes(20));
  ::setenv("AWS_ACCESS_KEY_ID", "TRACTUSTEST", 1);
  ::setenv("AWS_SECRET_ACCESS_KEY", secret.c_str(), 1);
  std::array<int, 2> in{}, out{};
  if (::pipe2(in.data(), O_CLOEXEC) != 0 || ::pipe2(out.data(), O_CLOEXEC) != 0) give_up("no pipe");
  const std::string script = std::string(checkout::kSource) + "/tests/support/s3/rados_gateway.py";
  const std::string port = std::to_string(port_);
  helper_ = ::fork();
  if (helper_ == 0) {
    ::dup2(in[0], STDIN_FILENO);
    ::dup2(out[1], STDOUT_FILENO);
    ::execlp("python3", "python3", script.c_str(), folder_.c_str(), port.c_str(), nullptr);
    ::_exit(127);
  }
  ::close(in[0]);
  ::close(out[1]);
  to_ = ::fdopen(in[1], "w");
  from_ = ::fdopen(out[0], "r");
  start();
}

S3Server::~S3Server() {
  std::fclose(to_);
  ::waitpid(helper_, nullptr, 0);
  std::fclose(from_);
}

std::string S3Server::ask(const std::string& command) {
  fmt::print(to_, "{}\n", command);
  std::fflush(to_);
  std::string line;
  for (int c = std::fgetc(from_); c != EOF && c != '\n'; c = std::fgetc(from_))
    line += static_cast<char>(c);
  if (!line.starts_with("ready")) give_up("rados_gateway.py ended");
  return line.size() > 6 ? line.substr(6) : "";
}

std::string S3Server::address(const std::string& prefix) const {
  return fmt::format("http://127.0.0.1:{}/tractus/{}", port_, prefix);
}

std::string S3Server::address_without_bucket() const {
  return fmt::format("http://127.0.0.1:{}/no-such-bucket", port_);
}

void S3Server::kill_gateway() const { ::kill(gateway_, SIGKILL); }

void S3Server::start() { gateway_ = std::atoi(ask("start").c_str()); }

std::string S3Server::etag(const std::string& key) { return ask("etag " + key); }

int S3Server::unfinished_uploads() { return std::atoi(ask("uploads").c_str()); }

S3Server& s3_server() {
  static S3Server server;
  return server;
}

}  // namespace test_support
}  // namespace tractus
