#include "db/store/volumes/objects.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <functional>
#include <mutex>

#include "core/file.hpp"
#include "core/require.hpp"
#include "core/try.hpp"
#include "db/store/volumes/cache_limit.hpp"
#include "db/store/volumes/file_pieces.hpp"

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
core::Result<void> each_piece(const fs::path& path, const ObjectStore::Take& take) {
  auto file = TRY(FilePieces::open(path));
  for (;;) {
    const auto piece = TRY(file.next(kPiece_bytes));
    if (piece.empty()) return {};
    if (!take(piece)) return core::system_error(path, "cannot copy");
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

using Produce = std::function<core::Result<void>(const ObjectStore::Take&)>;

/// A new file of what is produced, if that has this SHA-256: written beside, flushed, renamed.
core::Result<void> write_checked(const fs::path& target, const std::string& sha256,
                                 const std::string& source, const Produce& produce) {
  const fs::path beside = target.string() + "." + core::hex(core::random_bytes(4)) + ".part";
  core::Sha256 hash;
  core::Result<void> outcome;
  {
    const Descriptor out(beside, O_WRONLY | O_CREAT | O_EXCL);
    if (!out) return core::system_error(beside, "cannot create");
    std::uint64_t offset = 0;
    bool written = true;
    outcome = produce([&](core::ByteView piece) {
      hash.add(piece);
      written = write_all(out.fd(), offset, piece);
      offset += piece.size();
      return written;
    });
    if (!written || (outcome && ::fsync(out.fd()) != 0))
      outcome = core::system_error(beside, written ? "cannot flush" : "cannot write");
  }
  if (outcome && hash.hex() != sha256)
    outcome =
        core::Error{core::Errc::corrupt, fmt::format("{}: its SHA-256 is not {}", source, sha256)};
  if (outcome && ::rename(beside.c_str(), target.c_str()) != 0)
    outcome = core::system_error(target, "cannot put in place");
  if (!outcome) {
    ::unlink(beside.c_str());
    return outcome;
  }
  return core::sync_folder(target.parent_path());
}

/// The file of a cache, its use noted.
const fs::path& used(const fs::path& path) {
  ::utimensat(AT_FDCWD, path.c_str(), nullptr, 0);
  return path;
}

}  // namespace

/// An object store, and what its cache needs.
struct Objects::Beyond {
  std::unique_ptr<ObjectStore> store;
  std::array<std::mutex, 16> fetching = {};  ///< by the first digit: an object is fetched once
  std::unique_ptr<CacheLimit> limit = {};

  std::mutex& fetch_of(const std::string& sha256) {
    return fetching[sha256.front() <= '9' ? sha256.front() - '0' : sha256.front() - 'a' + 10];
  }
};

Objects::Objects(fs::path root, std::unique_ptr<Beyond> beyond)
    : root_(std::move(root)), beyond_(std::move(beyond)) {}
Objects::~Objects() = default;
Objects::Objects(Objects&&) noexcept = default;
Objects& Objects::operator=(Objects&&) noexcept = default;

core::Result<Objects> Objects::open(const fs::path& data, std::unique_ptr<ObjectStore> beyond) {
  auto root = TRY(made_folder(data / "objects"));
  if (!beyond) return Objects(std::move(root), nullptr);
  auto kept = std::make_unique<Beyond>();
  kept->store = std::move(beyond);
  return Objects(std::move(root), std::move(kept));
}

void Objects::limit_cache(std::uint64_t most_bytes) {
  if (beyond_) beyond_->limit = std::make_unique<CacheLimit>(root_, most_bytes);
}

fs::path Objects::path_of(const std::string& sha256) const {
  core::require(core::is_sha256(sha256), "an object is named by a SHA-256");
  return root_ / sha256.substr(0, 2) / sha256.substr(2);
}

bool Objects::here(const std::string& sha256) const {
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

core::Result<fs::path> Objects::file(const std::string& sha256) const {
  const fs::path path = path_of(sha256);
  if (!beyond_) return path;
  if (here(sha256)) return used(path);
  const std::lock_guard lock(beyond_->fetch_of(sha256));
  if (here(sha256)) return used(path);
  TRY(folder_for(sha256));
  TRY(write_checked(path, sha256, "object store", [&](const ObjectStore::Take& take) {
    return beyond_->store->read(sha256, 0, std::nullopt, take);
  }));
  if (beyond_->limit) beyond_->limit->added(path);
  return path;
}

core::Result<std::optional<std::uint64_t>> Objects::size_of(const std::string& sha256) const {
  if (beyond_) return beyond_->store->size_of(sha256);
  std::error_code failure;
  const auto size = fs::file_size(path_of(sha256), failure);
  return failure ? std::nullopt : std::optional<std::uint64_t>(size);
}

core::Result<std::string> Objects::kept_sha256(const std::string& sha256) const {
  if (!beyond_) return file_sha256(path_of(sha256));
  core::Sha256 hash;
  TRY(beyond_->store->read(sha256, 0, std::nullopt,
                           [&](core::ByteView piece) { return hash.add(piece), true; }));
  return hash.hex();
}

/// What the folder has, to the place where objects are kept.
core::Result<void> Objects::put_beyond(const std::string& sha256) const {
  if (!beyond_) return {};
  const fs::path path = path_of(sha256);
  TRY(beyond_->store->put(sha256, used(path)));
  if (beyond_->limit) beyond_->limit->added(path);
  return {};
}

core::Result<std::string> Objects::put(core::ByteView bytes) const {
  const std::string sha256 = core::sha256(bytes);
  if (!here(sha256)) {
    TRY(folder_for(sha256));
    TRY(core::write_file(path_of(sha256), bytes));
  }
  TRY(put_beyond(sha256));
  return sha256;
}

core::Result<void> Objects::copy_in(const fs::path& file, const std::string& sha256) const {
  if (!here(sha256)) {
    TRY(folder_for(sha256));
    TRY(write_checked(path_of(sha256), sha256, file.string(),
                      [&](const ObjectStore::Take& take) { return each_piece(file, take); }));
  }
  return put_beyond(sha256);
}

core::Result<void> Objects::copy_from(const Objects& source, const std::string& sha256) const {
  if (beyond_) return beyond_->store->put(sha256, TRY(source.file(sha256)));
  if (here(sha256)) return {};
  if (!source.beyond_) return copy_in(source.path_of(sha256), sha256);
  TRY(folder_for(sha256));
  return write_checked(path_of(sha256), sha256, "object store", [&](const ObjectStore::Take& take) {
    return source.beyond_->store->read(sha256, 0, std::nullopt, take);
  });
}

core::Result<void> Objects::link_in(const fs::path& file, const std::string& sha256) const {
  TRY(folder_for(sha256));
  const fs::path target = path_of(sha256);
  if (::link(file.c_str(), target.c_str()) != 0 && errno != EEXIST)
    return core::system_error(target, "cannot put in place");
  TRY(core::sync_folder(target.parent_path()));
  return put_beyond(sha256);
}

core::Result<void> Objects::remove(const std::string& sha256) const {
  if (beyond_) TRY(beyond_->store->remove(sha256));
  const fs::path path = path_of(sha256);
  if (::unlink(path.c_str()) == 0) return core::sync_folder(path.parent_path());
  if (errno == ENOENT || errno == ENOTDIR) return {};
  return core::system_error(path, "cannot remove");
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
