#include "volume/io/isolated.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/file.hpp"
#include "core/json.hpp"
#include "volume/io/claims.hpp"

namespace tractus {
namespace volume_io {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kTextLimit = 16u << 20;

/// What the child says: how far it is ('p', a double), an error or a volume ('e', 'v', a JSON
/// text); counts follow a 'v'.
struct Word {
  char kind = 0;
  std::uint64_t size = 0;
};

bool send(int fd, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t n = ::write(fd, at, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

bool receive(int fd, void* data, std::size_t size) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t n = ::read(fd, at, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

bool send_word(int fd, char kind, const void* data, std::size_t size) {
  const Word word{kind, size};
  return send(fd, &word, sizeof(word)) && send(fd, data, size);
}

std::string text_of(const Imported& in) {
  const auto& g = in.volume.geometry;
  const auto three = [](const auto& v) { return std::vector<double>{v[0], v[1], v[2]}; };
  return core::Json{{"dims", g.dims},
                    {"spacing", three(g.spacing_m)},
                    {"origin", three(g.origin_m)},
                    {"i", three(g.directions.col(0))},
                    {"j", three(g.directions.col(1))},
                    {"k", three(g.directions.col(2))},
                    {"slope", in.volume.slope},
                    {"intercept", in.volume.intercept},
                    {"format", in.format},
                    {"source", in.source},
                    {"notes", in.notes},
                    {"modality", in.modality},
                    {"suspicions", in.suspicions},
                    {"report", in.report}}
      .dump(-1, ' ', false, core::Json::error_handler_t::replace);
}

Imported imported_of(const core::Json& json) {
  Imported out;
  const auto three = [&](const char* key) {
    const auto v = json.at(key).get<std::vector<double>>();
    return volume::Vec3(v.at(0), v.at(1), v.at(2));
  };
  auto& g = out.volume.geometry;
  g.dims = json.at("dims").get<std::array<int, 3>>();
  g.spacing_m = three("spacing");
  g.origin_m = three("origin");
  g.directions << three("i"), three("j"), three("k");
  out.volume.slope = json.at("slope").get<double>();
  out.volume.intercept = json.at("intercept").get<double>();
  out.format = json.at("format").get<std::string>();
  out.source = json.at("source").get<std::string>();
  out.notes = json.at("notes").get<std::vector<std::string>>();
  out.modality = json.at("modality").get<std::string>();
  out.suspicions = json.at("suspicions").get<std::vector<std::string>>();
  out.report = json.at("report");
  return out;
}

[[noreturn]] void be_the_child(
    int fd, const std::function<core::Result<Imported>(const core::Progress&)>& read) {
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
  if (const int null = ::open("/dev/null", O_WRONLY); null >= 0) {
    ::dup2(null, STDERR_FILENO);
    ::dup2(null, STDOUT_FILENO);
  }
  const auto result =
      read([fd](double share) { return send_word(fd, 'p', &share, sizeof(share)); });
  bool sent = false;
  if (result) {
    const std::string text = text_of(*result);
    sent = send_word(fd, 'v', text.data(), text.size()) &&
           send(fd, result->volume.counts.data(),
                result->volume.counts.size() * sizeof(std::uint16_t));
  } else {
    const std::string text =
        static_cast<char>('0' + static_cast<int>(result.error().code)) + result.error().what;
    sent = send_word(fd, 'e', text.data(), text.size());
  }
  ::_exit(sent ? 0 : 1);
}

/// Listens until the child has said all, or falls silent.
core::Result<Imported> listen(int fd, const fs::path& path, const core::Progress& progress) {
  const core::Error silent = bad(path, "is damaged: its reader gave up on it");
  Word word;
  while (receive(fd, &word, sizeof(word))) {
    double share = 0.0;
    if (word.kind == 'p' && word.size == sizeof(share)) {
      if (!receive(fd, &share, sizeof(share))) return silent;
      if (progress && !progress(share))
        return core::Error{core::Errc::cancelled, "reading was stopped"};
      continue;
    }
    if (word.size == 0 || word.size > kTextLimit) return silent;
    std::string text(word.size, '\0');
    if (!receive(fd, text.data(), text.size())) return silent;
    if (word.kind == 'e')
      return core::Error{static_cast<core::Errc>(text[0] - '0'), text.substr(1)};
    const auto json = core::parse_json(text, path.string());
    if (!json) return silent;
    Imported out = imported_of(*json);
    out.volume.counts.resize(out.volume.geometry.voxel_count());
    if (!receive(fd, out.volume.counts.data(), out.volume.counts.size() * sizeof(std::uint16_t)))
      return silent;
    return out;
  }
  return silent;
}

}  // namespace

core::Result<Imported> isolated(
    const fs::path& path, const std::function<core::Result<Imported>(const core::Progress&)>& read,
    const core::Progress& progress) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    return core::system_error(path, "cannot open a pipe to its reader");
  const pid_t child = ::fork();
  if (child < 0) {
    const core::Error error = core::system_error(path, "cannot start its reader");
    ::close(ends[0]);
    ::close(ends[1]);
    return error;
  }
  if (child == 0) {
    ::close(ends[0]);
    be_the_child(ends[1], read);
  }
  ::close(ends[1]);
  auto out = listen(ends[0], path, progress);
  ::close(ends[0]);
  if (!out) ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return out;
}

}  // namespace volume_io
}  // namespace tractus
