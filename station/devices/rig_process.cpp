#include "station/devices/rig_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <utility>
#include <vector>

#include "core/json.hpp"

extern char** environ;

namespace tractus {
namespace devices {
namespace {

constexpr int kStart_ms = 5000;

core::Error not_started(const std::string& program, const std::string& why) {
  return {core::Errc::unavailable, fmt::format("{}: the simulated rig: {}", program, why)};
}

std::string program_of(const RigProcessOptions& options) {
  if (!options.program.empty()) return options.program.string();
  std::error_code unknown;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", unknown);
  return (self.parent_path() / "tractus-rig").string();
}

/// A line of its standard output; empty when there is none in time.
std::string line_from(int output) {
  std::string line;
  char c = 0;
  for (pollfd waiting{output, POLLIN, 0};
       ::poll(&waiting, 1, kStart_ms) > 0 && ::read(output, &c, 1) == 1 && c != '\n';)
    line += c;
  return line;
}

/// Both ends of a pipe, closed at an exec.
struct Pipe {
  std::array<int, 2> ends{-1, -1};
  bool open() { return ::pipe2(ends.data(), O_CLOEXEC) == 0; }
  void close(std::size_t end) {
    if (ends[end] >= 0) ::close(std::exchange(ends[end], -1));
  }
  ~Pipe() { close(0), close(1); }
};

pid_t spawned(const std::vector<std::string>& words, const Pipe& input, const Pipe& output) {
  std::vector<char*> arguments;
  for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawnattr_t how;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawnattr_init(&how);
  ::posix_spawn_file_actions_adddup2(&files, input.ends[0], STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&files, output.ends[1], STDOUT_FILENO);
  // A Ctrl-C at the station's terminal is the station's: it ends the trial, then this process.
  ::posix_spawnattr_setflags(&how, POSIX_SPAWN_SETPGROUP);
  pid_t pid = -1;
  const int failed = ::posix_spawn(&pid, words[0].c_str(), &files, &how, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&files);
  ::posix_spawnattr_destroy(&how);
  errno = failed;
  return failed == 0 ? pid : -1;
}

}  // namespace

core::Result<RigProcess> RigProcess::start(const RigProcessOptions& options) {
  const std::string program = program_of(options);
  std::vector<std::string> words{program,
                                 "--port",
                                 "0",
                                 "--json",
                                 "--until-eof",
                                 "--seed",
                                 std::to_string(options.seed),
                                 "--skill",
                                 fmt::format("{}", options.skill)};
  if (options.surgeon) words.emplace_back("--surgeon");
  if (!options.specimen.empty())
    words.insert(words.end(), {"--specimen", options.specimen.string()});
  if (options.bus_clock) words.emplace_back("--bus-clock");
  Pipe input, output;
  if (!input.open() || !output.open()) return not_started(program, std::strerror(errno));
  RigProcess made;
  made.pid_ = spawned(words, input, output);
  if (made.pid_ < 0) return not_started(program, std::strerror(errno));
  made.input_ = std::exchange(input.ends[1], -1);
  output.close(1);
  const std::string said = line_from(output.ends[0]);
  const auto json = core::parse_json(said, "tractus-rig");
  if (!json || !json->is_object() || !json->value("port", core::Json()).is_number_integer())
    return not_started(program, said.empty() ? "did not start" : "said: " + said.substr(0, 100));
  made.address_ = fmt::format("127.0.0.1:{}", (*json)["port"].get<int>());
  return made;
}

RigProcess::RigProcess(RigProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      input_(std::exchange(other.input_, -1)),
      address_(std::move(other.address_)) {}

RigProcess::~RigProcess() {
  if (input_ >= 0) ::close(input_);
  if (pid_ < 0) return;
  ::kill(pid_, SIGKILL);  // it holds nothing that must be put in order
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

}  // namespace devices
}  // namespace tractus
