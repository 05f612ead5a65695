#include "tests/bench/stations_load/server.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "core/bytes.hpp"
#include "tests/bench/stations_load/tools.hpp"

namespace tractus {
namespace load {
namespace fs = std::filesystem;

core::Result<Server> Server::start(const fs::path& folder, int stations, bool plain) {
  fs::remove_all(folder);
  fs::create_directories(folder);
  const fs::path data = folder / "data", log = folder / "log";
  std::ofstream(folder / "password") << kPassword << "\n";
  if (!run({"init", "--data", data, "--password-file", folder / "password"}, log))
    return failed("init", log);
  Server out;
  out.folder_ = folder;
  for (int i = 0; i < stations; ++i) {
    const fs::path token = folder / fmt::format("token-{}", i);
    if (!run({"enrol", "--data", data, "--name", fmt::format("load {:02}", i), "--out", token},
             log))
      return failed("enrol", log);
    out.tokens_.push_back(first_line(token));
  }
  auto made = make_case(folder / "case");
  if (!made) return made.error();
  out.case_id_ = *made;
  if (!run({"publish", "--data", data, folder / "case"}, log)) return failed("publish", log);
  std::vector<std::string> arguments{"serve", "--data", data, "--listen", "127.0.0.1:0"};
  if (plain) arguments.emplace_back("--plain");
  const Child child = spawn(server_words(arguments), log);
  out.pid_ = child.pid;
  out.output_ = child.output;
  out.url_ = listening_url(child);
  if (out.url_.empty()) return failed("serve", log);
  if (!plain) out.authority_ = data / "tls" / "authority.pem";
  return out;
}

Server::Server(Server&& other) noexcept
    : folder_(std::move(other.folder_)),
      authority_(std::move(other.authority_)),
      url_(std::move(other.url_)),
      case_id_(std::move(other.case_id_)),
      tokens_(std::move(other.tokens_)),
      pid_(std::exchange(other.pid_, -1)),
      output_(std::exchange(other.output_, -1)) {}

Server::~Server() {
  if (pid_ < 0) return;
  ::kill(pid_, SIGTERM);
  int status = 0;
  ::waitpid(pid_, &status, 0);
  ::close(output_);
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

core::Result<std::string> Server::cookie() const { return sign_in(url_, authority_); }
double Server::resident_bytes() const { return load::resident_bytes(pid_); }
double Server::processor_s() const { return load::processor_s(pid_); }

}  // namespace load
}  // namespace tractus
