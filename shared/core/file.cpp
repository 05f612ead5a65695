#include "core/file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/try.hpp"

namespace tractus {
namespace core {
namespace fs = std::filesystem;
namespace {

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int fd() const { return fd_; }

 private:
  int fd_;
};

bool write_all(int fd, ByteView bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

fs::path parent_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

}  // namespace

Error system_error(const fs::path& path, const char* what) {
  const int cause = errno;
  return {cause == ENOENT ? Errc::not_found : Errc::io,
          fmt::format("{}: {}: {}", path.string(), what, std::strerror(cause))};
}

Result<Bytes> read_file(const fs::path& path, std::uint64_t limit_bytes) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.fd() < 0) return system_error(path, "cannot open");
  struct stat info {};
  if (::fstat(file.fd(), &info) != 0) return system_error(path, "cannot look at");
  if (!S_ISREG(info.st_mode))
    return Error{Errc::bad_input, fmt::format("{}: not a regular file", path.string())};
  const auto size = static_cast<std::uint64_t>(info.st_size);
  if (size > limit_bytes)
    return Error{Errc::too_large, fmt::format("{}: {} bytes, at most {} are read", path.string(),
                                              size, limit_bytes)};
  Bytes out(size);
  std::size_t done = 0;
  while (done < out.size()) {
    const ssize_t n = ::read(file.fd(), out.data() + done, out.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return system_error(path, "cannot read");
    if (n == 0) break;
    done += static_cast<std::size_t>(n);
  }
  out.resize(done);
  return out;
}

Result<void> may_be_replaced(const fs::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0 || S_ISREG(info.st_mode)) return {};
  return Error{Errc::conflict, fmt::format("{}: exists and is not a regular file", path.string())};
}

Result<void> may_be_written(const fs::path& path) {
  TRY(may_be_replaced(path));
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (::access(folder.c_str(), W_OK | X_OK) != 0) return system_error(path, "cannot create");
  return {};
}

Result<void> write_file(const fs::path& path, ByteView bytes) {
  TRY(may_be_replaced(path));
  const fs::path beside = path.string() + fmt::format(".{}.part", hex(random_bytes(4)));
  {
    const Descriptor file(::open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
    if (file.fd() < 0) return system_error(path, "cannot create");
    if (!write_all(file.fd(), bytes) || ::fsync(file.fd()) != 0) {
      Error error = system_error(path, "cannot write");
      ::unlink(beside.c_str());
      return error;
    }
  }
  if (::rename(beside.c_str(), path.c_str()) != 0) {
    Error error = system_error(path, "cannot put in place");
    ::unlink(beside.c_str());
    return error;
  }
  return sync_folder(parent_of(path));
}

Result<void> sync_folder(const fs::path& folder) {
  const Descriptor dir(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (dir.fd() < 0) return system_error(folder, "cannot open");
  if (::fsync(dir.fd()) != 0) return system_error(folder, "cannot flush");
  return {};
}

namespace {

/// Whether others had access.
Result<bool> made_private(const fs::path& path, const struct stat& info) {
  constexpr mode_t kOthers = S_IRWXG | S_IRWXO;
  const bool plain = S_ISDIR(info.st_mode) || S_ISREG(info.st_mode);
  if (!plain || (info.st_mode & kOthers) == 0) return false;
  if (::chmod(path.c_str(), info.st_mode & 07777 & ~kOthers) == 0) return true;
  return system_error(path, "is open to others and cannot be made private");
}

Result<std::size_t> make_tree_private(const fs::path& path, std::string_view trusted) {
  struct stat info {};
  if (::lstat(path.c_str(), &info) != 0) return system_error(path, "cannot look at");
  auto first = TRY(made_private(path, info));
  std::size_t repaired = first ? 1 : 0;
  if (!S_ISDIR(info.st_mode) || (!first && path.filename() == trusted)) return repaired;
  std::error_code failure;
  for (fs::directory_iterator at(path, failure), end; !failure && at != end;
       at.increment(failure)) {
    auto inner = make_tree_private(at->path(), trusted);
    if (!inner && inner.error().code == Errc::not_found) continue;  // gone meanwhile
    if (!inner) return inner.error();
    repaired += *inner;
  }
  if (!failure) return repaired;
  const bool gone = failure == std::errc::no_such_file_or_directory;
  return Error{gone ? Errc::not_found : Errc::io,
               fmt::format("{}: {}", path.string(), failure.message())};
}

}  // namespace

Result<std::size_t> make_private(const fs::path& folder, std::string_view trusted) {
  std::error_code failure;
  const fs::path path = fs::canonical(folder, failure);
  if (!failure) return make_tree_private(path, trusted);
  return Error{Errc::io, fmt::format("{}: {}", folder.string(), failure.message())};
}

Result<ScratchFolder> ScratchFolder::make(const fs::path& beside) {
  const fs::path path = parent_of(beside) / fmt::format(".{}.{}.part", beside.filename().string(),
                                                        hex(random_bytes(4)));
  std::error_code failure;
  if (!fs::create_directories(path, failure) || failure)
    return Error{Errc::io, fmt::format("{}: cannot create a folder there: {}",
                                       parent_of(beside).string(), failure.message())};
  const fs::perms kept = fs::status(path, failure).permissions();
  fs::permissions(path, fs::perms::owner_all, failure);
  return ScratchFolder(path, kept);
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

ScratchFolder::ScratchFolder(ScratchFolder&& other) noexcept
    : path_(std::move(other.path_)), kept_(other.kept_) {
  other.path_.clear();
}

Result<void> ScratchFolder::keep_as(const fs::path& target) {
  std::error_code failure;
  if (fs::exists(target, failure))
    return Error{Errc::conflict, fmt::format("{}: exists already; remove it or choose another name",
                                             target.string())};
  fs::permissions(path_, kept_, failure);
  fs::rename(path_, target, failure);
  if (failure)
    return Error{Errc::io,
                 fmt::format("{}: cannot put in place: {}", target.string(), failure.message())};
  path_.clear();
  return sync_folder(parent_of(target));
}

}  // namespace core
}  // namespace tractus
