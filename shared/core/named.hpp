/// The words of an enum, as files, messages and database rows write them: one table beside the enum,
/// read in both directions.
///
///     enum class Light { on, off };
///     constexpr auto words(Light) {
///       return std::to_array<core::Word<Light>>({{Light::on, "on"}, {Light::off, "off"}});
///     }
///     using core::name;
///
///     name(Light::on)                  // "on"
///     core::from_name<Light>("off")    // Light::off; nothing for a word that is not in the table
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/require.hpp"

namespace tractus::core {

template <class E>
struct Word {
  E value;
  std::string_view text;
};

/// An enum with a function `words(E)` in its namespace.
template <class E>
concept Named = std::is_enum_v<E> && requires(E value) {
  words(value);
};

/// Whether an enum has a value of its own here: the compiler writes others as "(Light)2".
template <auto value>
consteval bool has_own_name() {
  return std::string_view(__PRETTY_FUNCTION__).find("value = (") == std::string_view::npos;
}

/// Whether the table has every value of the enum, in order from 0.
template <Named E>
consteval bool is_whole() {
  constexpr auto table = words(E{});
  for (std::size_t i = 0; i < table.size(); ++i)
    if (table[i].value != E(i)) return false;
  return !has_own_name<E(table.size())>();
}

template <Named E>
constexpr std::string_view name(E value) {
  static_assert(is_whole<E>(), "the table has every value, in order");
  constexpr auto table = words(E{});
  require(std::size_t(value) < table.size(), "an enum holds one of its values");
  return table[std::size_t(value)].text;
}

template <Named E>
constexpr std::optional<E> from_name(std::string_view text) {
  for (const Word<E>& word : words(E{}))
    if (word.text == text) return word.value;
  return std::nullopt;
}

/// Every value, in the order of the table.
template <Named E>
constexpr auto values() {
  constexpr auto table = words(E{});
  std::array<E, table.size()> out{};
  for (std::size_t i = 0; i < table.size(); ++i) out[i] = table[i].value;
  return out;
}

/// Every word, in the order of the table.
template <Named E>
std::vector<std::string> names() {
  std::vector<std::string> out;
  for (const Word<E>& word : words(E{})) out.emplace_back(word.text);
  return out;
}

/// Every word for a message: "on, off".
template <Named E>
std::string names_listed() {
  std::string out;
  for (const Word<E>& word : words(E{})) out += (out.empty() ? "" : ", ") + std::string(word.text);
  return out;
}

}  // namespace tractus::core
