#include "volume/io/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/try.hpp"
#include "volume/io/canvas.hpp"

namespace tractus {
namespace volume_io {
using math::Vec2;
namespace {

constexpr int kGap_px = 8, kCaption_px = 28, kText_px = 16;
constexpr Colour kGround{10, 14, 28}, kPaper{24, 26, 32}, kInk{235, 235, 235}, kCross{70, 110, 150};

/// A plane of the patient and how it is laid on the picture.
struct Plane {
  const char* name;
  int normal;                          ///< axis of V the slice is perpendicular to
  Vec3 right, down;                    ///< of the picture, unit vectors of V
  std::array<const char*, 4> letters;  ///< left, right, top, bottom
};

/// Radiologists' convention: seen from the feet, from the front, from the patient's left.
const std::array<Plane, 3>& planes() {
  static const std::array<Plane, 3> kPlanes = {
      Plane{"axial", 2, {1, 0, 0}, {0, 1, 0}, {"R", "L", "A", "P"}},
      Plane{"coronal", 1, {1, 0, 0}, {0, 0, -1}, {"R", "L", "S", "I"}},
      Plane{"sagittal", 0, {0, 1, 0}, {0, 0, -1}, {"A", "P", "S", "I"}}};
  return kPlanes;
}

/// Both corners of the volume's box in V, edges of voxels included.
std::array<Vec3, 2> bounds_of(const volume::Geometry& g) {
  Vec3 low = Vec3::Constant(INFINITY), high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 index;
    for (int a = 0; a < 3; ++a)
      index[a] = (corner >> a & 1) ? g.dims[static_cast<std::size_t>(a)] - 0.5 : -0.5;
    low = low.cwiseMin(g.position_of(index));
    high = high.cwiseMax(g.position_of(index));
  }
  return {low, high};
}

/// One slice's square on the canvas.
class Panel {
 public:
  Panel(const Plane& plane, const Vec3& middle, double pixel_m, const Frame& frame)
      : plane_(plane), middle_(middle), pixel_m_(pixel_m), frame_(frame) {}

  Vec2 on_picture(const Vec3& p_V_m) const {
    const Vec3 d = (p_V_m - middle_) / pixel_m_;
    return {frame_.left + frame_.width / 2.0 + d.dot(plane_.right),
            frame_.top + frame_.height / 2.0 + d.dot(plane_.down)};
  }
  void draw_slice(Canvas& canvas, const volume::Volume& v, const Window& window) const;
  void draw_marks(Canvas& canvas, const Vec3& at_m) const;
  void draw(Canvas& canvas, const Overlay& overlay) const;

 private:
  void draw_scale_bar(Canvas& canvas) const;
  void draw_arrow(Canvas& canvas, const Vec2& from, const Vec2& to, Colour colour) const;
  void draw_circle(Canvas& canvas, const Overlay& overlay) const;

