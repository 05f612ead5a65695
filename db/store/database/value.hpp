/// What goes into a statement and comes out of one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/bytes.hpp"
#include "core/named.hpp"
#include "core/result.hpp"

namespace tractus::store {

/// The five things every database of ours knows: null, bigint, double precision, text, bytea.
using Value = std::variant<std::monostate, std::int64_t, double, std::string, core::Bytes>;

/// One row of an answer. Asking a column for a type it does not hold is our bug: the schema is
/// ours.
class Row {
 public:
  explicit Row(std::vector<Value> values) : values_(std::move(values)) {}
  std::int64_t integer(std::size_t column) const;
  std::uint64_t count(std::size_t column) const;  ///< an integer ≥ 0
  bool truth(std::size_t column) const;           ///< an integer, 0 is false
  double number(std::size_t column) const;
  const std::string& text(std::size_t column) const;
  std::optional<double> number_or_null(std::size_t column) const;
  std::optional<bool> truth_or_null(std::size_t column) const;
  std::optional<std::string> text_or_null(std::size_t column) const;
  /// A text that is a word of an enum. @param what  "uploads.state", for the message. Errors:
  /// corrupt for another word.
  template <core::Named E>
  core::Result<E> word(std::size_t column, std::string_view what) const {
    if (const auto known = core::from_name<E>(text(column))) return *known;
    return unknown_word(what, text(column), core::names_listed<E>());
  }
  template <core::Named E>
  core::Result<std::optional<E>> word_or_null(std::size_t column, std::string_view what) const {
    if (!text_or_null(column)) return std::optional<E>();
    const auto found = word<E>(column, what);
    if (!found) return found.error();
    return std::optional<E>(*found);
  }
  const Value& value(std::size_t column) const;
  std::size_t size() const noexcept { return values_.size(); }

 private:
  static core::Error unknown_word(std::string_view what, const std::string& found,
                                  const std::string& allowed);
  std::vector<Value> values_;
};

using Rows = std::vector<Row>;

/// Whether every database of ours keeps this text as it is: UTF-8 (RFC 3629) without a zero.
bool is_text(std::string_view text);

inline Value bool_value(bool truth) { return std::int64_t{truth ? 1 : 0}; }
inline Value count_value(std::uint64_t count) { return static_cast<std::int64_t>(count); }
template <core::Named E>
Value name_value(E value) {
  return std::string(core::name(value));
}
template <class T>
Value or_null(const std::optional<T>& value) {
  return value ? Value(*value) : Value();
}

}  // namespace tractus::store
