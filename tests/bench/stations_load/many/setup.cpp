#include "tests/bench/stations_load/many/setup.hpp"

#include <fmt/format.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <checkout.hpp>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "station/uplink/http_server.hpp"

namespace tractus {
namespace many {
namespace fs = std::filesystem;
namespace {

int free_port() {
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ::bind(fd, reinterpret_cast<sockaddr*>(&address), size);
  ::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
  ::close(fd);
  return ntohs(address.sin_port);
}

void end(load::Child& child, int signal) {
  if (child.pid < 0) return;
  ::kill(child.pid, signal);
  ::waitpid(child.pid, nullptr, 0);
  ::close(child.output);
  child = {};
}

/// The admin's requests of the set-up, to one server itself.
class Admin {
 public:
  static core::Result<Admin> signed_in(const std::string& url) {
    auto cookie = TRY(load::sign_in(url, {}));
    auto server = TRY(uplink::HttpServer::make_nameless(url));
    return Admin(std::move(server), std::move(cookie));
  }
  core::Result<core::Json> post(const std::string& path, const core::Json& body) {
    const std::string text = body.dump();
    const uplink::Request request{
        .method = "POST",
        .path = path,
        .headers = {{"Cookie", cookie_}, {"X-Tractus", "1"}, {"Content-Type", "application/json"}},
        .body = core::bytes_of(text)};
    auto answer = TRY(server_->send(request));
    return uplink::json_of(request, answer);
  }

 private:
  Admin(std::unique_ptr<uplink::HttpServer> server, std::string cookie)
      : server_(std::move(server)), cookie_(std::move(cookie)) {}
  std::unique_ptr<uplink::HttpServer> server_;
  std::string cookie_;
};

}  // namespace

Setup::Setup(const Options& options)
    : options_(options),
      folder_((options.folder.empty() ? fs::temp_directory_path() : options.folder) /
              ("many-stations-" + core::new_id().substr(0, 8))),
      data_(folder_ / "data"),
      postgres_(test_support::Durable::yes),
      database_(postgres_.add_database()) {
  for (int i = 0; i <= options.servers; ++i)
    ports_.push_back(options.port > 0 ? options.port + i : free_port());
}

Setup::~Setup() {
  end(proxy_, SIGTERM);
  for (load::Child& server : servers_) end(server, SIGTERM);
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

core::Result<std::unique_ptr<Setup>> Setup::start(const Options& options) {
  std::unique_ptr<Setup> out(new Setup(options));
  TRY(out->furnish());
  for (int i = 0; i < options.servers; ++i) {
    out->servers_.emplace_back();
    TRY(out->start_server(std::size_t(i)));
  }
  TRY(out->enrol_stations());
  TRY(out->start_proxy());
  return out;
}

core::Result<void> Setup::furnish() {
  fs::create_directories(folder_);
  const fs::path log = folder_ / "log";
  std::ofstream(folder_ / "password") << load::kPassword << "\n";
  if (!load::run({"init", "--data", data_, "--password-file", folder_ / "password", "--database",
                  database()},
                 log))
    return load::failed("init", log);
  case_id_ = TRY(load::make_case(folder_ / "case"));
  if (!load::run({"publish", "--data", data_, folder_ / "case"}, log))
    return load::failed("publish", log);
  return {};
}

load::Child Setup::limited(const std::vector<std::string>& words, const std::string& log) const {
  std::vector<std::string> all{"/bin/sh", "-c", "ulimit -S -n \"$0\" && exec \"$@\"",
                               std::to_string(options_.descriptors)};
  all.insert(all.end(), words.begin(), words.end());
  return load::spawn(all, folder_ / log);
}

std::string Setup::server_address(std::size_t which) const {
  return fmt::format("127.0.0.1:{}", ports_[which]);
}

core::Result<void> Setup::start_server(std::size_t which) {
  const std::string log = fmt::format("server-{}.log", which);
  servers_[which] = limited(load::server_words({"serve", "--data", data_, "--listen",
                                                server_address(which), "--behind-proxy"}),
                            log);
  if (load::listening_url(servers_[which]).empty()) return load::failed("serve", folder_ / log);
  return {};
}

void Setup::kill_server(std::size_t which) { end(servers_[which], SIGKILL); }

core::Result<void> Setup::enrol_stations() {
  const std::string url = "http://" + server_address(0);
  auto admin = TRY(Admin::signed_in(url));
  for (int i = 0; i < options_.stations; ++i) {
    const auto code =
        TRY(admin.post("/api/v1/stations/codes", {{"name", fmt::format("load {:04}", i)}}));
    const std::string token = core::hex(core::random_bytes(32));
    TRY(admin.post(
        "/api/v1/stations/enrol",
        {{"code", code["code"]}, {"token_sha256", core::sha256(core::bytes_of(token))}}));
    tokens_.push_back(token);
  }
  return {};
}

core::Result<void> Setup::start_proxy() {
  const fs::path run = folder_ / "proxy", configuration = folder_ / "nginx.conf";
  fs::create_directories(run);
  fs::permissions(folder_, fs::perms::owner_all | fs::perms::others_exec | fs::perms::group_exec);
  std::string servers;
  for (std::size_t i = 0; i < servers_.size(); ++i) servers += server_address(i) + " ";
  const std::string listen = fmt::format("127.0.0.1:{}", ports_.back());
  ::setenv("TRACTUS_SERVERS", servers.c_str(), 1);
  ::setenv("TRACTUS_LISTEN", listen.c_str(), 1);
  ::setenv("TRACTUS_CERTIFICATE", (data_ / "tls/server.pem").c_str(), 1);
  ::setenv("TRACTUS_KEY", (data_ / "tls/server.key").c_str(), 1);
  ::setenv("TRACTUS_RUN", run.c_str(), 1);
  const std::string render =
      fmt::format("{}/deploy/large/render > {}", checkout::kSource, configuration.string());
  if (std::system(render.c_str()) != 0) return load::failed("render", configuration);
  proxy_ = limited(
      {"nginx", "-e", run / "start.log", "-p", run, "-c", configuration, "-g", "daemon off;"},
      "nginx.log");
  url_ = "https://" + listen;
  auto asked = TRY(uplink::HttpServer::make_nameless(url_, authority()));
  for (int tries = 0; tries < 100; ++tries) {
    if (auto answer = asked->send({.method = "GET", .path = "/api/v1/health"}); answer) return {};
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return load::failed("nginx", run / "start.log");
}

pid_t Setup::database_pid() const {
  pid_t pid = -1;
  std::ifstream(postgres_.folder() / "data" / "postmaster.pid") >> pid;
  return pid;
}

}  // namespace many
}  // namespace tractus
