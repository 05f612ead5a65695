#include "volume/io/zipped.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <memory>

#include "core/file.hpp"
#include "core/try.hpp"
#include "volume/io/claims.hpp"
#include "volume/io/dicom_layout.hpp"
#include "volume/io/formats.hpp"

namespace tractus {
namespace volume_io {
namespace fs = std::filesystem;
namespace {

using core::Errc;
using core::Error;
using core::Result;

constexpr int kMostDicom = 4096, kMostEntries = 16384;
constexpr std::uint64_t kMost_bytes = 4ull << 30, kAlways_bytes = 64ull << 20;
constexpr std::uint64_t kMostRatio = 100;
constexpr std::size_t kHead_bytes = 540;  // NIfTI-2's header, the longest by which a kind is known

/// By its first bytes; a gzip stream is taken for a volume, and its reader says otherwise.
bool looks_like_volume_file(core::ByteView head) {
  const std::string_view text = core::text_of(head);
  return text.starts_with("TRACTVOL") || text.starts_with("NRRD000") ||
         text.starts_with("\x1f\x8b") || looks_like_nifti(head);
}

struct Closes {
  void operator()(archive* reader) const { archive_read_free(reader); }
};

class Unpacking {
 public:
  Unpacking(const fs::path& zip, const fs::path& into) : zip_(zip), into_(into) {}

  Result<fs::path> run() {
    const auto size = TRY(size_of_file(zip_));
    limit_bytes_ = std::min(kMost_bytes, std::max(kAlways_bytes, size * kMostRatio));
    reader_.reset(archive_read_new());
    archive_read_support_format_zip(reader_.get());
    if (archive_read_open_filename(reader_.get(), zip_.c_str(), 1 << 16) != ARCHIVE_OK)
      return bad(zip_, "not a zip");
    for (int entries = 0;; ++entries) {
      archive_entry* entry = nullptr;
      const int got = archive_read_next_header(reader_.get(), &entry);
      if (got == ARCHIVE_EOF) break;
      if (got != ARCHIVE_OK && got != ARCHIVE_WARN) return bad(zip_, "is damaged");
      if (entries >= kMostEntries)
        return Error{Errc::too_large,
                     fmt::format("{}: over {} entries", zip_.string(), kMostEntries)};
      if (archive_entry_is_encrypted(entry)) return bad(zip_, "is encrypted");
      if (archive_entry_filetype(entry) != AE_IFREG) continue;
      TRY(take());
    }
    if (slices_ == 0 && files_ == 0) return bad(zip_, "holds no DICOM, NIfTI, NRRD or .tvol file");
    if (files_ > 1 || (slices_ > 0 && files_ > 0))
      return bad(zip_, "holds several volumes: upload each in a zip of its own");
    return files_ > 0 ? into_ / kVolumeFile : into_;
  }

 private:
  static constexpr const char* kVolumeFile = "volume";

  /// The entry's next piece; empty at its end.
  Result<core::ByteView> piece() {
    const la_ssize_t n = archive_read_data(reader_.get(), buffer_.data(), buffer_.size());
    if (n < 0) return bad(zip_, "is damaged");
    bytes_ += std::uint64_t(n);
    if (bytes_ > limit_bytes_)
      return Error{Errc::too_large,
                   fmt::format("{}: unpacks to over {} MiB", zip_.string(), limit_bytes_ >> 20)};
    return core::ByteView(buffer_).first(std::size_t(n));
  }

  Result<void> take() {
    // The first piece is short when the entry is stored in small blocks: gather a head's worth.
    core::Bytes head;
    while (head.size() < kHead_bytes) {
      auto part = TRY(piece());
      if (part.empty()) break;
      head.insert(head.end(), part.begin(), part.end());
    }
    if (looks_like_dicom(head)) {
      if (++slices_ > kMostDicom)
        return Error{Errc::too_large,
                     fmt::format("{}: over {} DICOM files", zip_.string(), kMostDicom)};
      return write(head, into_ / fmt::format("{:06}.dcm", slices_));
    }
    if (!looks_like_volume_file(head) || ++files_ > 1) return {};
    return write(head, into_ / kVolumeFile);
  }

  /// The entry, of which `head` is read, as a file.
  Result<void> write(core::ByteView head, const fs::path& path) {
    std::ofstream file(path, std::ios::binary);
    const auto append = [&](core::ByteView part) {
      file.write(reinterpret_cast<const char*>(part.data()), std::streamsize(part.size()));
    };
    append(head);
    for (;;) {
      auto part = TRY(piece());
      if (part.empty()) break;
      append(part);
    }
    file.close();
    if (!file) return core::system_error(into_, "cannot write");
    return {};
  }

  const fs::path &zip_, &into_;
  std::unique_ptr<archive, Closes> reader_;
  std::array<std::byte, 1 << 16> buffer_{};
  std::uint64_t bytes_ = 0, limit_bytes_ = 0;
  int slices_ = 0, files_ = 0;
};

}  // namespace

bool is_zip(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 4> start{};
  file.read(start.data(), start.size());
  return file.gcount() == 4 && std::string_view(start.data(), 4) == "PK\x03\x04";
}

Result<fs::path> unpack_volume(const fs::path& zip, const fs::path& into) {
  std::error_code failure;
  fs::create_directories(into, failure);
  if (failure) return Error{Errc::io, into.string() + ": cannot create: " + failure.message()};
  return Unpacking(zip, into).run();
}

}  // namespace volume_io
}  // namespace tractus
