#include "assessment/filter.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "assessment/report.hpp"
#include "core/trim.hpp"

namespace tractus {
namespace assessment {
namespace {

std::vector<std::string_view> split_at_and(std::string_view text) {
  std::vector<std::string_view> out;
  for (auto at = text.find(" and "); at != std::string_view::npos; at = text.find(" and ")) {
    out.push_back(text.substr(0, at));
    text.remove_prefix(at + 5);
  }
  out.push_back(text);
  return out;
}

bool is_order(const std::string& op) { return op[0] == '<' || op[0] == '>'; }

bool holds(const std::string& op, double a, double b) {
  if (op == "=") return a == b;
  if (op == "!=") return a != b;
  if (op == "<") return a < b;
  if (op == "<=") return a <= b;
  return op == ">" ? a > b : a >= b;
}

}  // namespace

core::Result<Filter> Filter::parse(const std::string& text) {
  Filter out;
  for (const auto part : split_at_and(text)) {
    const auto at = part.find_first_of("=!<>");
    const auto end = part.find_first_not_of("=!<>", at == std::string_view::npos ? 0 : at);
    if (at == std::string_view::npos || end == std::string_view::npos)
      return core::bad_input(
          fmt::format("condition '{}': COLUMN = VALUE is expected, or != < <= > >=", part));
    Condition one{std::string(core::trimmed(part.substr(0, at))),
                  std::string(part.substr(at, end - at)),
                  std::string(core::trimmed(part.substr(end))),
                  {}};
    const bool known = one.op == "=" || one.op == "!=" || one.op == "<" || one.op == "<=" ||
                       one.op == ">" || one.op == ">=";
    if (one.column.empty() || one.value.empty() || !known)
      return core::bad_input(
          fmt::format("condition '{}': COLUMN = VALUE is expected, or != < <= > >=", part));
    one.number = number_in(one.value);
    if (is_order(one.op) && !one.number)
      return core::bad_input(
          fmt::format("condition '{}': '{}' is no number to compare with", part, one.value));
    out.columns_.push_back(one.column);
    out.conditions_.push_back(std::move(one));
  }
  return out;
}

core::Result<std::vector<bool>> Filter::rows_of(const Table& table) const {
  std::vector<bool> out(table.rows(), true);
  for (const auto& one : conditions_) {
    if (!table.has(one.column))
      return core::bad_input(fmt::format("{}: there is no column '{}'", table.name(), one.column));
    const auto& cells = table.texts(one.column);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (!out[i]) continue;
      const auto cell = cells[i];
      if (one.value == "missing" || is_missing(cell)) {
        const bool equal = is_missing(cell) && one.value == "missing";
        out[i] = one.op == "=" ? equal : one.op == "!=" && one.value == "missing" && !equal;
        continue;
      }
      const auto number = number_in(cell);
      if (is_order(one.op) && !number)
        return core::bad_input(fmt::format("{}:{}: column '{}' should be a number and is '{}'",
                                           table.name(), table.line(i), one.column,
                                           cell.substr(0, 40)));
      if (number && one.number)
        out[i] = holds(one.op, *number, *one.number);
      else
        out[i] = (cell == one.value) == (one.op == "=");
    }
  }
  return out;
}

}  // namespace assessment
}  // namespace tractus
