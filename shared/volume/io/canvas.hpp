/// A picture in memory: pixels, smooth lines, text. Origin at the top left, x to the right, y down,
/// units of pixels.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "math/geometry.hpp"
#include "volume/io/picture.hpp"

namespace tractus::volume_io {

/// Drawing outside of this rectangle does nothing.
struct Frame {
  int left = 0, top = 0, width = 0, height = 0;
};

/// Where text lies against its point: -1 the point is its left or top edge, 0 its middle, 1 its
/// right or bottom edge.
struct Anchor {
  int x = 0, y = 0;
};

class Canvas {
 public:
  Canvas(int width, int height, Colour ground);
  int width() const { return width_; }
  int height() const { return height_; }

  void put(int x, int y, Colour colour) { blend(x, y, colour, 1.0); }
  /// A line with round ends; coverage is shared between neighbouring pixels.
  void line(const math::Vec2& from, const math::Vec2& to, double width_px, Colour colour,
            const Frame& frame);
  void disc(const math::Vec2& centre, double radius_px, Colour colour, const Frame& frame);
  /// UTF-8, with a dark rim so that it can be read over bone.
  void text(const math::Vec2& at, const std::string& words, int size_px, Colour colour,
            Anchor anchor, const Frame& frame);
  /// Errors: io.
  core::Result<void> write_png(const std::filesystem::path& path) const;

 private:
  void blend(int x, int y, Colour colour, double share);
  int width_, height_;
  std::vector<std::uint8_t> rgb_;  // [y][x][channel]
};

}  // namespace tractus::volume_io
