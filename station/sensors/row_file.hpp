/// A table that is on the disk while it grows: whole rows, written through at short intervals.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/clock.hpp"
#include "core/result.hpp"

namespace tractus::sensors {

/// Rows are handed to the system in one write each half second (or 64 KiB), never half a row: when
/// the program is killed, or the disk is full, the file ends with a whole row.
class RowFile {
 public:
  /// Makes the file. Errors: io, conflict (it is there).
  static core::Result<RowFile> make(const std::filesystem::path& path, std::string_view header);
  ~RowFile();
  RowFile(RowFile&& other) noexcept;
  RowFile& operator=(RowFile&&) = delete;

  /// `now` decides whether it is time to write. After a failure nothing more is written.
  void add(std::string_view row, core::Instant_ns now);
  /// Writes what waits, to the disk itself. Errors: io, of any write so far.
  core::Result<void> finish();
  bool failed() const noexcept { return error_.has_value(); }

 private:
  RowFile(std::filesystem::path path, int fd) : path_(std::move(path)), fd_(fd) {}
  void write();
  std::filesystem::path path_;
  int fd_;
  std::string waiting_;
  std::size_t size_ = 0;  ///< of the file
  core::Instant_ns written_at_ = 0;
  std::optional<core::Error> error_;
};

}  // namespace tractus::sensors
