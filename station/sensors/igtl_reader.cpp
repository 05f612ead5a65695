#include "station/sensors/igtl_reader.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace tractus {
namespace sensors {
namespace {
using core::Errc;
using core::Error;

constexpr std::uint64_t kMostPassed = 1ull << 32;  // a longer message is none
constexpr std::array<std::string_view, 4> kRead{"TRANSFORM", "TDATA", "QTDATA", "STATUS"};
}  // namespace

void IgtlReader::add(std::span<const std::byte> bytes) {
  const auto passed = std::size_t(std::min<std::uint64_t>(passing_, bytes.size()));
  passing_ -= passed;
  held_.erase(held_.begin(), held_.begin() + std::ptrdiff_t(taken_));
  taken_ = 0;
  held_.insert(held_.end(), bytes.begin() + std::ptrdiff_t(passed), bytes.end());
}

core::Result<std::optional<std::vector<TrackedPose>>> IgtlReader::next() {
  const std::optional<std::vector<TrackedPose>> more_to_come;
  const auto rest = std::span(held_).subspan(taken_);
  if (rest.size() < kIgtlHeaderBytes) return more_to_come;
  const auto header = parse_igtl_header(rest);
  const bool read = header && std::ranges::find(kRead, header->type) != kRead.end();
  if (!header || header->body_bytes > (read ? kIgtlMostBytes : kMostPassed))
    return Error{Errc::bad_input, "what the motion capture sends is not OpenIGTLink"};
  const std::size_t there = rest.size() - kIgtlHeaderBytes;
  if (!read) {
    const auto now = std::size_t(std::min<std::uint64_t>(header->body_bytes, there));
    taken_ += kIgtlHeaderBytes + now;
    passing_ = header->body_bytes - now;
    return std::optional(std::vector<TrackedPose>());
  }
  const auto size = std::size_t(header->body_bytes);
  if (there < size) return more_to_come;
  taken_ += kIgtlHeaderBytes + size;
  const auto body = rest.subspan(kIgtlHeaderBytes, size);
  if (header->crc != crc64(body)) {
    ++damaged_;
    return std::optional(std::vector<TrackedPose>());
  }
  if (auto status = parse_igtl_status(*header, body); status && status->code != 1)
    complaint_ = std::move(status);
  return std::optional(parse_igtl_body(*header, body));
}

}  // namespace sensors
}  // namespace tractus
