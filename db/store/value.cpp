#include "db/store/value.hpp"

#include "core/require.hpp"

namespace store {
namespace {
template <class T>
const T& held(const Value& value) {
  core::require(std::holds_alternative<T>(value), "a column holds the type its schema says");
  return std::get<T>(value);
}
bool is_null(const Value& value) { return std::holds_alternative<std::monostate>(value); }
}  // namespace

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

}  // namespace store
