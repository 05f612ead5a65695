#include "server/api/stored_zip.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>

#include "core/try.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Result;

constexpr std::uint64_t kMax16 = 0xFFFF, kMax32 = 0xFFFF'FFFF;
constexpr std::uint64_t kNeedsPlain = 20, kNeedsZip64 = 45;  ///< versions of the format, times ten
constexpr std::uint64_t kMadeByUnix = 3u << 8 | kNeedsZip64;
constexpr std::uint64_t kChecksumBehind = 1u << 3;
constexpr std::uint64_t kFirstDay = 1u << 5 | 1u;  ///< 1980-01-01, the format's first
constexpr std::uint64_t kRegularFile = std::uint64_t{0100644} << 16;
constexpr std::size_t kPieceOfZip_bytes = 256 << 10;

/// Little-endian fields, one after the other.
class Fields {
 public:
  Fields& u16(std::uint64_t value) { return put(value, 2); }
  Fields& u32(std::uint64_t value) { return put(value, 4); }
  Fields& u64(std::uint64_t value) { return put(value, 8); }
  Fields& text(const std::string& value) { return out_ += value, *this; }
  std::string take() { return std::move(out_); }

 private:
  Fields& put(std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) out_ += static_cast<char>(value >> (8 * i) & 0xFF);
    return *this;
  }
  std::string out_;
};

bool is_large(std::uint64_t value) { return value >= kMax32; }
std::uint64_t needs(bool zip64) { return zip64 ? kNeedsZip64 : kNeedsPlain; }

std::uint32_t crc32_of(std::uint32_t before, std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

/// Makes all of an entry's content. Errors: also unavailable once called off.
Result<std::uint32_t> checksum_of(EntryContent& content, std::uint64_t size,
                                  const std::function<bool()>& called_off) {
  std::uint32_t crc = 0;
  std::string bytes;
  for (std::uint64_t made = 0; made < size; made += bytes.size()) {
    if (called_off && called_off())
      return Error{Errc::unavailable, "the client no longer waits for the zip"};
    bytes.clear();
    TRY(content.append_to(bytes));
    if (bytes.empty()) return Error{Errc::corrupt, "an entry of the zip ends before its size"};
    crc = crc32_of(crc, bytes);
  }
  return crc;
}

}  // namespace

StoredZip::StoredZip(std::vector<StoredEntry> entries)
    : entries_(std::move(entries)), begins_{0}, checksums_(entries_.size()) {
  for (std::size_t i = 0; i < entries_.size(); ++i)
    begins_.push_back(begins_[i] + header(i).size() + entries_[i].size + descriptor(i, 0).size());
  for (std::size_t i = 0; i < entries_.size(); ++i)
    directory_bytes_ += directory_record(i, 0).size();
}

std::uint64_t StoredZip::size() const {
  return directory_begin() + directory_bytes_ + end_of_directory().size();
}

std::size_t StoredZip::entry_at(std::uint64_t at) const {
  return static_cast<std::size_t>(std::ranges::upper_bound(begins_, at) - begins_.begin()) - 1;
}

/// APPNOTE 4.3.7; with bit 3 checksum and sizes are zero here, and a ZIP64 field (4.5.3) says that
/// the descriptor has sizes of eight bytes.
std::string StoredZip::header(std::size_t entry) const {
  const StoredEntry& one = entries_[entry];
  const bool large = is_large(one.size);
  const std::uint64_t unknown = large ? kMax32 : 0;
  Fields out;
  out.u32(0x04034b50).u16(needs(large)).u16(kChecksumBehind).u16(0).u16(0).u16(kFirstDay);
  out.u32(0).u32(unknown).u32(unknown).u16(one.name.size()).u16(large ? 20 : 0).text(one.name);
  if (large) out.u16(1).u16(16).u64(0).u64(0);
  return out.take();
}

/// APPNOTE 4.3.9.
std::string StoredZip::descriptor(std::size_t entry, std::uint32_t crc32) const {
  const std::uint64_t size = entries_[entry].size;
  Fields out;
  out.u32(0x08074b50).u32(crc32);
  if (is_large(size)) return out.u64(size).u64(size).take();
  return out.u32(size).u32(size).take();
}

/// APPNOTE 4.3.12; the ZIP64 field has what does not fit into four bytes, in this order.
std::string StoredZip::directory_record(std::size_t entry, std::uint32_t crc32) const {
  const StoredEntry& one = entries_[entry];
  const std::uint64_t begin = begins_[entry];
  Fields large;
  if (is_large(one.size)) large.u64(one.size).u64(one.size);
  if (is_large(begin)) large.u64(begin);
  const std::string extra = large.take();
  const std::uint64_t size = std::min(one.size, kMax32);
  Fields out;
  out.u32(0x02014b50).u16(kMadeByUnix).u16(needs(!extra.empty())).u16(kChecksumBehind);
  out.u16(0).u16(0).u16(kFirstDay).u32(crc32).u32(size).u32(size).u16(one.name.size());
  out.u16(extra.empty() ? 0 : extra.size() + 4).u16(0).u16(0).u16(0).u32(kRegularFile);
  out.u32(std::min(begin, kMax32)).text(one.name);
  if (!extra.empty()) out.u16(1).u16(extra.size()).text(extra);
  return out.take();
}

