#include "assessment/table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "core/csv.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "core/words.hpp"

namespace tractus {
namespace assessment {
namespace {

constexpr std::uint64_t kLargestTable_bytes = 512ull << 20;

std::string no_column(const std::string& file, const std::string& column,
                      const std::vector<std::string_view>& header) {
  const auto listed = core::one_line(fmt::format("{}", fmt::join(header, ", ")), 2000);
  return fmt::format("{}: there is no column '{}'; the columns are {}", file, column, listed);
}

}  // namespace

bool is_missing(std::string_view cell) {
  return cell.empty() || cell == "NA" || cell == "NaN" || cell == "nan";
}

std::optional<double> number_in(std::string_view cell) {
  if (!cell.empty() && cell.front() == '+') cell.remove_prefix(1);
  double value = 0.0;
  const auto end = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (end.ec != std::errc() || end.ptr != cell.data() + cell.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

std::string Table::add_row(std::size_t line, std::span<const std::string_view> cells,
                           Missing missing) {
  for (std::size_t j = 0; j < wanted_.size() && missing != Missing::keep; ++j) {
    if (!is_missing(cells[places_[j]])) continue;
    if (missing == Missing::drop) {
      ++dropped_;
      return "";
    }
    return fmt::format("{}:{}: column '{}' has no value (--drop-missing leaves such rows out)",
                       name_, line, wanted_[j]);
  }
  for (std::size_t j = 0; j < wanted_.size(); ++j) cells_[j].push_back(cells[places_[j]]);
  lines_.push_back(line);
  return "";
}

core::Result<void> Table::read_header(const std::vector<std::string_view>& header) {
  for (const auto cell : header)
    if (std::ranges::any_of(cell, [](char c) {
          return (static_cast<unsigned char>(c) < 32 && c != '\t') || c == 127;
        }))
      return core::bad_input(name_ + ":1: this is no text file");
  if (header.empty() || core::is_blank(header))
    return core::bad_input(name_ + ":1: the header line is empty");
  if (wanted_.empty()) wanted_.assign(header.begin(), header.end());
  for (const auto& column : wanted_) {
    const auto at = std::ranges::find(header, column);
    if (at == header.end()) return core::bad_input(no_column(name_, column, header));
    if (std::ranges::count(header, column) > 1)
      return core::bad_input(fmt::format("{}: column '{}' stands there twice", name_, column));
    places_.push_back(static_cast<std::size_t>(at - header.begin()));
  }
  return {};
}

core::Result<Table> Table::read(const std::filesystem::path& path,
                                std::span<const std::string> columns, Missing missing) {
  auto bytes = TRY(core::read_file(path, kLargestTable_bytes));
  return parse(std::move(bytes), path.string(), columns, missing);
}

core::Result<Table> Table::parse(core::Bytes bytes, const std::string& name,
                                 std::span<const std::string> columns, Missing missing) {
  Table out;
  out.name_ = name;
  const auto held = std::make_shared<core::Bytes>(std::move(bytes));
  out.bytes_ = held;
  out.wanted_.assign(columns.begin(), columns.end());
  core::CsvReader reader({reinterpret_cast<char*>(held->data()), held->size()}, name);
  std::vector<std::string_view> header, cells;
  TRY(reader.next(header));
  TRY(out.read_header(header));
  out.cells_.resize(out.wanted_.size());
  while (TRY(reader.next(cells))) {
    if (core::is_blank(cells)) continue;
    if (cells.size() != header.size())
      return reader.wrong(fmt::format("{} cells, the header has {}", cells.size(), header.size()));
    if (const auto why = out.add_row(reader.line(), cells, missing); !why.empty())
      return core::bad_input(why);
  }
  if (out.lines_.empty()) return core::bad_input(out.name_ + ": there is no row to analyse");
  return out;
}

bool Table::has(const std::string& column) const {
  return std::ranges::find(wanted_, column) != wanted_.end();
}

const std::vector<std::string_view>& Table::texts(const std::string& column) const {
  const auto at = std::ranges::find(wanted_, column);
  core::require(at != wanted_.end(), "only columns that were asked for are read");
  return cells_[static_cast<std::size_t>(at - wanted_.begin())];
}

bool Table::is_numeric(const std::string& column) const {
  return std::ranges::all_of(texts(column), [&](auto cell) { return number_in(cell).has_value(); });
}

core::Result<bool> Table::holds_numbers(const std::string& column) const {
  const auto& cells = texts(column);
  const auto is_text = [](auto cell) { return !number_in(cell).has_value(); };
  const auto text = std::ranges::find_if(cells, is_text);
  if (text == cells.end()) return true;
  if (std::ranges::all_of(cells, is_text)) return false;
  return core::Error{core::Errc::bad_input,
                     fmt::format("{}:{}: column '{}' holds numbers, and here '{}'; C({}) takes all "
                                 "of them as labels",
                                 name_, lines_[static_cast<std::size_t>(text - cells.begin())],
                                 column, core::one_line(*text, 40), column)};
}

core::Result<statistics::Vector> Table::numbers(const std::string& column) const {
  const auto& cells = texts(column);
  statistics::Vector out(static_cast<Eigen::Index>(cells.size()));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto value = number_in(cells[i]);
    if (!value)
      return core::bad_input(fmt::format("{}:{}: column '{}' should be a number and is '{}'", name_,
                                         lines_[i], column, core::one_line(cells[i], 40)));
    out[static_cast<Eigen::Index>(i)] = *value;
  }
  return out;
}

Table Table::filtered(const std::function<bool(std::size_t row)>& keeps) const {
  Table out = *this;
  for (auto& column : out.cells_) column.clear();
  out.lines_.clear();
  for (std::size_t i = 0; i < rows(); ++i) {
    if (!keeps(i)) continue;
    for (std::size_t j = 0; j < cells_.size(); ++j) out.cells_[j].push_back(cells_[j][i]);
    out.lines_.push_back(lines_[i]);
  }
  return out;
}

core::Result<Table> Table::selected(std::span<const std::string> columns, Missing missing) const {
  Table out;
  out.name_ = name_;
  out.bytes_ = bytes_;
  out.wanted_.assign(columns.begin(), columns.end());
  for (const auto& column : columns) {
    const auto at = std::ranges::find(wanted_, column);
    if (at == wanted_.end())
      return core::bad_input(no_column(name_, column, {wanted_.begin(), wanted_.end()}));
    out.places_.push_back(static_cast<std::size_t>(at - wanted_.begin()));
  }
  out.cells_.resize(columns.size());
  std::vector<std::string_view> row(wanted_.size());
  for (std::size_t i = 0; i < rows(); ++i) {
    for (const std::size_t j : out.places_) row[j] = cells_[j][i];
    if (const auto why = out.add_row(lines_[i], row, missing); !why.empty())
      return core::bad_input(why);
  }
  if (out.lines_.empty()) return core::bad_input(name_ + ": there is no row to analyse");
  return out;
}

}  // namespace assessment
}  // namespace tractus
