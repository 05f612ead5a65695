/// How long a picture takes, drawn as in a trial.
#include <fmt/format.h>

#include "core/clock.hpp"
#include "station/app/checks.hpp"
#include "station/view/view.hpp"

namespace tractus {
namespace app {
namespace {
constexpr double kPicture_s = 0.1;  // ten pictures a second
constexpr int kSide = 64, kPictures = 10;
constexpr int kCheckWidth_px = 1280, kCheckHeight_px = 800;  // as in a trial

/// A SIMULATED block of bone, soft on one side.
volume::Volume block_of_bone() {
  volume::Volume block;
  block.geometry.dims = {kSide, kSide, kSide};
  block.geometry.spacing_m = math::Vec3::Constant(0.001);
  block.intercept = -1000.0;
  for (int n = 0; n < kSide * kSide * kSide; ++n)
    block.counts.push_back(
        static_cast<std::uint16_t>(n % kSide < kSide / 4 ? 1000 : 1400 + n % 700));
  return block;
}

volume::Tract tract_in_block() {
  volume::Tract tract;
  tract.entry_m = {0.015, 0.032, 0.032};
  tract.axis = math::Vec3::UnitX();
  tract.medial = math::Vec3::UnitY();
  tract.superior = math::Vec3::UnitZ();
  tract.length_m = 0.03;
  return tract;
}
}  // namespace

check::Finding check_display(Show show) {
  check::Finding out{.name = "display", .limit = kPicture_s, .unit = "s"};
  const volume::Volume block = block_of_bone();
  const auto transfer = volume::TransferFunction::bone();
  auto view = view::View::make({block, transfer, tract_in_block(), {}},
                               show == Show::window ? view::Mode::window : view::Mode::offscreen,
                               kCheckWidth_px, kCheckHeight_px);
  if (!view) {
    out.words = "nothing can be drawn: " + view.error().what;
    return out;
  }
  core::MonotonicClock clock;
  check::Durations took(kPictures);
  (*view)->draw({}, {});  // the first one moves the volume to the graphics card
  for (int k = 0; k < kPictures; ++k) {
    const core::Instant_ns start = clock.now();
    (*view)->draw({}, {});
    took.add(clock.now() - start);
  }
  out.value = took.quantile_s(0.9);
  out.passed = *out.value <= kPicture_s;
  out.words = fmt::format(
      "a picture of {} × {} of a volume of {}³, drawn {} the screen: {}{}", kCheckWidth_px,
      kCheckHeight_px, kSide, show == Show::window ? "on" : "off", took.text(),
      out.passed ? ""
                 : "; its graphics card or the driver is missing (--view none where nobody looks)");
  return out;
}

}  // namespace app
}  // namespace tractus