  const Plane& plane_;
  Vec3 middle_;
  double pixel_m_;
  Frame frame_;
};

void Panel::draw_slice(Canvas& canvas, const volume::Volume& v, const Window& window) const {
  const double black = window.centre - window.width / 2.0;
  for (int y = 0; y < frame_.height; ++y)
    for (int x = 0; x < frame_.width; ++x) {
      const Vec3 p = middle_ + pixel_m_ * ((x + 0.5 - frame_.width / 2.0) * plane_.right +
                                           (y + 0.5 - frame_.height / 2.0) * plane_.down);
      const Vec3 at = v.geometry.index_of(p);
      bool inside = true;
      for (int a = 0; a < 3; ++a)
        inside =
            inside && at[a] >= -0.5 && at[a] <= v.geometry.dims[static_cast<std::size_t>(a)] - 0.5;
      if (!inside) continue;
      const auto grey = static_cast<std::uint8_t>(
          std::clamp(255.0 * (v.value_at(p) - black) / window.width, 0.0, 255.0));
      canvas.put(frame_.left + x, frame_.top + y, {grey, grey, grey});
    }
}

void Panel::draw_marks(Canvas& canvas, const Vec3& at_m) const {
  const Vec2 at = on_picture(at_m);
  const double l = frame_.left, t = frame_.top, r = l + frame_.width, b = t + frame_.height,
               gap = 14.0;
  for (const auto& [from, to] : {std::pair{Vec2(l, at.y()), Vec2(at.x() - gap, at.y())},
                                 {Vec2(at.x() + gap, at.y()), Vec2(r, at.y())},
                                 {Vec2(at.x(), t), Vec2(at.x(), at.y() - gap)},
                                 {Vec2(at.x(), at.y() + gap), Vec2(at.x(), b)}})
    canvas.line(from, to, 0.8, kCross, frame_);
  const double x = (l + r) / 2, y = (t + b) / 2;
  canvas.text({l + 5, y}, plane_.letters[0], kText_px + 4, kInk, {-1, 0}, frame_);
  canvas.text({r - 5, y}, plane_.letters[1], kText_px + 4, kInk, {1, 0}, frame_);
  canvas.text({x, t + 5}, plane_.letters[2], kText_px + 4, kInk, {0, -1}, frame_);
  canvas.text({x, b - 5}, plane_.letters[3], kText_px + 4, kInk, {0, 1}, frame_);
  const Frame whole{0, 0, canvas.width(), canvas.height()};
  canvas.text({x, b + kCaption_px / 2.0},
              fmt::format("{}, {} = {:.1f} mm", plane_.name, "xyz"[plane_.normal],
                          at_m[plane_.normal] * 1e3),
              kText_px, kInk, {0, 0}, whole);
  draw_scale_bar(canvas);
}

void Panel::draw_scale_bar(Canvas& canvas) const {
  double length_mm = 1.0;
  for (const double candidate : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0})
    if (candidate * 1e-3 / pixel_m_ <= frame_.width / 4.0) length_mm = candidate;
  const double length_px = length_mm * 1e-3 / pixel_m_;
  const Vec2 from(frame_.left + 14.0, frame_.top + frame_.height - 14.0),
      to = from + Vec2(length_px, 0);
  canvas.line(from, to, 4.0, {0, 0, 0}, frame_);
  canvas.line(from, to, 2.0, kInk, frame_);
  for (const Vec2& end : {from, to})
    canvas.line(end - Vec2(0, 4), end + Vec2(0, 4), 2.0, kInk, frame_);
  canvas.text((from + to) / 2 - Vec2(0, 7), fmt::format("{:g} mm", length_mm), kText_px - 2, kInk,
              {0, 1}, frame_);
}

void Panel::draw_arrow(Canvas& canvas, const Vec2& from, const Vec2& to, Colour colour) const {
  canvas.line(from, to, 2.0, colour, frame_);
  const Vec2 along = to - from;
  if (along.norm() < 3.0)
    return canvas.disc(to, 3.5, colour, frame_);  // it points at the reader, or away
  const Vec2 back = -along.normalized() * 11.0, side(-back.y() * 0.45, back.x() * 0.45);
  canvas.line(to, to + back + side, 2.0, colour, frame_);
  canvas.line(to, to + back - side, 2.0, colour, frame_);
}

void Panel::draw_circle(Canvas& canvas, const Overlay& overlay) const {
  const Vec3 along = overlay.to_m - overlay.from_m;
  const Vec3 normal = along.norm() > 0.0 ? along.normalized() : Vec3(Vec3::Unit(plane_.normal));
  const Vec3 u = normal.unitOrthogonal(), w = normal.cross(u);
  constexpr int kCorners = 72;
  const auto corner = [&](int n) {
    const double angle = 2.0 * std::numbers::pi * n / kCorners;
    return on_picture(overlay.from_m +
                      overlay.radius_m * (std::cos(angle) * u + std::sin(angle) * w));
  };
  for (int n = 0; n < kCorners; ++n)
    canvas.line(corner(n), corner(n + 1), 1.6, overlay.colour, frame_);
}

void Panel::draw(Canvas& canvas, const Overlay& overlay) const {
  const Vec2 from = on_picture(overlay.from_m), to = on_picture(overlay.to_m);
  Vec2 label_at = to;
  switch (overlay.kind) {
    case Overlay::Kind::line:
      canvas.line(from, to, 2.0, overlay.colour, frame_);
      break;
    case Overlay::Kind::arrow:
      draw_arrow(canvas, from, to, overlay.colour);
      break;
    case Overlay::Kind::circle:
      draw_circle(canvas, overlay);
      label_at = from;
      break;
    case Overlay::Kind::label:
      canvas.disc(from, 3.0, overlay.colour, frame_);
      label_at = from;
      break;
  }
  if (overlay.text.empty()) return;
  const bool leftward = overlay.kind == Overlay::Kind::arrow && to.x() < from.x() - 3.0;
  canvas.text(label_at + Vec2(leftward ? -7 : 7, 0), overlay.text, kText_px - 2, overlay.colour,
              {leftward ? 1 : -1, 0}, frame_);
}

core::Result<void> check(const volume::Volume& v, const Vec3& at_m, const PictureOptions& o) {
  const auto wrong = [](std::string why) {
    return core::Error{core::Errc::out_of_range, "picture: " + why};
  };
  const auto [low, high] = bounds_of(v.geometry);
  if (!at_m.allFinite() || (at_m - low).minCoeff() < 0.0 || (high - at_m).minCoeff() < 0.0)
    return wrong(fmt::format(
        "the point {:.1f}, {:.1f}, {:.1f} mm lies outside the volume, which spans {:.1f} … {:.1f}, "
        "{:.1f} … {:.1f}, {:.1f} … {:.1f} mm",
        at_m.x() * 1e3, at_m.y() * 1e3, at_m.z() * 1e3, low.x() * 1e3, high.x() * 1e3,
        low.y() * 1e3, high.y() * 1e3, low.z() * 1e3, high.z() * 1e3));
  if (o.panel_px < 64 || o.panel_px > 4096)
    return wrong(fmt::format("panels of {} pixels, 64 to 4096 are drawn", o.panel_px));
  if (!(o.window.width > 0.0) || !std::isfinite(o.window.centre))
    return wrong("the window's width must be greater than 0");
  if (!(o.extent_m >= 0.0 && o.extent_m <= 10.0))
    return wrong(fmt::format("an extent of {} m, 0 to 10 m are drawn", o.extent_m));
  return {};
}

}  // namespace