/// APPNOTE 4.3.14 and 4.3.15 where needed, 4.3.16 always.
std::string StoredZip::end_of_directory() const {
  const std::uint64_t count = entries_.size(), begin = directory_begin();
  Fields out;
  if (count >= kMax16 || is_large(directory_bytes_) || is_large(begin)) {
    out.u32(0x06064b50).u64(44).u16(kMadeByUnix).u16(kNeedsZip64).u32(0).u32(0);
    out.u64(count).u64(count).u64(directory_bytes_).u64(begin);
    out.u32(0x07064b50).u32(0).u64(begin + directory_bytes_).u32(1);
  }
  const std::uint64_t few = std::min(count, kMax16);
  out.u32(0x06054b50).u16(0).u16(0).u16(few).u16(few);
  return out.u32(std::min(directory_bytes_, kMax32)).u32(std::min(begin, kMax32)).u16(0).take();
}

std::optional<std::uint32_t> StoredZip::checksum(std::size_t entry) const {
  const std::lock_guard held(mutex_);
  return checksums_[entry];
}

Result<void> StoredZip::note_checksum(std::size_t entry, std::uint32_t crc32) {
  const std::lock_guard held(mutex_);
  if (checksums_[entry].value_or(crc32) != crc32)
    return Error{Errc::corrupt, entries_[entry].name + ": its content changed"};
  checksums_[entry] = crc32;
  return {};
}

Result<void> note_checksums_before(StoredZip& zip, std::size_t entry, const OpenEntry& open,
                                   const std::function<bool()>& called_off) {
  for (std::size_t i = 0; i < entry; ++i) {
    if (zip.checksum(i)) continue;
    auto content = TRY(open(i));
    const auto crc = TRY(checksum_of(*content, zip.entries()[i].size, called_off));
    TRY(zip.note_checksum(i, crc));
  }
  return {};
}

StoredZipSource::StoredZipSource(std::shared_ptr<StoredZip> zip, OpenEntry open,
                                 std::uint64_t first, std::uint64_t size)
    : zip_(std::move(zip)), open_(std::move(open)), left_(size) {
  const bool in_directory = first >= zip_->directory_begin();
  entry_ = in_directory ? zip_->entries().size() : zip_->entry_at(first);
  skip_ = first - (in_directory ? zip_->directory_begin() : zip_->begin_of(entry_));
}

Result<void> StoredZipSource::read(std::string& piece) {
  piece.clear();
  while (left_ > 0 && piece.size() < kPieceOfZip_bytes) TRY(add_part(piece));
  return {};
}

Result<void> StoredZipSource::add_part(std::string& piece) {
  const std::size_t entries = zip_->entries().size();
  if (entry_ >= 2 * entries) return add(zip_->end_of_directory(), piece), Result<void>();
  if (entry_ >= entries) {
    const std::size_t of = entry_++ - entries;
    const auto crc = zip_->checksum(of);
    core::require(crc.has_value(), "the checksums are known before the directory");
    return add(zip_->directory_record(of, *crc), piece), Result<void>();
  }
  switch (part_) {
    case Part::header:
      content_ = TRY(open_(entry_));
      made_ = 0, crc32_ = 0, part_ = Part::content;
      add(zip_->header(entry_), piece);
      return {};
    case Part::content:
      return add_content(piece);
    case Part::descriptor:
      content_.reset();
      TRY(zip_->note_checksum(entry_, crc32_));
      add(zip_->descriptor(entry_++, crc32_), piece);
      part_ = Part::header;
      return {};
  }
  return {};
}

Result<void> StoredZipSource::add_content(std::string& piece) {
  const StoredEntry& one = zip_->entries()[entry_];
  bytes_.clear();
  TRY(content_->append_to(bytes_));
  made_ += bytes_.size();
  if (made_ > one.size || (bytes_.empty() && made_ < one.size))
    return Error{Errc::corrupt, fmt::format("{}: {} bytes were expected, its content has {}",
                                            one.name, one.size, made_)};
  if (bytes_.empty()) part_ = Part::descriptor;
  crc32_ = crc32_of(crc32_, bytes_);
  add(bytes_, piece);
  return {};
}

void StoredZipSource::add(std::string_view bytes, std::string& piece) {
  const auto skipped = std::min<std::uint64_t>(skip_, bytes.size());
  skip_ -= skipped;
  bytes.remove_prefix(skipped);
  bytes = bytes.substr(0, left_);
  piece += bytes;
  left_ -= bytes.size();
}

}  // namespace api
}  // namespace tractus
