#include "core/words.hpp"

#include <algorithm>

namespace tractus::core {
namespace {
/// Only the first byte of a character is none of these, in what is not UTF-8 too.
bool continues(char c) { return (static_cast<unsigned char>(c) & 0xc0u) == 0x80u; }
}  // namespace

std::string one_line(std::string_view text, std::size_t most) {
  std::size_t end = text.size();
  if (end > most) {
    end = most;
    while (end > 0 && continues(text[end])) --end;
  }
  std::string out(text.substr(0, end));
  for (char& c : out)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  if (end < text.size()) out += "…";
  return out;
}

std::size_t characters(std::string_view text) {
  return text.size() - static_cast<std::size_t>(std::ranges::count_if(text, continues));
}

}  // namespace tractus::core