Vec3 centre_of(const volume::Geometry& g) {
  return g.position_of(Vec3(g.dims[0] - 1, g.dims[1] - 1, g.dims[2] - 1) / 2.0);
}

core::Result<void> write_slices_png(const std::filesystem::path& path, const volume::Volume& v,
                                    const Vec3& at_m, const PictureOptions& options,
                                    std::span<const Overlay> overlays) {
  TRY(check(v, at_m, options));
  const auto [low, high] = bounds_of(v.geometry);
  const bool whole = options.extent_m == 0.0;
  const double pixel_m =
      (whole ? (high - low).maxCoeff() * 1.02 : options.extent_m) / options.panel_px;
  const int size = options.panel_px;
  Canvas canvas(3 * size + 4 * kGap_px, size + kGap_px + kCaption_px, kPaper);
  for (std::size_t n = 0; n < 3; ++n) {
    const Plane& plane = planes()[n];
    Vec3 middle = whole ? Vec3((low + high) / 2.0) : at_m;
    middle[plane.normal] = at_m[plane.normal];
    const Frame frame{kGap_px + static_cast<int>(n) * (size + kGap_px), kGap_px, size, size};
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) canvas.put(frame.left + x, frame.top + y, kGround);
    const Panel panel(plane, middle, pixel_m, frame);
    panel.draw_slice(canvas, v, options.window);
    panel.draw_marks(canvas, at_m);
    for (const Overlay& overlay : overlays) panel.draw(canvas, overlay);
  }
  return canvas.write_png(path);
}

}  // namespace volume_io
}  // namespace tractus
