/// Pictures of a volume that a person can check by eye: three slices with orientation letters and a
/// scale bar.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "core/result.hpp"
#include "volume/volume.hpp"

namespace tractus::volume_io {

using volume::Vec3;

/// Which CT values are black and white: centre ± width / 2.
struct Window {
  double centre = 400.0;  ///< CT value
  double width = 1800.0;  ///< CT value, > 0; the defaults are the usual bone window
};

struct Colour {
  std::uint8_t red = 255, green = 255, blue = 0;
};

/// Something drawn over the slices, given in patient coordinates (V, metres) and projected along
/// each slice's normal.
struct Overlay {
  enum class Kind {
    line,    ///< from `from_m` to `to_m`
    arrow,   ///< the same, with a head at `to_m` and `text` beside it
    circle,  ///< about `from_m`, `radius_m`, in the plane perpendicular to `to_m − from_m` (an
             ///< ellipse in most slices)
    label,   ///< `text` beside a dot at `from_m`
  };
  Kind kind = Kind::line;
  Vec3 from_m = Vec3::Zero();
  Vec3 to_m = Vec3::Zero();
  double radius_m = 0.0;
  std::string text{};  ///< UTF-8, drawn beside the end of any kind when not empty
  Colour colour{};
};

/// What part of the patient is shown, and how large.
struct PictureOptions {
  Window window{};
  int panel_px = 512;     ///< height and width of the square each slice is fitted into, 64 … 4096
  double extent_m = 0.0;  ///< edge of the square shown about the point, m; 0 shows the whole volume
};

/// A row of three slices through `at_m`: axial, coronal, sagittal, in the radiologists' convention
/// (the patient's right on the picture's left; anterior up, in the sagittal slice left; superior
/// up), all at one scale. Slices lie in the patient's planes whatever the volume's directions are;
/// what lies outside the volume is dark blue. Needs no display. Errors: out_of_range (the point
/// lies outside the volume, or an option is out of range), io.
core::Result<void> write_slices_png(const std::filesystem::path& path, const volume::Volume& volume,
                                    const Vec3& at_m, const PictureOptions& options = {},
                                    std::span<const Overlay> overlays = {});

/// The centre of the volume's box, in V.
Vec3 centre_of(const volume::Geometry& geometry);

}  // namespace tractus::volume_io
