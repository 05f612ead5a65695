#include "app/stats_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/file.hpp"

namespace commands {
namespace {

constexpr std::uint64_t kLargest = 512ull << 20;

core::Error wrong(std::string what) { return {core::Errc::bad_input, std::move(what)}; }

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Cuts at commas outside quotes; quotes round a cell go. False: a quote is left open.
bool split(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  bool quoted = false;
  std::size_t start = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (line[i] != ',' || quoted)) continue;
    auto cell = trimmed(line.substr(start, i - start));
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"')
      cell = trimmed(cell.substr(1, cell.size() - 2));
    cells.push_back(cell);
    start = i + 1;
  }
  return !quoted;
}

bool missing(std::string_view cell) {
  return cell.empty() || cell == "NA" || cell == "NaN" || cell == "nan";
}

bool parse(std::string_view cell, double& value) {
  if (!cell.empty() && cell.front() == '+') cell.remove_prefix(1);
  const auto end = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return end.ec == std::errc() && end.ptr == cell.data() + cell.size() && std::isfinite(value);
}

/// Takes the next line off the front.
std::string_view next_line(std::string_view& rest) {
  const auto end = rest.find('\n');
  const auto line = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
  return line;
}

std::string shown(std::string_view text, std::size_t most = 40) {
  return std::string(text.substr(0, most)) + (text.size() > most ? "…" : "");
}

}  // namespace

std::string Table::add_row(std::size_t line, const std::vector<std::string_view>& cells,
                           bool drop_missing) {
  for (std::size_t j = 0; j < wanted_.size(); ++j) {
    if (!missing(cells[places_[j]])) continue;
    if (drop_missing) {
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

core::Result<void> Table::read_header(std::string_view line,
                                      std::vector<std::string_view>& header) {
  if (std::ranges::any_of(line, [](char c) {
        return (static_cast<unsigned char>(c) < 32 && c != '\t' && c != '\r') || c == 127;
      }))
    return wrong(name_ + ":1: this is no text file");
  if (!split(line, header) || (header.size() == 1 && header[0].empty()))
    return wrong(name_ + ":1: the header line is empty or leaves a quote open");
  for (const auto& column : wanted_) {
    const auto at = std::ranges::find(header, column);
    if (at == header.end()) {
      const auto listed = header.size() > 20
                              ? fmt::format("{} others", header.size())
                              : shown(fmt::format("{}", fmt::join(header, ", ")), 400);
      return wrong(
          fmt::format("{}: there is no column '{}'; the columns are {}", name_, column, listed));
    }
    if (std::ranges::count(header, column) > 1)
      return wrong(fmt::format("{}: column '{}' stands there twice", name_, column));
    places_.push_back(static_cast<std::size_t>(at - header.begin()));
  }
  return {};
}

core::Result<Table> Table::read(const std::filesystem::path& path,
                                std::span<const std::string> columns, bool drop_missing) {
  auto bytes = core::read_file(path, kLargest);
  if (!bytes) return bytes.error();
  Table out;
  out.name_ = path.string();
  out.bytes_ = std::move(*bytes);
  out.wanted_.assign(columns.begin(), columns.end());
  out.cells_.resize(columns.size());
  std::string_view rest = core::text_of(out.bytes_);
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  std::vector<std::string_view> header, cells;
  if (auto fine = out.read_header(next_line(rest), header); !fine) return fine.error();
  for (std::size_t line = 2; !rest.empty(); ++line) {
    const auto text = next_line(rest);
    if (trimmed(text).empty()) continue;
    if (!split(text, cells))
      return wrong(fmt::format("{}:{}: a quote stays open", out.name_, line));
    if (cells.size() != header.size())
      return wrong(fmt::format("{}:{}: {} cells, the header has {}", out.name_, line, cells.size(),
                               header.size()));
    if (const auto why = out.add_row(line, cells, drop_missing); !why.empty()) return wrong(why);
  }
  if (out.lines_.empty()) return wrong(out.name_ + ": there is no row to analyse");
  return out;
}

const std::vector<std::string_view>& Table::texts(const std::string& column) const {
  const auto at = std::ranges::find(wanted_, column);
  core::require(at != wanted_.end(), "only columns that were asked for are read");
  return cells_[static_cast<std::size_t>(at - wanted_.begin())];
}

bool Table::is_numeric(const std::string& column) const {
  double value = 0.0;
  return std::ranges::all_of(texts(column), [&](auto cell) { return parse(cell, value); });
}

core::Result<statistics::Vector> Table::numbers(const std::string& column) const {
  const auto& cells = texts(column);
  statistics::Vector out(static_cast<Eigen::Index>(cells.size()));
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (!parse(cells[i], out[static_cast<Eigen::Index>(i)]))
      return wrong(fmt::format("{}:{}: column '{}' should be a number and is '{}'", name_,
                               lines_[i], column, shown(cells[i])));
  return out;
}

}  // namespace commands
