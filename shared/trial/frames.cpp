#include "trial/frames.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>

#include "core/file.hpp"
#include "core/try.hpp"

namespace tractus {
namespace trial {
namespace {
static_assert(std::endian::native == std::endian::little, "the file's numbers are little-endian");

constexpr std::size_t kMaxLine = 400;  // characters of a message
constexpr std::size_t kReadAhead_bytes = 64 << 10;

template <class T>
void put(std::byte* at, T value) {
  std::memcpy(at, &value, sizeof value);
}

template <class T>
T take(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

bool is_type(std::uint32_t value, bool may_pack) {
  switch (FrameType(value)) {
    case FrameType::packed:
      return may_pack;
    case FrameType::header:
    case FrameType::samples:
    case FrameType::event:
    case FrameType::end:
      return true;
  }
  return false;
}

bool all_zero(core::ByteView bytes) {
  return std::ranges::all_of(bytes, [](std::byte b) { return b == std::byte{}; });
}
}  // namespace

core::Bytes frame_bytes(FrameType type, std::uint32_t sequence, core::ByteView payload) {
  core::require(payload.size() <= kMaxPayload_bytes, "a frame's payload is at most 1 MiB");
  core::Bytes out(kFrameHeader_bytes + payload.size());
  put(out.data(), std::uint32_t(type));
  put(out.data() + 4, std::uint32_t(payload.size()));
  put(out.data() + 8, sequence);
  put(out.data() + 12, core::crc32c(payload));
  put(out.data() + 16, core::crc32c(core::ByteView(out).first(16)));
  std::ranges::copy(payload, out.begin() + kFrameHeader_bytes);
  return out;
}

core::Bytes end_payload(std::uint64_t samples, const std::string& sha256_hex) {
  core::require(core::is_sha256(sha256_hex), "a SHA-256 is 64 hexadecimal characters");
  core::Bytes out(kEndPayload_bytes);
  put(out.data(), samples);
  std::ranges::copy(*core::hex_decoded(sha256_hex), out.begin() + 8);
  return out;
}

core::Bytes json_payload(const core::Json& json) {
  const auto text = json.dump(-1, ' ', false, core::Json::error_handler_t::replace);
  const auto bytes = core::bytes_of(text);
  return {bytes.begin(), bytes.end()};
}

core::Error frame_error(core::Errc code, const std::filesystem::path& path, std::uint64_t offset,
                        const std::string& what) {
  std::string line = what.substr(0, kMaxLine);
  for (char& c : line)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return {code, fmt::format("{}: offset {}: {}", path.string(), offset, line)};
}

Descriptor::~Descriptor() {
  if (fd_ >= 0) ::close(fd_);
}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

bool write_all(int fd, core::ByteView bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

FrameReader::FrameReader(std::filesystem::path path, Descriptor file, std::uint64_t size)
    : path_(std::move(path)), file_(std::move(file)), size_(size) {}

core::Result<FrameReader> FrameReader::open(const std::filesystem::path& path,
                                            std::uint64_t max_bytes) {
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!file) return core::system_error(path, "cannot open");
  struct stat info {};
  if (::fstat(file.fd(), &info) != 0) return core::system_error(path, "cannot look at");
  if (!S_ISREG(info.st_mode))
    return core::Error{core::Errc::bad_input, fmt::format("{}: not a regular file", path.string())};
  const auto size = static_cast<std::uint64_t>(info.st_size);
  if (size > max_bytes)
    return core::Error{core::Errc::too_large, fmt::format("{}: {} bytes, at most {} are read",
                                                          path.string(), size, max_bytes)};
  FrameReader reader(path, std::move(file), size);
  std::string magic(kMagic.size(), '\0');
  const bool long_enough = size >= magic.size();
  if (long_enough) {
    TRY(reader.read(reinterpret_cast<std::byte*>(magic.data()), magic.size()));
  }
  if (!long_enough || (magic != kMagic && magic != kMagicOne))
    return frame_error(core::Errc::corrupt, path, 0,
                       "not a trial file: tractus-trial/1 or /2 is expected");
  reader.may_pack_ = magic == kMagic;
  reader.hash_.add(core::bytes_of(magic));
  return reader;
}

core::Error FrameReader::corrupt(const std::string& what) const {
  return frame_error(core::Errc::corrupt, path_, offset_, what);
}

/// Reads the next piece of the file once everything read ahead is taken.
core::Result<void> FrameReader::fill() {
  read_ahead_.resize(kReadAhead_bytes);
  ssize_t n = -1;
  do n = ::read(file_.fd(), read_ahead_.data(), read_ahead_.size());
  while (n < 0 && errno == EINTR);
  read_ahead_.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
  taken_ = 0;
  if (n < 0) return core::system_error(path_, "cannot read");
  if (n == 0) return corrupt("the file was cut while it was read");
  return {};
}

core::Result<void> FrameReader::read(std::byte* into, std::size_t count) {
  while (count > 0) {
    if (taken_ == read_ahead_.size()) TRY(fill());
    const std::size_t part = std::min(count, read_ahead_.size() - taken_);
    std::memcpy(into, read_ahead_.data() + taken_, part);
    taken_ += part;
    into += part;
    count -= part;
    position_ += part;
  }
  return {};
}

core::Result<FrameReader::Step> FrameReader::rest_of_zeros() {
  core::Bytes block(1u << 16);
  while (position_ < size_) {
    const auto part =
        std::span(block).first(std::min<std::uint64_t>(block.size(), size_ - position_));
    TRY(read(part.data(), part.size()));
    if (!all_zero(part)) return corrupt("zeros where a frame is expected");
  }
  return Step::torn;
}

core::Result<FrameReader::Step> FrameReader::next() {
  offset_ = position_;
  const std::uint64_t left = size_ - position_;
  if (left == 0) return Step::end;
  if (left < kFrameHeader_bytes) return Step::torn;
  std::array<std::byte, kFrameHeader_bytes> head{};
  TRY(read(head.data(), head.size()));
  if (all_zero(head)) return rest_of_zeros();
  if (take<std::uint32_t>(&head[16]) != core::crc32c(core::ByteView(head).first(16)))
    return corrupt("the checksum of a frame's header does not hold");
  const auto type = take<std::uint32_t>(&head[0]);
  const auto length = take<std::uint32_t>(&head[4]);
  const auto sequence = take<std::uint32_t>(&head[8]);
  if (!is_type(type, may_pack_))
    return corrupt(fmt::format("frame of unknown type {:#010x}", type));
  if (length > kMaxPayload_bytes)
    return corrupt(fmt::format("frame of {} bytes, at most {}", length, kMaxPayload_bytes));
  if (sequence != sequence_)
    return corrupt(fmt::format("frame {} where frame {} is expected", sequence, sequence_));
  type_ = FrameType(type);
  if (left - kFrameHeader_bytes < length) return Step::torn;
  payload_.resize(length);
  TRY(read(payload_.data(), length));
  if (take<std::uint32_t>(&head[12]) != core::crc32c(payload_)) {
    if (position_ == size_) return Step::damaged;
    return corrupt("the checksum of a frame's payload does not hold");
  }
  ++sequence_;
  if (type_ != FrameType::end) {
    hash_.add(head);
    hash_.add(payload_);
  }
  return Step::frame;
}

}  // namespace trial
}  // namespace tractus
