#include "db/store/database/value.hpp"

#include <fmt/format.h>
#include <utf8.h>

#include "core/require.hpp"
#include "core/words.hpp"

namespace tractus {
namespace store {
namespace {
template <class T>
const T& held(const Value& value) {
  core::require(std::holds_alternative<T>(value), "a column holds the type its schema says");
  return std::get<T>(value);
}
bool is_null(const Value& value) { return std::holds_alternative<std::monostate>(value); }
}  // namespace

bool is_text(std::string_view text) {
  return text.find('\0') == std::string_view::npos && utf8::is_valid(text.begin(), text.end());
}

const Value& Row::value(std::size_t column) const {
  core::require(column < values_.size(), "a column asked for was selected");
  return values_[column];
}
std::int64_t Row::integer(std::size_t column) const { return held<std::int64_t>(value(column)); }
std::uint64_t Row::count(std::size_t column) const {
  core::require(integer(column) >= 0, "a count in the database is not negative");
  return static_cast<std::uint64_t>(integer(column));
}
bool Row::truth(std::size_t column) const { return integer(column) != 0; }
double Row::number(std::size_t column) const { return held<double>(value(column)); }
const std::string& Row::text(std::size_t column) const { return held<std::string>(value(column)); }
std::optional<double> Row::number_or_null(std::size_t column) const {
  return is_null(value(column)) ? std::nullopt : std::optional(number(column));
}
std::optional<bool> Row::truth_or_null(std::size_t column) const {
  return is_null(value(column)) ? std::nullopt : std::optional(truth(column));
}
std::optional<std::string> Row::text_or_null(std::size_t column) const {
  return is_null(value(column)) ? std::nullopt : std::optional(text(column));
}

core::Error Row::unknown_word(std::string_view what, const std::string& found,
                              const std::string& allowed) {
  return {core::Errc::corrupt,
          fmt::format("database: {}: '{}' is none of {}", what, core::one_line(found), allowed)};
}

}  // namespace store
}  // namespace tractus
