#include "tests/bench/stations_load/server.hpp"

#include <curl/curl.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <strings.h>
#include <sys/wait.h>
#include <unistd.h>

#include <checkout.hpp>
#include <fstream>
#include <sstream>

#include "cases/case.hpp"
#include "core/file.hpp"
#include "core/json.hpp"

extern char** environ;

namespace tractus {
namespace load {
namespace fs = std::filesystem;
namespace {

constexpr const char* kPassword = "a password of a bench";

struct Child {
  pid_t pid = -1;
  int output = -1;
};

Child spawn(const std::vector<std::string>& arguments, const fs::path& log) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return {};
  const std::string program = std::string(checkout::kBin) + "/tractus-server";
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& one : arguments) argv.push_back(const_cast<char*>(one.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_APPEND, 0644);
  Child out{.pid = -1, .output = ends[0]};
  ::posix_spawn(&out.pid, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  return out;
}

bool run(const std::vector<std::string>& arguments, const fs::path& log) {
  const Child child = spawn(arguments, log);
  int status = -1;
  if (child.pid > 0) ::waitpid(child.pid, &status, 0);
  ::close(child.output);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

std::string first_line(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

core::Result<std::string> make_case(const fs::path& folder) {
  volume::Volume volume;
  volume.geometry.dims = {40, 40, 40};
  volume.geometry.spacing_m = volume::Vec3::Constant(1e-3);
  volume.intercept = -1024.0;
  volume.counts.assign(volume.geometry.voxel_count(), 2024);
  cases::NewCase made{.definition = {}, .truth = {}, .volume = volume, .meta = {}, .draw = {}};
  made.definition.title = "Test block";
  made.definition.source = "made by a bench, no patient";
  made.definition.tract.length_m = 0.03;
  made.definition.tract.radius_m = 0.002;
  auto opened = cases::write_case(folder, std::move(made), core::KeyPair::generate());
  if (!opened) return opened.error();
  return opened->id;
}

std::size_t find_cookie(char* data, std::size_t, std::size_t size, void* out) {
  const std::string line(data, size);
  const std::string name = "set-cookie: ";
  if (line.size() > name.size() && ::strncasecmp(line.c_str(), name.c_str(), name.size()) == 0)
    *static_cast<std::string*>(out) = line.substr(name.size(), line.find(';') - name.size());
  return size;
}
std::size_t ignore_body(char*, std::size_t, std::size_t size, void*) { return size; }

core::Error failed(const std::string& what, const fs::path& log) {
  return {core::Errc::io, fmt::format("{} failed: see {}", what, log.string())};
}

}  // namespace

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
  const Child child = spawn(arguments, log);
  out.pid_ = child.pid;
  out.output_ = child.output;
  std::string said;
  for (char c = 0; said.find('\n') == std::string::npos && ::read(child.output, &c, 1) == 1;)
    said += c;
  const auto at = said.find("http");
  if (at == std::string::npos) return failed("serve", log);
  out.url_ = said.substr(at, said.rfind('/') - at);
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

core::Result<std::string> Server::cookie() const {
  const std::string url = url_ + "/api/v1/session";
  const std::string body = core::Json{{"name", "admin"}, {"password", kPassword}}.dump();
  std::string cookie;
  CURL* curl = curl_easy_init();
  curl_slist* headers = curl_slist_append(nullptr, "Content-Type: application/json");
  curl_easy_setopt(curl, CURLOPT_URL, url.c_str());
  curl_easy_setopt(curl, CURLOPT_HTTPHEADER, headers);
  curl_easy_setopt(curl, CURLOPT_POSTFIELDS, body.c_str());
  if (!authority_.empty()) curl_easy_setopt(curl, CURLOPT_CAINFO, authority_.c_str());
  curl_easy_setopt(curl, CURLOPT_HEADERFUNCTION, find_cookie);
  curl_easy_setopt(curl, CURLOPT_HEADERDATA, &cookie);
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, ignore_body);
  const CURLcode code = curl_easy_perform(curl);
  curl_slist_free_all(headers);
  curl_easy_cleanup(curl);
  if (code == CURLE_OK && !cookie.empty()) return cookie;
  return core::Error{core::Errc::unavailable, "the admin cannot sign in"};
}

double Server::resident_bytes() const {
  std::ifstream file(fmt::format("/proc/{}/statm", pid_));
  double all = 0.0, resident = 0.0;
  file >> all >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

double Server::processor_s() const {
  std::ifstream file(fmt::format("/proc/{}/stat", pid_));
  std::string line;
  std::getline(file, line);
  std::istringstream rest(line.substr(line.rfind(')') + 2));
  std::string skipped;
  for (int i = 0; i < 11; ++i) rest >> skipped;
  double user = 0.0, system = 0.0;
  rest >> user >> system;
  return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

}  // namespace load
}  // namespace tractus
