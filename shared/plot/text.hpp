/// Words on a picture.
#pragma once

#include <string>
#include <string_view>

namespace tractus::plot {

inline constexpr const char* kGrey = "#5b6470";  ///< labels of axes and ticks

/// Where and how a text stands; `anchor` is SVG's text-anchor.
struct Text {
  double x, y, size;
  const char* anchor = "start";
  std::string colour = kGrey;
  bool bold = false;
  std::string extra = {};  ///< further attributes, led by a blank
};

/// Text as it may stand in XML; control characters become blanks.
std::string escaped(std::string_view text);

/// A <text> element; nothing for an empty text. A symbol's index is set lower: "F_xy, N" (one
/// capital, "_", small letters).
std::string written(const Text& at, std::string_view text);

/// About how wide a text comes out, px; sans-serif letters average 0.56 of the size.
double text_width(std::string_view text, double size_px);

}  // namespace tractus::plot
