#include "tests/bench/stations_load/tools.hpp"

#include <curl/curl.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <strings.h>
#include <sys/wait.h>
#include <unistd.h>

#include <checkout.hpp>
#include <fstream>
#include <sstream>

#include "cases/case.hpp"
#include "core/json.hpp"

extern char** environ;

namespace tractus {
namespace load {
namespace fs = std::filesystem;

Child spawn(const std::vector<std::string>& words, const fs::path& log) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return {};
  std::vector<char*> argv;
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_APPEND, 0644);
  // Stations' sockets would stay open in it, closed by the station or not.
  posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
  Child out{.pid = -1, .output = ends[0]};
  ::posix_spawnp(&out.pid, argv.front(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  return out;
}

std::vector<std::string> server_words(const std::vector<std::string>& arguments) {
  std::vector<std::string> words{std::string(checkout::kBin) + "/tractus-server"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

bool run(const std::vector<std::string>& arguments, const fs::path& log) {
  const Child child = spawn(server_words(arguments), log);
  int status = -1;
  if (child.pid > 0) ::waitpid(child.pid, &status, 0);
  ::close(child.output);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

std::string listening_url(const Child& child) {
  std::string said;
  for (char c = 0; said.find('\n') == std::string::npos && ::read(child.output, &c, 1) == 1;)
    said += c;
  const auto at = said.find("http");
  return at == std::string::npos ? "" : said.substr(at, said.rfind('/') - at);
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

namespace {
std::size_t find_cookie(char* data, std::size_t, std::size_t size, void* out) {
  const std::string line(data, size);
  const std::string name = "set-cookie: ";
  if (line.size() > name.size() && ::strncasecmp(line.c_str(), name.c_str(), name.size()) == 0)
    *static_cast<std::string*>(out) = line.substr(name.size(), line.find(';') - name.size());
  return size;
}
std::size_t ignore_body(char*, std::size_t, std::size_t size, void*) { return size; }

}  // namespace

core::Error failed(const std::string& what, const fs::path& log) {
  return {core::Errc::io, fmt::format("{} failed: see {}", what, log.string())};
}

core::Result<std::string> sign_in(const std::string& server, const fs::path& authority) {
  const std::string url = server + "/api/v1/session";
  const std::string body = core::Json{{"name", "admin"}, {"password", kPassword}}.dump();
  std::string cookie;
  CURL* curl = curl_easy_init();
  curl_slist* headers = curl_slist_append(nullptr, "Content-Type: application/json");
  curl_easy_setopt(curl, CURLOPT_URL, url.c_str());
  curl_easy_setopt(curl, CURLOPT_HTTPHEADER, headers);
  curl_easy_setopt(curl, CURLOPT_POSTFIELDS, body.c_str());
  if (!authority.empty()) curl_easy_setopt(curl, CURLOPT_CAINFO, authority.c_str());
  curl_easy_setopt(curl, CURLOPT_HEADERFUNCTION, find_cookie);
  curl_easy_setopt(curl, CURLOPT_HEADERDATA, &cookie);
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, ignore_body);
  const CURLcode code = curl_easy_perform(curl);
  curl_slist_free_all(headers);
  curl_easy_cleanup(curl);
  if (code == CURLE_OK && !cookie.empty()) return cookie;
  return core::Error{core::Errc::unavailable, "the admin cannot sign in"};
}

double resident_bytes(pid_t pid) {
  std::ifstream file(fmt::format("/proc/{}/statm", pid));
  double all = 0.0, resident = 0.0;
  file >> all >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

double processor_s(pid_t pid) {
  std::ifstream file(fmt::format("/proc/{}/stat", pid));
  std::string line;
  if (!std::getline(file, line)) return 0.0;
  std::istringstream rest(line.substr(line.rfind(')') + 2));
  std::string skipped;
  for (int i = 0; i < 11; ++i) rest >> skipped;
  double user = 0.0, system = 0.0;
  rest >> user >> system;
  return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

}  // namespace load
}  // namespace tractus
