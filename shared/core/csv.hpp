/// CSV, read and written in one way: RFC 4180, and what programs make of it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace tractus::core {

/// The records of a text, one at a time.
///
/// A cell in double quotes holds separators, line breaks and doubled quotes; blanks round an
/// unquoted cell, or round the quotes, are not of it; a quote elsewhere in a cell is itself. Lines
/// end in LF or CR LF, the last one in either or nothing. A byte-order mark is passed over.
class CsvReader {
 public:
  /// Of a regular file, through one buffer: cells hold until the next record. Errors: not_found, io,
  /// bad_input.
  static Result<CsvReader> open(const std::filesystem::path& path, std::size_t most_record_bytes,
                                char separator = ',');
  /// Of bytes that outlive the cells: what was quoted is put together in place. `name` leads
  /// messages.
  CsvReader(std::span<char> text, std::string name, char separator = ',');
  ~CsvReader();
  CsvReader(CsvReader&& other) noexcept;
  CsvReader& operator=(CsvReader&&) = delete;

  /// The next record; false after the last. A blank line is a record of one empty cell.
  /// Errors: io; bad_input naming file and line: a quote that stays open, text behind a quoted
  /// cell, a record over the limit.
  Result<bool> next(std::vector<std::string_view>& cells);
  /// In which that record begins, from 1; 0 before the first.
  std::size_t line() const noexcept { return line_; }
  /// "NAME:LINE: WHY", bad_input.
  Error wrong(std::string_view why) const;

 private:
  Result<void> fill();
  Result<std::span<char>> record();

  std::string name_;
  char separator_;
  int fd_ = -1;
  std::size_t most_;
  std::vector<char> buffer_;
  std::span<char> text_;  ///< what is here and was not read: in the buffer, or the whole rest
  bool ended_ = true;     ///< no more will come into it
  std::size_t line_ = 0, next_line_ = 1;
};

/// Nothing but one empty cell?
inline bool is_blank(std::span<const std::string_view> cells) {
  return cells.size() == 1 && cells[0].empty();
}

/// The text as one cell: in quotes where it needs them.
std::string csv_cell(std::string_view text);
/// The same for a text of a person's, in a file for spreadsheets: what begins like a formula is
/// kept from being one (OWASP, CSV injection).
std::string csv_person_cell(std::string_view text);

}  // namespace tractus::core
