#include "trial/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "core/csv.hpp"
#include "core/try.hpp"
#include "core/words.hpp"

namespace tractus {
namespace trial {
namespace {

using core::Errc;
using core::Error;
using core::Result;

/// What is wrong with a cell as a number, or nothing.
std::string parsed(std::string_view cell, double& out) {
  if (cell.empty()) return "the cell is empty, a number is expected";
  std::string_view digits = cell;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), out);
  if (failure == std::errc::result_out_of_range)
    return fmt::format("'{}' is beyond what a number can hold", core::one_line(cell, 40));
  if (failure != std::errc{} || end != digits.data() + digits.size())
    return fmt::format("'{}' is not a number", core::one_line(cell, 40));
  if (!std::isfinite(out))
    return fmt::format("'{}' is not a finite number", core::one_line(cell, 40));
  return {};
}

std::string missing_column(std::string_view column, std::span<const std::string_view> names) {
  const std::string_view first = names[0];
  std::string hint;
  if (names.size() == 1 && first.find_first_of(";\t") != std::string_view::npos)
    hint = "; cells must be separated by commas";
  else if (first.starts_with("\xff\xfe") || first.starts_with("\xfe\xff"))
    hint = "; the text must be UTF-8, this is UTF-16";
  else if (!first.empty() && (first[0] == '-' || (first[0] >= '0' && first[0] <= '9')))
    hint = "; the first line must name the columns";
  return fmt::format("column {} is missing{}", column, hint);
}

/// Places of the asked columns in the header, or what is wrong.
std::string find_columns(std::span<const std::string_view> names,
                         std::span<const std::string_view> columns,
                         std::vector<std::size_t>& places) {
  for (const auto column : columns) {
    const auto found = std::ranges::find(names, column);
    if (found == names.end()) return missing_column(column, names);
    if (std::find(found + 1, names.end(), column) != names.end())
      return fmt::format("column {} stands there twice", column);
    places.push_back(std::size_t(found - names.begin()));
  }
  return {};
}

Error no_header(const std::filesystem::path& path) {
  return {Errc::bad_input,
          fmt::format("{}:1: the file is empty, a header is expected", path.string())};
}

}  // namespace

Result<std::size_t> read_csv(const std::filesystem::path& path,
                             std::span<const std::string_view> columns, const CsvRow& on_row,
                             const CsvLimits& limits) {
  auto reader = TRY(core::CsvReader::open(path, limits.max_line_bytes));
  std::vector<std::string_view> cells;
  if (!TRY(reader.next(cells))) return no_header(path);
  std::vector<std::size_t> places;
  if (auto why = find_columns(cells, columns, places); !why.empty()) return reader.wrong(why);
  const std::size_t width = cells.size();
  std::vector<double> values(columns.size());
  std::size_t rows = 0;
  std::optional<Error> empty_line;
  while (TRY(reader.next(cells))) {
    if (core::is_blank(cells)) {
      if (!empty_line) empty_line = reader.wrong("the line is empty, a row is expected");
      continue;
    }
    if (empty_line) return *empty_line;
    if (++rows > limits.max_rows)
      return Error{Errc::too_large,
                   reader.wrong(fmt::format("more than {} rows", limits.max_rows)).what};
    if (cells.size() != width)
      return reader.wrong(fmt::format("{} cells, the header has {}", cells.size(), width));
    for (std::size_t c = 0; c < places.size(); ++c)
      if (auto why = parsed(cells[places[c]], values[c]); !why.empty())
        return reader.wrong(fmt::format("column {}: {}", columns[c], why));
    if (auto why = on_row(reader.line(), values); !why.empty()) return reader.wrong(why);
  }
  return rows;
}

Result<std::vector<std::string>> csv_header(const std::filesystem::path& path,
                                            const CsvLimits& limits) {
  auto reader = TRY(core::CsvReader::open(path, limits.max_line_bytes));
  std::vector<std::string_view> names;
  if (!TRY(reader.next(names))) return no_header(path);
  return std::vector<std::string>(names.begin(), names.end());
}

}  // namespace trial
}  // namespace tractus
