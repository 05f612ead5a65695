/// Random bytes inside a PNG, so that its hash does not tell which picture it is.
#pragma once

#include "core/bytes.hpp"
#include "core/result.hpp"

namespace tractus::cases {

/// What the chunk adds beside the salt itself: length, type, keyword and its end, checksum.
constexpr std::size_t kSaltChunk_bytes = 4 + 4 + 5 + 4;

/// The picture with a text chunk "salt" of hexadecimal characters before its end (PNG
/// specification, 11.3.4.3 tEXt); it looks the same. Errors: corrupt if `png` does not begin and
/// end as a PNG.
core::Result<core::Bytes> salted_png(core::ByteView png, std::string_view salt_hex);

}  // namespace tractus::cases
