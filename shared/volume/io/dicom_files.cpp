#include "volume/io/dicom_files.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <memory>

#include "core/file.hpp"
#include "core/try.hpp"
#include "volume/io/claims.hpp"
#include "volume/io/dicom_layout.hpp"

namespace tractus {
namespace volume_io {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMostFile_bytes = 2ull << 30;
constexpr std::uint64_t kAlwaysInflated_bytes = 64ull << 20, kMostInflation = 100;
constexpr std::string_view kDeflated = "1.2.840.10008.1.2.1.99";

/// A preamble and the transfer syntax element, explicit little-endian; the data set follows.
core::Bytes explicit_head() {
  constexpr std::string_view kElement(
      "\x02\x00\x10\x00UI\x14\x00"
      "1.2.840.10008.1.2.1\0",
      28);
  core::Bytes out(128, std::byte{0});
  for (const std::string_view part : {std::string_view("DICM"), kElement})
    std::ranges::copy(core::bytes_of(part), std::back_inserter(out));
  return out;
}

struct EndInflation {
  void operator()(z_stream* stream) const { ::inflateEnd(stream); }
};

/// The raw deflate stream (RFC 1951) of a data set, inflated to at most `most` bytes.
core::Result<core::Bytes> inflated(core::ByteView deflated, std::uint64_t most,
                                   const fs::path& path) {
  z_stream stream{};
  if (::inflateInit2(&stream, -MAX_WBITS) != Z_OK)
    return core::Error{core::Errc::io, path.string() + ": cannot be inflated: no memory"};
  const std::unique_ptr<z_stream, EndInflation> ends(&stream);
  core::Bytes out = explicit_head(), piece(1u << 20);
  int state = Z_OK;
  while (state != Z_STREAM_END) {
    if (stream.avail_in == 0) {  // fed in parts, since zlib counts in 32 bits
      const auto part = deflated.first(std::min<std::size_t>(deflated.size(), 1u << 30));
      deflated = deflated.subspan(part.size());
      stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(part.data()));
      stream.avail_in = static_cast<unsigned>(part.size());
    }
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<unsigned>(piece.size());
    state = ::inflate(&stream, Z_NO_FLUSH);
    if (state != Z_OK && state != Z_STREAM_END)
      return bad(path, "its deflated data set is damaged or not whole");
    const std::size_t got = piece.size() - stream.avail_out;
    if (out.size() + got > most)
      return core::Error{core::Errc::too_large,
                         fmt::format("{}: inflates to over {} MiB", path.string(), most >> 20)};
    out.insert(out.end(), piece.begin(), piece.begin() + std::ptrdiff_t(got));
  }
  return out;
}

}  // namespace

core::Result<core::Bytes> DicomFiles::read(const fs::path& path) {
  auto file = TRY(core::read_file(path, kMostFile_bytes));
  const auto meta = TRY(parse_dicom_meta(file, path));
  if (meta.transfer_syntax != kDeflated) return file;
  const std::uint64_t most =
      std::min({kMostFile_bytes, left_bytes_,
                std::max(kAlwaysInflated_bytes, file.size() * kMostInflation)});
  auto out = TRY(inflated(core::ByteView(file).subspan(meta.end), most, path));
  left_bytes_ -= out.size();
  return out;
}

}  // namespace volume_io
}  // namespace tractus
