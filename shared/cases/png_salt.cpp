#include "cases/png_salt.hpp"

#include <algorithm>

namespace tractus {
namespace cases {
namespace {

constexpr std::string_view kPngSignature("\x89PNG\r\n\x1a\n", 8);
constexpr std::string_view kEnd("\0\0\0\0IEND\xae\x42\x60\x82", 12);

/// CRC-32 as the PNG specification gives it, annex D.
std::uint32_t crc32(std::string_view text) {
  std::uint32_t crc = 0xffffffffu;
  for (const char c : text) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1u) ? 0xedb88320u ^ (crc >> 1) : crc >> 1;
  }
  return crc ^ 0xffffffffu;
}

std::string big_endian(std::uint32_t value) {
  return {char(value >> 24), char((value >> 16) & 0xff), char((value >> 8) & 0xff),
          char(value & 0xff)};
}

}  // namespace

core::Result<core::Bytes> salted_png(core::ByteView png, std::string_view salt_hex) {
  const std::string_view text = core::text_of(png);
  if (!text.starts_with(kPngSignature) || !text.ends_with(kEnd))
    return core::Error{core::Errc::corrupt, "the picture does not begin and end as a PNG does"};
  const std::string body = std::string("tEXtsalt") + '\0' + std::string(salt_hex);
  std::string out(text.substr(0, text.size() - kEnd.size()));
  out += big_endian(std::uint32_t(body.size() - 4)) + body + big_endian(crc32(body));
  out += kEnd;
  const auto bytes = core::bytes_of(out);
  return core::Bytes(bytes.begin(), bytes.end());
}

}  // namespace cases
}  // namespace tractus
