#include "plot/text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/words.hpp"
#include "plot/trace.hpp"

namespace tractus {
namespace plot {
namespace {

bool is_small(char c) { return c >= 'a' && c <= 'z'; }
bool is_capital(char c) { return c >= 'A' && c <= 'Z'; }
bool is_word(char c) { return is_small(c) || is_capital(c) || (c >= '0' && c <= '9') || c == '_'; }

/// Length of the index that begins with the "_" at `at`, or 0 if that is an ordinary underscore.
std::size_t index_length(std::string_view text, std::size_t at) {
  if (at == 0 || text[at] != '_' || !is_capital(text[at - 1]) || (at > 1 && is_word(text[at - 2])))
    return 0;
  std::size_t end = at + 1;
  while (end < text.size() && is_small(text[end])) ++end;
  return end == at + 1 || (end < text.size() && is_word(text[end])) ? 0 : end - at;
}

std::string with_indices(std::string_view text) {
  std::string out;
  std::size_t plain = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const std::size_t length = index_length(text, at);
    if (length == 0) continue;
    out += escaped(text.substr(plain, at - plain));
    out +=
        fmt::format(R"(<tspan dy="2.5" font-size="78%">{}</tspan><tspan dy="-2.5">&#8203;</tspan>)",
                    text.substr(at + 1, length - 1));
    plain = at + length;
  }
  return out + escaped(text.substr(plain));
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return out;
}

std::string written(const Text& at, std::string_view text) {
  if (text.empty()) return {};
  return fmt::format(
             R"(<text x="{}" y="{}" font-size="{}" text-anchor="{}" fill="{}"{}{}>{}</text>)",
             px(at.x), px(at.y), at.size, at.anchor, at.colour,
             at.bold ? R"( font-weight="600")" : "", at.extra, with_indices(text)) +
         "\n";
}

double text_width(std::string_view text, double size_px) {
  return 0.56 * size_px * double(core::characters(text));
}

}  // namespace plot
}  // namespace tractus
