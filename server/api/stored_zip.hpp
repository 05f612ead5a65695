/// A zip of stored (not compressed) entries that is made while it is sent. Its size and every
/// entry's place follow from the entries' names and sizes alone, so that it can be sent from any
/// byte on without what comes before. ZIP64 where a size or a place needs it.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "server/http/message.hpp"

namespace tractus::api {

struct StoredEntry {
  std::string name;        ///< ASCII
  std::uint64_t size = 0;  ///< of the content, bytes
};

/// The content of an entry, from its start.
class EntryContent {
 public:
  virtual ~EntryContent() = default;
  /// Appends some of the content, at least one byte until its end.
  virtual core::Result<void> append_to(std::string& out) = 0;
};

/// Where everything in the zip is, and the checksums of contents that were made once. The layout is
/// that of APPNOTE.TXT 6.3.10 (PKWARE): the checksum comes behind each content (general purpose bit
/// 3), because it is not known before. No times: the same entries are the same bytes. Thread-safe.
class StoredZip {
 public:
  explicit StoredZip(std::vector<StoredEntry> entries);
  const std::vector<StoredEntry>& entries() const { return entries_; }
  std::uint64_t size() const;
  std::uint64_t directory_begin() const { return begins_.back(); }
  /// The entry with the byte, between its header and its descriptor. @pre at < directory_begin()
  std::size_t entry_at(std::uint64_t at) const;
  std::uint64_t begin_of(std::size_t entry) const { return begins_[entry]; }

  std::string header(std::size_t entry) const;
  std::string descriptor(std::size_t entry, std::uint32_t crc32) const;
  std::string directory_record(std::size_t entry, std::uint32_t crc32) const;
  std::string end_of_directory() const;

  std::optional<std::uint32_t> checksum(std::size_t entry) const;
  /// Errors: corrupt if the content had another checksum before.
  core::Result<void> note_checksum(std::size_t entry, std::uint32_t crc32);

 private:
  const std::vector<StoredEntry> entries_;
  std::vector<std::uint64_t> begins_;  ///< of each entry, and of the directory
  std::uint64_t directory_bytes_ = 0;
  mutable std::mutex mutex_;  ///< guards what follows
  std::vector<std::optional<std::uint32_t>> checksums_;
};

using OpenEntry = std::function<core::Result<std::unique_ptr<EntryContent>>(std::size_t entry)>;

/// Makes the content of every entry before `entry` whose checksum is not known, for the directory.
/// Errors: those of the contents; unavailable once called off.
core::Result<void> note_checksums_before(StoredZip& zip, std::size_t entry, const OpenEntry& open,
                                         const std::function<bool()>& called_off);

/// `size` bytes of a zip from `first` on. An entry in the middle of which they begin is made from
/// its start.
class StoredZipSource : public http::BodySource {
 public:
  /// @pre the checksums of all entries before the one at `first` are known, if the bytes reach the
  /// directory
  StoredZipSource(std::shared_ptr<StoredZip> zip, OpenEntry open, std::uint64_t first,
                  std::uint64_t size);
  /// Errors: those of the contents; corrupt if a content has another size than its entry.
  core::Result<void> read(std::string& piece) override;

 private:
  enum class Part { header, content, descriptor };
  core::Result<void> add_part(std::string& piece);
  core::Result<void> add_content(std::string& piece);
  void add(std::string_view bytes, std::string& piece);

  std::shared_ptr<StoredZip> zip_;
  OpenEntry open_;
  std::size_t entry_ = 0;  ///< beyond the last: that of the directory's records, then the end
  Part part_ = Part::header;
  std::uint64_t skip_ = 0;  ///< bytes to be made and not sent
  std::uint64_t left_ = 0;  ///< bytes to be sent
  std::unique_ptr<EntryContent> content_;
  std::uint64_t made_ = 0;  ///< bytes of the content
  std::uint32_t crc32_ = 0;
  std::string bytes_;
};

}  // namespace tractus::api
