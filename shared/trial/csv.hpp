/// Columns of numbers out of a CSV file: strict, streamed, in bounded memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace tractus::trial {

struct CsvLimits {
  std::size_t max_rows = 10'000'000;
  std::size_t max_line_bytes = 65'536;
};

/// One row's numbers in the order the columns were asked for; all finite. `line` counts from 1, the
/// header's. A non-empty answer says what is wrong with the row and ends the reading.
using CsvRow = std::function<std::string(std::size_t line, std::span<const double> values)>;

/// Reads the named columns of a comma-separated file, wherever they stand; other columns may hold
/// anything.
///
/// Taken: what core::CsvReader takes, empty lines at the end. Decimal points alone. Nothing is
/// guessed: an empty cell is not zero.
///
/// Errors, each one line that begins "FILE:LINE: ": a column that is missing or stands there twice,
/// a row with more or fewer cells than the header, a cell that is empty, not a number, not finite
/// or beyond a double, an empty line between rows, those of core::CsvReader (bad_input); too many rows
/// (too_large); not_found, io.
/// @returns the number of rows.
core::Result<std::size_t> read_csv(const std::filesystem::path& path,
                                   std::span<const std::string_view> columns, const CsvRow& on_row,
                                   const CsvLimits& limits = {});

/// The names in a file's first line, as read_csv would look for them. Errors: as read_csv's for the
/// header.
core::Result<std::vector<std::string>> csv_header(const std::filesystem::path& path,
                                                  const CsvLimits& limits = {});

}  // namespace tractus::trial
