/// A CSV file as columns of text, for an analysis that names the ones it needs.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/bytes.hpp"
#include "core/result.hpp"
#include "statistics/design.hpp"

namespace commands {

/// The named columns of a comma-separated file with a header line. UTF-8 with or without byte-order
/// mark, LF or CRLF, blanks round a cell, cells in double quotes without line breaks.
class Table {
 public:
  /// Errors, one line each: not_found, io, too_large (over 512 MiB), bad_input naming the missing
  /// column and those there are, or FILE:LINE of a row with too few or too many cells, or of an
  /// empty cell (also NA, NaN) in one of `columns`. With `drop_missing` such rows are left out.
  static core::Result<Table> read(const std::filesystem::path& path,
                                  std::span<const std::string> columns, bool drop_missing);

  std::size_t rows() const { return lines_.size(); }
  std::size_t dropped() const { return dropped_; }
  /// The cells of a column that was asked for.
  const std::vector<std::string_view>& texts(const std::string& column) const;
  bool is_numeric(const std::string& column) const;
  /// Errors: bad_input naming FILE:LINE and the text that is no finite number.
  core::Result<statistics::Vector> numbers(const std::string& column) const;
  const std::string& name() const { return name_; }

 private:
  core::Result<void> read_header(std::string_view line, std::vector<std::string_view>& header);
  /// Keeps the row's wanted cells; otherwise says what is wrong.
  std::string add_row(std::size_t line, const std::vector<std::string_view>& cells,
                      bool drop_missing);
  std::string name_;
  core::Bytes bytes_;
  std::vector<std::string> wanted_;
  std::vector<std::size_t> places_;                   // in the file, one per wanted column
  std::vector<std::vector<std::string_view>> cells_;  // [wanted column][row], into bytes_
  std::vector<std::size_t> lines_;                    // of each row kept
  std::size_t dropped_ = 0;
};

}  // namespace commands
