#include "lab/io/unpacked.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <memory>
#include <string>

#include "core/try.hpp"

namespace tractus {
namespace lab_io {
namespace {

namespace fs = std::filesystem;
using core::Errc;
using core::Error;
using core::Result;

constexpr std::size_t kMostPathBytes = 1024;
constexpr std::size_t kMostNameBytes = 255;  ///< NAME_MAX of Linux
constexpr const char* kExpected = "a folder with set.json or a zip of one is expected";

struct Closes {
  void operator()(archive* reader) const { archive_read_free(reader); }
};
using Reader = std::unique_ptr<archive, Closes>;

/// What is wrong with an entry's path, or nothing. Held to before the path touches the disk.
std::string refusal(const std::string& name) {
  if (name.empty() || name.size() > kMostPathBytes) return "has no usable name";
  if (std::ranges::any_of(name, [](unsigned char c) { return c < 0x20 || c == 0x7f || c == '\\'; }))
    return "has control signs or backslashes in its name";
  const fs::path path(name);
  if (path.is_absolute() || std::ranges::find(path, fs::path("..")) != path.end())
    return "leaves the folder";
  const auto too_long = [](const fs::path& part) { return part.native().size() > kMostNameBytes; };
  if (std::ranges::any_of(path, too_long))
    return fmt::format("has a folder or file name of more than {} bytes", kMostNameBytes);
  return {};
}

/// A name as it may stand in a one-line message.
std::string shown(const std::string& name) {
  std::string out;
  for (const char c : name.substr(0, 80))
    out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  return out;
}

class Unpacking {
 public:
  Unpacking(const fs::path& zip, const fs::path& into, const UnpackLimits& limits,
            const core::Progress& progress)
      : zip_(zip), into_(into), limits_(limits), progress_(progress) {}

  Result<void> run() {
    std::error_code failure;
    size_ = fs::file_size(zip_, failure);
    reader_.reset(archive_read_new());
    archive_read_support_format_zip(reader_.get());
    if (archive_read_open_filename(reader_.get(), zip_.c_str(), 1 << 16) != ARCHIVE_OK)
      return Error{Errc::bad_input, fmt::format("{}: not a zip; {}", zip_.string(), kExpected)};
    for (;;) {
      archive_entry* entry = nullptr;
      const int got = archive_read_next_header(reader_.get(), &entry);
      if (got == ARCHIVE_EOF) break;
      if (got != ARCHIVE_OK && got != ARCHIVE_WARN) return damaged();
      TRY(take(entry));
    }
    if (files_ == 0)
      return Error{Errc::bad_input, fmt::format("{}: holds no file; {}", zip_.string(), kExpected)};
    return {};
  }

 private:
  Error damaged() const {
    const char* why = archive_error_string(reader_.get());
    return {Errc::bad_input, fmt::format("{}: cannot be unpacked: {}", zip_.string(),
                                         why ? shown(why) : "it is damaged")};
  }
  Error wrong(const std::string& name, const std::string& why) const {
    return {Errc::bad_input, fmt::format("{}: entry '{}' {}", zip_.string(), shown(name), why)};
  }

  Result<void> take(archive_entry* entry) {
    const char* raw = archive_entry_pathname(entry);
    const std::string name = raw ? raw : "";
    if (auto why = refusal(name); !why.empty()) return wrong(name, why);
    if (archive_entry_is_encrypted(entry)) return wrong(name, "is encrypted");
    const auto kind = archive_entry_filetype(entry);
    if (kind == AE_IFDIR || name.starts_with("__MACOSX/")) return {};
    if (kind != AE_IFREG || archive_entry_symlink(entry) || archive_entry_hardlink(entry))
      return wrong(name, "is not a plain file");
    if (++files_ > limits_.max_files)
      return Error{Errc::too_large,
                   fmt::format("{}: more than {} files", zip_.string(), limits_.max_files)};
    const fs::path target = into_ / name;
    std::error_code failure;
    fs::create_directories(target.parent_path(), failure);
    const int fd = ::open(target.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (fd < 0)
      return failure || errno == EEXIST || errno == EISDIR
                 ? Result<void>(wrong(name, "is there twice"))
                 : Result<void>(core::system_error(target, "cannot create"));
    auto copied = copy(fd, target);
    if (::close(fd) != 0 && copied) return core::system_error(target, "cannot write");
    return copied;
  }

  Result<void> copy(int fd, const fs::path& target) {
    std::array<char, 1 << 16> buffer;
    for (;;) {
      const la_ssize_t n = archive_read_data(reader_.get(), buffer.data(), buffer.size());
      if (n < 0) return damaged();
      if (n == 0) return {};
      bytes_ += std::uint64_t(n);
      if (bytes_ > limits_.max_bytes)
        return Error{Errc::too_large, fmt::format("{}: unpacks to more than {} MiB", zip_.string(),
                                                  limits_.max_bytes >> 20)};
      for (la_ssize_t done = 0; done < n;) {
        const ssize_t wrote = ::write(fd, buffer.data() + done, std::size_t(n - done));
        if (wrote < 0) return core::system_error(target, "cannot write");
        done += wrote;
      }
      const double read = double(archive_filter_bytes(reader_.get(), -1));
      if (progress_ && !progress_(size_ > 0 ? std::min(1.0, read / double(size_)) : 1.0))
        return Error{Errc::cancelled, "stopped"};
    }
  }

  const fs::path &zip_, &into_;
  const UnpackLimits& limits_;
  const core::Progress& progress_;
  Reader reader_;
  std::uint64_t size_ = 0, bytes_ = 0;
  std::size_t files_ = 0;
};

/// Where set.json lies: at the top, or in the only folder there.
Result<fs::path> set_folder(const fs::path& top, const fs::path& zip) {
  if (fs::exists(top / "set.json")) return top;
  std::vector<fs::path> entries;
  for (const auto& entry : fs::directory_iterator(top)) entries.push_back(entry.path());
  if (entries.size() == 1 && fs::exists(entries[0] / "set.json")) return entries[0];
  return Error{Errc::bad_input, fmt::format("{}: holds no set.json at its top or in the only "
                                            "folder there",
                                            zip.string())};
}

}  // namespace

Result<Unpacked> Unpacked::open(const fs::path& path, const UnpackLimits& limits,
                                const core::Progress& progress) {
  std::error_code failure;
  const auto status = fs::status(path, failure);
  if (fs::is_directory(status)) return Unpacked(path, std::nullopt);
  if (!fs::exists(status))
    return Error{Errc::not_found, fmt::format("{}: not there; {}", path.string(), kExpected)};
  if (!fs::is_regular_file(status))
    return Error{Errc::bad_input, fmt::format("{}: {}", path.string(), kExpected)};
  auto scratch = TRY(core::ScratchFolder::make(fs::temp_directory_path() / "tractus-set"));
  TRY(Unpacking(path, scratch.path(), limits, progress).run());
  auto folder = TRY(set_folder(scratch.path(), path));
  return Unpacked(folder, std::move(scratch));
}

}  // namespace lab_io
}  // namespace tractus
