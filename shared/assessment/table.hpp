/// A CSV file as columns of text, for an analysis that names the ones it needs.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/bytes.hpp"
#include "core/result.hpp"
#include "statistics/regression/design.hpp"

namespace tractus::assessment {

/// What to do with a row that has an empty cell (also NA, NaN) in a column that is used.
enum class Missing { refuse, drop, keep };

/// The named columns of a comma-separated file with a header line, as core::CsvReader reads it.
class Table {
 public:
  /// @param columns  those to keep; empty: all.
  /// Errors, one line each: not_found, io, too_large (over 512 MiB), bad_input naming the missing
  /// column and those there are, or FILE:LINE of a row with too few or too many cells, or of an
  /// empty cell where those are refused.
  static core::Result<Table> read(const std::filesystem::path& path,
                                  std::span<const std::string> columns, Missing missing);
  /// The same from bytes in memory; `name` leads messages.
  static core::Result<Table> parse(core::Bytes bytes, const std::string& name,
                                   std::span<const std::string> columns, Missing missing);

  std::size_t rows() const { return lines_.size(); }
  std::size_t dropped() const { return dropped_; }
  /// Names of the columns kept, in the order asked for, or of the file.
  const std::vector<std::string>& columns() const { return wanted_; }
  bool has(const std::string& column) const;
  /// The cells of a column that was asked for.
  const std::vector<std::string_view>& texts(const std::string& column) const;
  bool is_numeric(const std::string& column) const;
  /// Is the column one of numbers (true), or of labels? Errors: bad_input naming FILE:LINE of the
  /// text among numbers: a slip of the pen would make a factor of a measure.
  core::Result<bool> holds_numbers(const std::string& column) const;
  /// Errors: bad_input naming FILE:LINE and the text that is no finite number.
  core::Result<statistics::Vector> numbers(const std::string& column) const;
  const std::string& name() const { return name_; }
  /// Line of the file that row `row` stood in, from 2.
  std::size_t line(std::size_t row) const { return lines_[row]; }

  /// The rows for which `keeps` is true; none counts as dropped.
  Table filtered(const std::function<bool(std::size_t row)>& keeps) const;
  /// Some columns of it. Errors: bad_input as read() for a column that is missing, an empty cell,
  /// or no row left.
  core::Result<Table> selected(std::span<const std::string> columns, Missing missing) const;

 private:
  core::Result<void> read_header(const std::vector<std::string_view>& header);
  /// Keeps the row's wanted cells; otherwise says what is wrong.
  std::string add_row(std::size_t line, std::span<const std::string_view> cells, Missing missing);
  std::string name_;
  std::shared_ptr<const core::Bytes> bytes_;
  std::vector<std::string> wanted_;
  std::vector<std::size_t> places_;                   // in the file, one per wanted column
  std::vector<std::vector<std::string_view>> cells_;  // [wanted column][row], into bytes_
  std::vector<std::size_t> lines_;                    // of each row kept
  std::size_t dropped_ = 0;
};

/// Is the cell empty, NA or NaN?
bool is_missing(std::string_view cell);
/// The finite number that a cell is, or nothing.
std::optional<double> number_in(std::string_view cell);

}  // namespace tractus::assessment
