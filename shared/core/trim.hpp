/// Text without the blanks at its ends.
#pragma once

#include <string_view>

namespace tractus::core {

/// @param blanks  characters that are taken away: space and tab if not given
constexpr std::string_view trimmed(std::string_view text, std::string_view blanks = " \t") {
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace tractus::core
