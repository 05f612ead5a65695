#include "volume/io/claims.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <Eigen/SVD>
#include <algorithm>
#include <memory>

#include "core/file.hpp"
#include "core/try.hpp"

namespace tractus {
namespace volume_io {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kMaxDim = 4096;
constexpr std::int64_t kMaxVoxels = std::int64_t{1} << 31;
constexpr std::uint64_t kFreelyInflated = 256ull << 20;
constexpr std::uint64_t kMaxCompression = 200;

struct CloseGzip {
  void operator()(gzFile file) const { ::gzclose(file); }
};
using Gzip = std::unique_ptr<gzFile_s, CloseGzip>;

/// Reads what is gzip inflated and what is not as it is.
Gzip open_gzip(const fs::path& path, std::uint64_t offset) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return {};
  if (::lseek(fd, static_cast<off_t>(offset), SEEK_SET) < 0) return ::close(fd), Gzip();
  Gzip file(::gzdopen(fd, "rb"));
  if (!file) ::close(fd);
  return file;
}

}  // namespace

core::Error bad(const fs::path& path, const std::string& why) {
  return {core::Errc::bad_input, fmt::format("{}: {}", path.string(), why)};
}

core::Result<std::array<int, 3>> checked_dims(const std::array<std::int64_t, 3>& claimed,
                                              const fs::path& path, const char* where) {
  std::array<int, 3> dims{};
  std::int64_t voxels = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    if (claimed[a] < 1 || claimed[a] > kMaxDim)
      return bad(path, fmt::format("{}: axis {} has {} voxels, 1 to {} are taken", where, a + 1,
                                   claimed[a], kMaxDim));
    dims[a] = static_cast<int>(claimed[a]);
    voxels *= claimed[a];
  }
  if (voxels > kMaxVoxels)
    return bad(path, fmt::format("{}: {} × {} × {} voxels, at most {} are taken", where, dims[0],
                                 dims[1], dims[2], kMaxVoxels));
  return dims;
}

core::Result<std::uint64_t> size_of_file(const fs::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) return core::system_error(path, "cannot open");
  if (!S_ISREG(info.st_mode)) return bad(path, "not a regular file");
  return static_cast<std::uint64_t>(info.st_size);
}

core::Result<core::Bytes> first_bytes(const fs::path& path, std::size_t limit) {
  TRY(size_of_file(path));
  const Gzip file = open_gzip(path, 0);
  if (!file) return core::system_error(path, "cannot open");
  core::Bytes out(limit);
  const int n = ::gzread(file.get(), out.data(), static_cast<unsigned>(limit));
  if (n < 0) return bad(path, "its gzip stream is damaged at its start");
  out.resize(static_cast<std::size_t>(n));
  return out;
}

bool is_gzip(const fs::path& path, std::uint64_t offset) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return false;
  std::array<std::uint8_t, 2> magic{};
  const bool read = ::pread(fd, magic.data(), 2, static_cast<off_t>(offset)) == 2;
  ::close(fd);
  return read && magic[0] == 0x1f && magic[1] == 0x8b;
}

core::Result<void> check_gzip(const fs::path& path, std::uint64_t offset, std::uint64_t expected,
                              const core::Progress& progress) {
  const auto size = TRY(size_of_file(path));
  if (expected > kFreelyInflated && expected / kMaxCompression > size)
    return bad(path,
               fmt::format("{} bytes that would inflate to {}, over {} : 1, which no CT reaches",
                           size, expected, kMaxCompression));
  const Gzip file = open_gzip(path, offset);
  if (!file) return core::system_error(path, "cannot open");
  core::Bytes part(1u << 18);
  std::uint64_t done = 0;
  while (true) {
    const int n = ::gzread(file.get(), part.data(), static_cast<unsigned>(part.size()));
    int code = Z_OK;
    if (n < 0 || (n == 0 && (::gzerror(file.get(), &code), code != Z_OK)))
      return bad(path, fmt::format("its gzip stream is truncated or damaged after {} of {} bytes",
                                   done, expected));
    if (n == 0) break;
    done += static_cast<std::uint64_t>(n);
    if (done > expected)
      return bad(path,
                 fmt::format("inflates to more than the {} bytes its header declares", expected));
    if (progress && !progress(static_cast<double>(done) / static_cast<double>(expected)))
      return core::Error{core::Errc::cancelled, "reading was stopped"};
  }
  if (done < expected)
    return bad(path, fmt::format("inflates to {} bytes, its header declares {}", done, expected));
  return {};
}

core::Result<math::Mat3> straightened(const math::Mat3& columns, const fs::path& path,
                                      const char* where) {
  constexpr double kRightAngle = 1.75e-4;  // 0.01°
  const math::Mat3 gram = columns.transpose() * columns;
  if (!((gram - math::Mat3::Identity()).cwiseAbs().maxCoeff() <= kRightAngle))
    return bad(path,
               fmt::format("{}: the axes are not at right angles to one another (off by {:.3g})",
                           where, (gram - math::Mat3::Identity()).cwiseAbs().maxCoeff()));
  const Eigen::JacobiSVD<math::Mat3> svd(columns, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return math::Mat3(svd.matrixU() * svd.matrixV().transpose());
}

std::string printable(std::string text) {
  if (text.size() > 80) text = text.substr(0, 77) + "...";
  std::ranges::replace_if(
      text, [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }, '?');
  return text;
}

}  // namespace volume_io
}  // namespace tractus
