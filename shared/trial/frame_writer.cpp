#include "trial/frame_writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>

#include "core/file.hpp"
#include "core/try.hpp"

namespace tractus {
namespace trial {
namespace fs = std::filesystem;

namespace {
fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}
}  // namespace

core::Result<Descriptor> open_locked(const fs::path& path) {
  Descriptor file(::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK));
  if (!file) return core::system_error(path, "cannot open");
  struct stat info {};
  if (::fstat(file.fd(), &info) != 0) return core::system_error(path, "cannot look at");
  if (!S_ISREG(info.st_mode))
    return core::Error{core::Errc::bad_input, fmt::format("{}: not a regular file", path.string())};
  if (::flock(file.fd(), LOCK_EX | LOCK_NB) != 0)
    return core::Error{core::Errc::conflict,
                       fmt::format("{}: is being written by someone", path.string())};
  return file;
}

core::Result<FrameWriter> FrameWriter::create(const fs::path& path, core::ByteView header_payload) {
  const fs::path beside = folder_of(path) / fmt::format(".{}.{}.part", path.filename().string(),
                                                        core::hex(core::random_bytes(4)));
  FrameWriter out(
      path, Descriptor(::open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644)));
  if (!out.file_) return core::system_error(path, "cannot create");
  core::Bytes bytes(core::bytes_of(kMagic).begin(), core::bytes_of(kMagic).end());
  const auto frame = frame_bytes(FrameType::header, 0, header_payload);
  bytes.insert(bytes.end(), frame.begin(), frame.end());
  const int fd = out.file_.fd();
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0 || !write_all(fd, bytes) || ::fsync(fd) != 0 ||
      ::renameat2(AT_FDCWD, beside.c_str(), AT_FDCWD, path.c_str(), RENAME_NOREPLACE) != 0) {
    const bool there = errno == EEXIST;
    core::Error error = core::system_error(path, "cannot write");
    ::unlink(beside.c_str());
    if (there)
      return core::Error{core::Errc::conflict,
                         fmt::format("{}: exists already; choose another name", path.string())};
    return error;
  }
  TRY(core::sync_folder(folder_of(path)));
  out.hash_.add(bytes);
  out.position_ = bytes.size();
  out.sequence_ = 1;
  return out;
}

core::Result<FrameWriter> FrameWriter::resume(Descriptor locked, FrameReader& reader) {
  FrameWriter out(reader.path(), std::move(locked));
  out.position_ = reader.offset();
  out.sequence_ = reader.next_sequence();
  out.hash_ = reader.take_hash();
  const auto end = static_cast<off_t>(out.position_);
  if (::ftruncate(out.file_.fd(), end) != 0) return core::system_error(out.path_, "cannot cut");
  if (::lseek(out.file_.fd(), end, SEEK_SET) != end)
    return core::system_error(out.path_, "cannot seek");
  return out;
}

core::Result<void> FrameWriter::append(FrameType type, core::ByteView payload) {
  core::require(!sealed_, "nothing is appended to a sealed trial");
  if (broken_)
    return core::Error{
        core::Errc::io,
        fmt::format("{}: an earlier write failed and could not be undone", path_.string())};
  const auto bytes = frame_bytes(type, sequence_, payload);
  if (!write_all(file_.fd(), bytes)) {
    core::Error error = core::system_error(path_, "cannot write");
    const auto end = static_cast<off_t>(position_);
    broken_ = ::ftruncate(file_.fd(), end) != 0 || ::lseek(file_.fd(), end, SEEK_SET) != end;
    return error;
  }
  position_ += bytes.size();
  ++sequence_;
  hash_.add(bytes);
  return {};
}

core::Result<void> FrameWriter::flush() {
  if (::fdatasync(file_.fd()) != 0) return core::system_error(path_, "cannot flush");
  return {};
}

core::Result<void> FrameWriter::seal(std::uint64_t samples) {
  core::Sha256 so_far = std::move(hash_);
  hash_ = core::Sha256();
  const auto payload = end_payload(samples, so_far.hex());
  TRY(append(FrameType::end, payload));
  sealed_ = true;
  return flush();
}

}  // namespace trial
}  // namespace tractus
