#include "server/app/import_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>

#include "core/file.hpp"
#include "core/try.hpp"
#include "server/jobs/import_volume.hpp"

namespace tractus {
namespace app {
namespace {

namespace fs = std::filesystem;
using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::size_t kMostAnswer_bytes = 16u << 20;

struct Pipe {
  std::array<int, 2> ends{-1, -1};
  bool open() { return ::pipe2(ends.data(), O_CLOEXEC) == 0; }
  void shut(std::size_t end) {
    if (ends[end] >= 0) ::close(ends[end]);
    ends[end] = -1;
  }
  ~Pipe() { shut(0), shut(1); }
};

/// This environment, with temporary files in `folder`.
std::vector<std::string> environment_in(const fs::path& folder) {
  std::vector<std::string> out{"TMPDIR=" + folder.string()};
  for (char** entry = environ; *entry; ++entry)
    if (!std::string_view(*entry).starts_with("TMPDIR=")) out.emplace_back(*entry);
  return out;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> out;
  for (std::string& text : texts) out.push_back(text.data());
  out.push_back(nullptr);
  return out;
}

std::vector<std::string> words_of(const fs::path& upload, const fs::path& folder,
                                  const std::string& series_uid) {
  std::vector<std::string> out{"tractus-server", "import-volume", "--upload",
                               upload.string(),  "--folder",      folder.string()};
  if (!series_uid.empty()) out.push_back("--series=" + series_uid);
  return out;
}

Result<pid_t> start(std::vector<std::string> words, const fs::path& folder, Pipe& in, Pipe& out) {
  std::vector<std::string> environment = environment_in(folder);
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_adddup2(&actions, in.ends[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out.ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  pid_t child = 0;
  const int failed = ::posix_spawn(&child, "/proc/self/exe", &actions, &attributes,
                                   pointers(words).data(), pointers(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (failed == 0) return child;
  errno = failed;
  return core::system_error("import-volume", "cannot start its process");
}

std::string all_of(int fd) {
  std::string out;
  std::array<char, 1 << 16> piece;
  while (out.size() < kMostAnswer_bytes) {
    const ssize_t n = ::read(fd, piece.data(), piece.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    out.append(piece.data(), static_cast<std::size_t>(n));
  }
  return out;
}

void limit(int what, rlim_t most) {
  const rlimit both{most, most};
  ::setrlimit(static_cast<__rlimit_resource>(what), &both);
}

}  // namespace

Result<Json> import_volume_in_subprocess(const fs::path& upload, const fs::path& folder,
                                         const std::array<std::byte, 32>& key,
                                         const std::string& series_uid) {
  Pipe in, out;
  if (!in.open() || !out.open()) return core::system_error("import-volume", "cannot open a pipe");
  auto child = TRY(start(words_of(upload, folder, series_uid), folder, in, out));
  in.shut(0), out.shut(1);
  const std::string text = core::hex(key);
  const bool told = ::write(in.ends[1], text.data(), text.size()) == ssize_t(text.size());
  in.shut(1);
  const std::string said = told ? all_of(out.ends[0]) : "";
  out.shut(0);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  Json answer = core::stored_json(said);
  const bool whole = WIFEXITED(status) && WEXITSTATUS(status) == 0 && answer.is_object();
  if (whole && answer.contains("facts")) return answer;
  if (whole && answer.contains("error"))
    return Error{static_cast<Errc>(answer.value("code", 0)), answer.value("error", "")};
  return Error{Errc::bad_input, "the upload is damaged: the program that reads it failed"};
}

Run import_volume_command(CLI::App& command) {
  const auto upload = std::make_shared<fs::path>(), folder = std::make_shared<fs::path>();
  command.add_option("--upload", *upload, "File that was uploaded")->required();
  command.add_option("--folder", *folder, "Folder for the volume")->required();
  const auto series_uid = std::make_shared<std::string>();
  command.add_option("--series", *series_uid, "Series Instance UID of the series to read");
  return [=]() -> Result<int> {
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, 900);
    limit(RLIMIT_AS, rlim_t{16} << 30);
    const std::string text = all_of(STDIN_FILENO);
    if (!core::is_sha256(text))
      return Error{Errc::bad_input, "standard input: 64 hexadecimal characters are expected"};
    volume_io::UidKey key{};
    std::ranges::copy(*core::hex_decoded(text), key.begin());
    const auto taken = jobs::import_volume(*upload, *folder, key, *series_uid);
    const Json answer =
        taken ? *taken
              : Json{{"code", static_cast<int>(taken.error().code)}, {"error", taken.error().what}};
    fmt::print("{}\n", answer.dump(-1, ' ', false, Json::error_handler_t::replace));
    return 0;
  };
}

}  // namespace app
}  // namespace tractus
