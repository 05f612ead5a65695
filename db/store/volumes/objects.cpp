#include "db/store/volumes/objects.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <functional>

#include "core/file.hpp"
#include "core/try.hpp"

namespace tractus {
namespace store {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kPiece_bytes = 1u << 20;

class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags)
      : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0600)) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  explicit operator bool() const { return fd_ >= 0; }
  int fd() const { return fd_; }

 private:
  int fd_;
};

bool write_all(int fd, std::uint64_t offset, core::ByteView bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::pwrite(fd, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    offset += static_cast<std::uint64_t>(n);
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

/// Hands out a file in pieces.
core::Result<void> each_piece(const fs::path& path,
                              const std::function<bool(core::ByteView)>& take) {
  const Descriptor file(path, O_RDONLY);
  if (!file) return core::system_error(path, "cannot open");
  core::Bytes piece(kPiece_bytes);
  for (;;) {
    const ssize_t n = ::read(file.fd(), piece.data(), piece.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return core::system_error(path, "cannot read");
    if (n == 0) return {};
    if (!take(core::ByteView(piece).first(static_cast<std::size_t>(n))))
      return core::system_error(path, "cannot copy");
  }
}

/// For its owner alone, though the folder that it is in may not be.
core::Result<fs::path> made_folder(const fs::path& path) {
  std::error_code failure;
  if (fs::create_directories(path, failure) && !failure)
    fs::permissions(path, fs::perms::owner_all, failure);
  if (failure)
    return core::Error{core::Errc::io,
                       fmt::format("{}: cannot create: {}", path.string(), failure.message())};
  return path;
}

}  // namespace

core::Result<Objects> Objects::open(const fs::path& data) {
  auto root = TRY(made_folder(data / "objects"));
  return Objects(std::move(root));
}

fs::path Objects::path_of(const std::string& sha256) const {
  core::require(core::is_sha256(sha256), "an object is named by a SHA-256");
  return root_ / sha256.substr(0, 2) / sha256.substr(2);
}

bool Objects::has(const std::string& sha256) const {
  std::error_code ignored;
  return fs::is_regular_file(path_of(sha256), ignored);
}

core::Result<void> Objects::folder_for(const std::string& sha256) const {
  const fs::path folder = path_of(sha256).parent_path();
  std::error_code failure;
  if (fs::exists(folder, failure)) return {};
  TRY(made_folder(folder));
  return core::sync_folder(root_);
}

core::Result<std::string> Objects::put(core::ByteView bytes) const {
  const std::string sha256 = core::sha256(bytes);
  if (has(sha256)) return sha256;
  TRY(folder_for(sha256));
  TRY(core::write_file(path_of(sha256), bytes));
  return sha256;
}

core::Result<void> Objects::copy_in(const fs::path& file, const std::string& sha256) const {
  if (has(sha256)) return {};
  TRY(folder_for(sha256));
  const fs::path target = path_of(sha256);
  const fs::path beside = target.string() + "." + core::hex(core::random_bytes(4)) + ".part";
  core::Sha256 hash;
  core::Result<void> outcome;
  {
    const Descriptor out(beside, O_WRONLY | O_CREAT | O_EXCL);
    if (!out) return core::system_error(beside, "cannot create");
    std::uint64_t offset = 0;
    auto copied = each_piece(file, [&](core::ByteView piece) {
      hash.add(piece);
      const bool written = write_all(out.fd(), offset, piece);
      offset += piece.size();
      return written;
    });
    if (!copied)
      outcome = copied.error();
    else if (::fsync(out.fd()) != 0)
      outcome = core::system_error(beside, "cannot flush");
  }
  if (outcome && hash.hex() != sha256)
    outcome = core::Error{core::Errc::corrupt,
                          fmt::format("{}: its SHA-256 is not {}", file.string(), sha256)};
  if (outcome && ::rename(beside.c_str(), target.c_str()) != 0)
    outcome = core::system_error(target, "cannot put in place");
  if (!outcome) {
    ::unlink(beside.c_str());
    return outcome;
  }
  return core::sync_folder(target.parent_path());
}

core::Result<void> Objects::link_in(const fs::path& file, const std::string& sha256) const {
  TRY(folder_for(sha256));
  const fs::path target = path_of(sha256);
  if (::link(file.c_str(), target.c_str()) != 0 && errno != EEXIST)
    return core::system_error(target, "cannot put in place");
  return core::sync_folder(target.parent_path());
}

core::Result<PartialFiles> PartialFiles::open(const fs::path& data) {
  auto root = TRY(made_folder(data / "uploads"));
  return PartialFiles(std::move(root));
}

fs::path PartialFiles::path_of(const std::string& trial_id) const {
  core::require(core::is_id(trial_id), "a partial file is named by a trial's id");
  return root_ / (trial_id + ".part");
}

std::uint64_t PartialFiles::size_of(const std::string& trial_id) const {
  // Opened first: a file that another machine writes has its size looked up anew only then (NFS).
  const Descriptor file(path_of(trial_id), O_RDONLY);
  struct stat facts {};
  return file && ::fstat(file.fd(), &facts) == 0 ? static_cast<std::uint64_t>(facts.st_size) : 0;
}

core::Result<void> PartialFiles::append(const std::string& trial_id, std::uint64_t offset,
                                        core::ByteView bytes) const {
  const fs::path path = path_of(trial_id);
  const bool fresh = offset == 0;
  const Descriptor file(path, fresh ? O_WRONLY | O_CREAT : O_WRONLY);
  if (!file) return core::system_error(path, "cannot open");
  if (!write_all(file.fd(), offset, bytes) || ::fdatasync(file.fd()) != 0) {
    const core::Error failure = core::system_error(path, "cannot write");
    if (::ftruncate(file.fd(), static_cast<off_t>(offset)) != 0) remove(trial_id);
    return failure;
  }
  return fresh ? core::sync_folder(root_) : core::Result<void>();
}

core::Result<void> PartialFiles::flush(const std::string& trial_id) const {
  const fs::path path = path_of(trial_id);
  const Descriptor file(path, O_WRONLY);
  if (!file || ::fdatasync(file.fd()) != 0) return core::system_error(path, "cannot flush");
  return core::sync_folder(root_);
}

void PartialFiles::remove(const std::string& trial_id) const noexcept {
  ::unlink(path_of(trial_id).c_str());
}

std::vector<std::string> PartialFiles::ids() const {
  std::vector<std::string> out;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(root_, failure)) {
    const std::string id = entry.path().stem().string();
    if (entry.path().extension() == ".part" && core::is_id(id)) out.push_back(id);
  }
  return out;
}

core::Result<std::string> file_sha256(const fs::path& path) {
  core::Sha256 hash;
  TRY(each_piece(path, [&](core::ByteView piece) { return hash.add(piece), true; }));
  return hash.hex();
}

}  // namespace store
}  // namespace tractus
