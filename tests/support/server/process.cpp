#include "tests/support/server/process.hpp"

#include <arpa/inet.h>
#include <curl/curl.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <checkout.hpp>
#include <csignal>
#include <fstream>

#include "core/bytes.hpp"
#include "tests/support/server/furnished.hpp"
#include "tests/support/server/world.hpp"

extern char** environ;

namespace tractus {
namespace world {
namespace fs = std::filesystem;
namespace {

struct Started {
  pid_t pid;
  int output;
};

Started start(const std::string& name, const std::vector<std::string>& arguments) {
  int ends[2];
  EXPECT_EQ(::pipe2(ends, O_CLOEXEC), 0);
  const std::string program = std::string(checkout::kBin) + "/" + name;
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  pid_t pid = -1;
  EXPECT_EQ(::posix_spawn(&pid, program.c_str(), &actions, nullptr, argv.data(), environ), 0)
      << program;
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  return {pid, ends[0]};
}

int exit_code(pid_t pid) {
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::size_t keep_body(char* data, std::size_t, std::size_t size, void* out) {
  static_cast<std::string*>(out)->append(data, size);
  return size;
}

std::size_t keep_header(char* data, std::size_t, std::size_t size, void* out) {
  std::string line(data, size);
  const auto colon = line.find(':');
  if (colon == std::string::npos) return size;
  std::string name = line.substr(0, colon), value = line.substr(colon + 1);
  for (char& c : name) c = static_cast<char>(std::tolower(c));
  value.erase(0, value.find_first_not_of(' '));
  value.erase(value.find_last_not_of("\r\n") + 1);
  (*static_cast<Headers*>(out))[name] = value;
  return size;
}

std::string token_in(const fs::path& file) {
  std::string token = bytes_of(file);
  return token.substr(0, token.find('\n'));
}

}  // namespace

Ended run_program(const std::string& name, const std::vector<std::string>& arguments) {
  const Started started = start(name, arguments);
  std::string out, piece(65536, '\0');
  for (ssize_t n = 1; n > 0;) {
    n = ::read(started.output, piece.data(), piece.size());
    out.append(piece, 0, static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
  }
  ::close(started.output);
  return {exit_code(started.pid), out};
}

Client::Client() : curl_(curl_easy_init()) {}
Client::~Client() { curl_easy_cleanup(curl_); }

Answer Client::ask(const std::string& method, const std::string& path, const Headers& headers,
                   const std::string& body) {
  Answer out;
  curl_slist* lines = nullptr;
  for (const auto& [name, value] : headers)
    lines = curl_slist_append(lines, (name + ": " + value).c_str());
  const std::string url =
      fmt::format("{}://127.0.0.1:{}{}", authority_.empty() ? "http" : "https", port_, path);
  curl_easy_reset(curl_);
  curl_easy_setopt(curl_, CURLOPT_URL, url.c_str());
  if (!authority_.empty()) curl_easy_setopt(curl_, CURLOPT_CAINFO, authority_.c_str());
  if (!from_.empty()) curl_easy_setopt(curl_, CURLOPT_INTERFACE, from_.c_str());
  curl_easy_setopt(curl_, CURLOPT_PATH_AS_IS, 1L);
  curl_easy_setopt(curl_, CURLOPT_CUSTOMREQUEST, method.c_str());
  curl_easy_setopt(curl_, CURLOPT_HTTPHEADER, lines);
  if (!body.empty()) {
    curl_easy_setopt(curl_, CURLOPT_POSTFIELDS, body.data());
    curl_easy_setopt(curl_, CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(body.size()));
  }
  if (method == "HEAD") curl_easy_setopt(curl_, CURLOPT_NOBODY, 1L);
  curl_easy_setopt(curl_, CURLOPT_WRITEFUNCTION, keep_body);
  curl_easy_setopt(curl_, CURLOPT_WRITEDATA, &out.body);
  curl_easy_setopt(curl_, CURLOPT_HEADERFUNCTION, keep_header);
  curl_easy_setopt(curl_, CURLOPT_HEADERDATA, &out.headers);
  curl_easy_setopt(curl_, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(curl_, CURLOPT_TIMEOUT, 60L);
  const CURLcode code = curl_easy_perform(curl_);
  long status = 0;
  curl_easy_getinfo(curl_, CURLINFO_RESPONSE_CODE, &status);
  curl_slist_free_all(lines);
  out.status = code == CURLE_OK ? static_cast<int>(status) : 0;
  return out;
}

ServerProcess::ServerProcess(const fs::path& data, std::vector<std::string> more,
                             Transport transport) {
  std::vector<std::string> arguments{"serve", "--data", data.string(), "--listen", "127.0.0.1:0"};
  if (transport == Transport::plain) arguments.emplace_back("--plain");
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Started started = start("tractus-server", arguments);
  pid_ = started.pid;
  output_ = started.output;
  const std::string before = transport == Transport::plain ? "listening on http://127.0.0.1:"
                                                           : "listening on https://127.0.0.1:";
  std::string line;  // lines of its log may come before
  char c = 0;
  while (port_ == 0 && ::read(output_, &c, 1) == 1) {
    line += c;
    if (c != '\n') continue;
    if (line.starts_with(before))
      port_ = std::stoi(line.substr(before.size()));
    else
      said_ += line;
    line.clear();
  }
  EXPECT_NE(port_, 0) << said_ << line;
}

ServerProcess::~ServerProcess() { kill_now(); }

void ServerProcess::kill_now() {
  if (pid_ < 0) return;
  ::kill(pid_, SIGKILL);
  exit_code(pid_);
  ::close(output_);
  pid_ = -1;
}

int ServerProcess::stop() {
  ::kill(pid_, SIGTERM);
  std::string piece(65536, '\0');
  for (ssize_t n = 1; n > 0;) {
    n = ::read(output_, piece.data(), piece.size());
    said_.append(piece, 0, static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
  }
  const int code = exit_code(pid_);
  ::close(output_);
  pid_ = -1;
  return code;
}

std::size_t ServerProcess::peak_memory_bytes() const {
  std::ifstream status(fmt::format("/proc/{}/status", pid_));
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stoull(line.substr(6)) * 1024;
  return 0;
}

RawAnswer send_raw(int port, const std::string& bytes, int patience_ms) {
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(::connect(fd, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL),
            static_cast<ssize_t>(bytes.size()));
  RawAnswer out;
  pollfd waiting{fd, POLLIN, 0};
  std::string piece(65536, '\0');
  while (::poll(&waiting, 1, patience_ms) > 0) {
    const ssize_t n = ::recv(fd, piece.data(), piece.size(), 0);
    out.closed = n <= 0;
    if (out.closed) break;
    out.text.append(piece, 0, static_cast<std::size_t>(n));
  }
  ::close(fd);
  return out;
}

ServedWorld::ServedWorld() {
  const FurnishedWorld& model = furnished_world();
  if (model.database) {
    database_ = test_support::TestDatabase::copy_of(*model.database);
    address_ = database_->address();
  }
  begin();
  fs::copy(model.folder, folder, fs::copy_options::recursive);
  if (model.database) std::ofstream(data / "database.address") << address_ << "\n";
  read();
}

ServedWorld::ServedWorld(const std::string& address) : address_(address) {
  begin();
  furnish_world(folder, address);
  read();
}

std::unique_ptr<store::Connection> ServedWorld::connection() const {
  if (address_.empty()) {
    auto opened = store::open_sqlite(data / "tractus.db", store::Access::write);
    return opened ? std::move(*opened) : nullptr;
  }
  auto made = store::postgres_connection(address_, store::Access::write);
  return made->begin(store::Access::beside) && made->commit() ? std::move(made) : nullptr;
}

void ServedWorld::begin() {
  folder = fs::path(::testing::TempDir()) / ("tractus-" + core::new_id());
  data = folder / "data";
  fs::create_directories(folder);
}

void ServedWorld::read() {
  case_id = token_in(folder / "case-id");
  station_1 = {{"Authorization", "Bearer " + token_in(folder / "station-1")}};
  station_2 = {{"Authorization", "Bearer " + token_in(folder / "station-2")}};
}

ServedWorld::~ServedWorld() {
  std::error_code ignored;
  fs::remove_all(folder, ignored);
}

Headers ServedWorld::admin(Client& client) const {
  const Answer in = client.ask("POST", "/api/v1/session", {{"Content-Type", "application/json"}},
                               core::Json{{"name", "admin"}, {"password", kPassword}}.dump());
  EXPECT_EQ(in.status, 200) << in.body;
  const auto cookie = in.headers.find("set-cookie");
  if (cookie == in.headers.end()) return {};
  return {{"Cookie", cookie->second.substr(0, cookie->second.find(';'))}, {"X-Tractus", "1"}};
}

std::string upload_path(const std::string& trial_id) { return "/api/v1/uploads/" + trial_id; }

Answer announce(Client& client, const Headers& station, const std::string& trial_id,
                const std::string& case_id, const std::string& bytes) {
  return client.ask("PUT", upload_path(trial_id), station,
                    core::Json{{"case_id", case_id},
                               {"size_bytes", bytes.size()},
                               {"sha256", core::sha256(core::bytes_of(bytes))}}
                        .dump());
}

Answer send_piece(Client& client, const Headers& station, const std::string& trial_id,
                  std::uint64_t offset, const std::string& piece) {
  Headers headers = station;
  headers["X-Crc32c"] = fmt::format("{:08x}", core::crc32c(core::bytes_of(piece)));
  headers["Content-Type"] = "application/octet-stream";
  return client.ask("PATCH", upload_path(trial_id) + "?offset_bytes=" + std::to_string(offset),
                    headers, piece);
}

Answer commit(Client& client, const Headers& station, const std::string& trial_id) {
  return client.ask("POST", upload_path(trial_id) + "/commit", station);
}

}  // namespace world
}  // namespace tractus
