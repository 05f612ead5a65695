#include "volume/io/canvas.hpp"

#include <vtkFreeTypeTools.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/file.hpp"

namespace tractus {
namespace volume_io {
using math::Vec2;
namespace {

constexpr int kDpi = 72;  // a point is a pixel

/// Words as VTK draws them: how opaque each pixel is.
struct Glyphs {
  int width = 0, height = 0;
  std::vector<std::uint8_t> opaque;  // [y from the bottom][x]
};

Glyphs glyphs_of(const std::string& words, int size_px) {
  vtkNew<vtkTextProperty> look;
  look->SetFontFamilyToArial();
  look->SetFontSize(size_px);
  look->SetColor(1.0, 1.0, 1.0);
  vtkNew<vtkImageData> image;
  std::array<int, 2> size{};
  Glyphs out;
  if (!vtkFreeTypeTools::GetInstance()->RenderString(look, words, kDpi, image, size.data()))
    return out;
  std::array<int, 6> extent{};
  image->GetExtent(extent.data());
  out.width = std::min(size[0], extent[1] - extent[0] + 1);
  out.height = std::min(size[1], extent[3] - extent[2] + 1);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const auto* pixel = static_cast<const std::uint8_t*>(
          image->GetScalarPointer(extent[0] + x, extent[2] + y, 0));
      out.opaque.push_back(pixel[3]);
    }
  return out;
}

bool within(const Frame& frame, int x, int y) {
  return x >= frame.left && y >= frame.top && x < frame.left + frame.width &&
         y < frame.top + frame.height;
}

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 d = b - a;
  const double t =
      d.squaredNorm() > 0.0 ? std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
  return (p - a - t * d).norm();
}

}  // namespace

Canvas::Canvas(int width, int height, Colour ground) : width_(width), height_(height) {
  rgb_.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  for (int n = 0; n < width * height; ++n)
    rgb_.insert(rgb_.end(), {ground.red, ground.green, ground.blue});
}

void Canvas::blend(int x, int y, Colour colour, double share) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_ || share <= 0.0) return;
  std::uint8_t* pixel = rgb_.data() + 3 * (static_cast<std::ptrdiff_t>(y) * width_ + x);
  const std::array<std::uint8_t, 3> wanted{colour.red, colour.green, colour.blue};
  for (std::size_t c = 0; c < 3; ++c)
    pixel[c] = static_cast<std::uint8_t>(
        std::lround(pixel[c] + (wanted[c] - pixel[c]) * std::min(share, 1.0)));
}

void Canvas::line(const Vec2& from, const Vec2& to, double width_px, Colour colour,
                  const Frame& frame) {
  const double reach = width_px / 2.0 + 1.0;
  const int left = std::max(
      frame.left,
      static_cast<int>(std::floor(std::clamp(std::min(from.x(), to.x()) - reach, -1e6, 1e6))));
  const int right = std::min(
      frame.left + frame.width - 1,
      static_cast<int>(std::ceil(std::clamp(std::max(from.x(), to.x()) + reach, -1e6, 1e6))));
  const int top = std::max(
      frame.top,
      static_cast<int>(std::floor(std::clamp(std::min(from.y(), to.y()) - reach, -1e6, 1e6))));
  const int bottom = std::min(
      frame.top + frame.height - 1,
      static_cast<int>(std::ceil(std::clamp(std::max(from.y(), to.y()) + reach, -1e6, 1e6))));
  for (int y = top; y <= bottom; ++y)
    for (int x = left; x <= right; ++x)
      blend(x, y, colour,
            width_px / 2.0 + 0.5 - distance_to_segment(Vec2(x + 0.5, y + 0.5), from, to));
}

void Canvas::disc(const Vec2& centre, double radius_px, Colour colour, const Frame& frame) {
  line(centre, centre, 2.0 * radius_px, colour, frame);
}

void Canvas::text(const Vec2& at, const std::string& words, int size_px, Colour colour,
                  Anchor anchor, const Frame& frame) {
  const Glyphs glyphs = glyphs_of(words, size_px);
  const int left = static_cast<int>(std::lround(at.x() - glyphs.width * (anchor.x + 1) / 2.0));
  const int top = static_cast<int>(std::lround(at.y() - glyphs.height * (anchor.y + 1) / 2.0));
  const auto draw = [&](int dx, int dy, Colour ink) {
    for (int y = 0; y < glyphs.height; ++y)
      for (int x = 0; x < glyphs.width; ++x) {
        const int px = left + x + dx, py = top + glyphs.height - 1 - y + dy;
        if (within(frame, px, py))
          blend(px, py, ink,
                glyphs.opaque[static_cast<std::size_t>(y) * static_cast<std::size_t>(glyphs.width) +
                              static_cast<std::size_t>(x)] /
                    255.0);
      }
  };
  for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}})
    draw(dx, dy, Colour{0, 0, 0});
  draw(0, 0, colour);
}

core::Result<void> Canvas::write_png(const std::filesystem::path& path) const {
  vtkNew<vtkImageData> image;
  image->SetDimensions(width_, height_, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  for (int y = 0; y < height_; ++y)  // VTK counts rows from the bottom
    std::memcpy(image->GetScalarPointer(0, height_ - 1 - y, 0),
                rgb_.data() + static_cast<std::ptrdiff_t>(y) * width_ * 3,
                static_cast<std::size_t>(width_) * 3);
  vtkNew<vtkPNGWriter> writer;
  writer->WriteToMemoryOn();
  writer->SetInputData(image);
  writer->Write();
  vtkUnsignedCharArray* png = writer->GetResult();
  return core::write_file(
      path, std::as_bytes(
                std::span(png->GetPointer(0), static_cast<std::size_t>(png->GetNumberOfTuples()))));
}

}  // namespace volume_io
}  // namespace tractus
