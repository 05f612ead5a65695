#include "app/case_picture.hpp"

#include <vector>

#include "volume/io/picture.hpp"

namespace tractus {
namespace commands {
namespace {

using math::Mat3;
using math::Vec3;
using volume_io::Colour;
using volume_io::Overlay;

constexpr Colour kChannel{255, 220, 0}, kWalls{0, 220, 255}, kMiddle{0, 230, 90},
    kHole{255, 60, 60};
constexpr double kArrowFrom_m = 0.015, kArrowTo_m = 0.023, kMiddle_m = 0.035, kAround_m = 0.022,
                 kLabel_m = 0.007, kAside_m = 0.011;

/// Turns patient coordinates about a point so that the tract runs straight to the front and its
/// superior wall is up: the picture's axial, coronal and sagittal slices then follow the tract.
class Straightened {
 public:
  Straightened(const volume::Tract& tract, const Vec3& about_m) : about_(about_m) {
    const Vec3 back = -tract.axis;
    turn_.row(0) = back.cross(tract.superior).transpose();
    turn_.row(1) = back.transpose();
    turn_.row(2) = tract.superior.transpose();
  }
  Vec3 operator()(const Vec3& p) const { return about_ + turn_ * (p - about_); }
  void apply(volume::Geometry& geometry) const {
    geometry.origin_m = (*this)(geometry.origin_m);
    geometry.directions = turn_ * geometry.directions;
  }

 private:
  Vec3 about_;
  Mat3 turn_;
};

Vec3 place_of_interest(const cases::Carved& carved) {
  const volume::Tract& tract = carved.tract;
  const auto& medial = carved.walls.front();
  if (carved.breach && carved.breach->wall.wall != volume::Wall::anterior)
    return carved.breach->from_m;
  return tract.entry_m + (medial ? medial->at_m : tract.length_m / 2) * tract.axis;
}

/// Text away from a point, with a line that leads there.
void add_note(std::vector<Overlay>& out, const Vec3& at, const Vec3& beside,
              const std::string& text, Colour colour) {
  out.push_back({.kind = Overlay::Kind::line,
                 .from_m = at + beside,
                 .to_m = at,
                 .text = {},
                 .colour = colour});
  out.push_back(
      {.kind = Overlay::Kind::label, .from_m = at + beside, .text = text, .colour = colour});
}

/// The channel's edges as seen from the side and from above: lines through the corners of its
/// section.
void add_channel(std::vector<Overlay>& out, const cases::Carved& carved) {
  const volume::Tract& tract = carved.tract;
  const Vec3 mouth = tract.entry_m - carved.mouth_m * tract.axis;
  for (const int corner : {0, 1, 2, 3}) {
    const Vec3 edge = tract.radius_m * ((corner & 1 ? 1 : -1) * tract.medial +
                                        (corner & 2 ? 1 : -1) * tract.superior);
    out.push_back({.kind = Overlay::Kind::line,
                   .from_m = mouth + edge,
                   .to_m = tract.end_m() + edge,
                   .text = {},
                   .colour = kChannel});
  }
  const Vec3 beside = kLabel_m * (tract.medial + tract.superior);
  add_note(out, tract.entry_m, beside, "entry", kChannel);
}

/// Each pair of arrows stands aside, so that seen along itself it does not hide the channel.
void add_directions(std::vector<Overlay>& out, const volume::Tract& tract, const Vec3& at) {
  const auto arrow = [&](const Vec3& from, const Vec3& along, const char* text) {
    out.push_back({.kind = Overlay::Kind::arrow,
                   .from_m = from + kArrowFrom_m * along,
                   .to_m = from + kArrowTo_m * along,
                   .text = text,
                   .colour = kWalls});
  };
  const Vec3 up = kAside_m * tract.superior, out_side = -kAside_m * tract.medial;
  arrow(at + up, tract.medial, "M");
  arrow(at + up, -tract.medial, "L");
  arrow(at + out_side, tract.superior, "S");
  arrow(at + out_side, -tract.superior, "I");
  arrow(tract.end_m() - kArrowFrom_m * tract.axis + out_side - up, tract.axis, "A");
}

/// Where the midline's plane meets the slices.
void add_midline(std::vector<Overlay>& out, const cases::Carved& carved, const Vec3& at) {
  const volume::Midline& midline = carved.midline;
  const Vec3 along(-midline.left().y(), midline.left().x(), 0.0), medial = carved.tract.medial;
  const Vec3 foot = at - midline.left_of_plane_m(at) / medial.dot(midline.left()) * medial;
  out.push_back({.kind = Overlay::Kind::line,
                 .from_m = foot - kMiddle_m * along,
                 .to_m = foot + kMiddle_m * along,
                 .text = "midline",
                 .colour = kMiddle});
  out.push_back({.kind = Overlay::Kind::line,
                 .from_m = foot - Vec3(0, 0, kMiddle_m),
                 .to_m = foot + Vec3(0, 0, kMiddle_m),
                 .text = {},
                 .colour = kMiddle});
}

void add_breach(std::vector<Overlay>& out, const cases::Carved& carved) {
  const volume::Breach& breach = *carved.breach;
  const volume::Tract& tract = carved.tract;
  const Vec3 beside = kLabel_m * (-tract.axis - tract.superior);
  add_note(out, breach.centre_m, beside, std::string(volume::name(breach.wall.wall)) + " breach",
           kHole);
}

}  // namespace

core::Result<void> draw_case(const std::filesystem::path& path, volume::Volume surroundings,
                             const cases::Carved& carved) {
  const Vec3 at = place_of_interest(carved);
  std::vector<Overlay> overlays;
  add_midline(overlays, carved, at);
  add_channel(overlays, carved);
  add_directions(overlays, carved.tract, at);
  if (carved.breach) add_breach(overlays, carved);
  const Straightened straight(carved.tract, at);
  straight.apply(surroundings.geometry);
  for (Overlay& overlay : overlays) {
    overlay.from_m = straight(overlay.from_m);
    overlay.to_m = straight(overlay.to_m);
  }
  volume_io::PictureOptions options;
  options.window = {.centre = 300.0, .width = 1100.0};
  options.extent_m = carved.tract.length_m + 2 * kAround_m;
  return volume_io::write_slices_png(path, surroundings, at, options, overlays);
}

}  // namespace commands
}  // namespace tractus
