/// What one eye's picture of a volume costs: the headset's painter, without a runtime.
///
///     bench_headset [VOXELS [PIXELS [FRAMES]]]      512, 1024, 10
///
/// Reports and judges nothing: 90 pictures a second and eye are a matter of the GPU, and a software
/// renderer is named as what it is.
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "core/clock.hpp"
#include "station/headset/painter.hpp"
#include "station/view/egl_context.hpp"

namespace tractus {
namespace {

/// A cube of 120 mm: a ball of bone with a shell, a tract through its middle.
volume::Volume ball(int n) {
  volume::Volume v;
  v.geometry.dims = {n, n, n};
  v.geometry.spacing_m = math::Vec3::Constant(0.12 / n);
  v.geometry.origin_m = math::Vec3::Constant(-0.06);
  v.intercept = -1024;
  v.counts.resize(v.geometry.voxel_count());
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const math::Vec3 p = v.geometry.position_of({double(i), double(j), double(k)});
        const double r_m = p.norm();
        double value = r_m > 0.05 ? -1000.0 : r_m > 0.045 ? 1200.0 : 350.0;
        if (std::hypot(p.x(), p.y()) < 0.0025) value = -50.0;
        v.counts[v.offset(i, j, k)] = v.count_of(value);
      }
  return v;
}

unsigned texture_of(int px) {
  unsigned texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_SRGB8_ALPHA8, px, px);
  glBindTexture(GL_TEXTURE_2D, 0);
  return texture;
}

/// The left or the right eye of a head 0.4 m before the middle.
headset::Eye eye_of(int which) {
  headset::Eye eye;
  eye.X_VE.p = {which == 0 ? -0.032 : 0.032, 0.0, 0.4};
  const double out = 0.8, in = 0.7;
  eye.fov = {.left_rad = which == 0 ? -out : -in,
             .right_rad = which == 0 ? in : out,
             .up_rad = 0.75,
             .down_rad = -0.75};
  return eye;
}

int refuse(const core::Error& error) {
  std::fprintf(stderr, "%s\n", error.what.c_str());
  return 2;
}

}  // namespace

}  // namespace tractus

int main(int argc, char** argv) {
  using namespace tractus;
  const auto number = [&](int i, int fallback) { return argc > i ? std::atoi(argv[i]) : fallback; };
  const int voxels = std::clamp(number(1, 512), 16, 1024),
            px = std::clamp(number(2, 1024), 16, 4096);
  const int frames = std::clamp(number(3, 10), 1, 10'000);
  auto context = view::EglContext::make();
  if (!context) return refuse(context.error());
  const volume::Volume bone = ball(voxels);
  const auto transfer = volume::TransferFunction::bone();
  volume::Tract tract;
  tract.entry_m = {0, 0, 0.05};
  tract.axis = -math::Vec3::UnitZ();
  tract.length_m = 0.04;
  tract.radius_m = 0.0025;
  auto painter = headset::Painter::make({bone, transfer, tract, {}}, **context, px, px);
  if (!painter) return refuse(painter.error());
  const unsigned texture = texture_of(px);
  const core::MonotonicClock clock;
  std::vector<double> ms;
  for (int k = 0; k < 2 * (frames + 1); ++k) {
    const auto start = clock.now();
    const headset::Eye eye = eye_of(k % 2);
    if (auto painted = (*painter)->paint(eye, {{eye.X_VE.p.x(), 0, 0}, {}}, texture); !painted)
      return refuse(painted.error());
    glFinish();
    if (k >= 2) ms.push_back(1e-6 * double(clock.now() - start));
    if (k % 2 == 1) (*painter)->gpu_s();
  }
  std::ranges::sort(ms);
  const auto at = [&](double share) { return ms[std::size_t(share * double(ms.size() - 1))]; };
  fmt::print(
      "{}\n{}^3 voxels, {} x {} pixels: an eye's picture p50 {:.1f} ms, p99 {:.1f} ms; "
      "{:.2f} frames/s of both eyes one after the other\n",
      reinterpret_cast<const char*>(glGetString(GL_RENDERER)), voxels, px, px, at(0.5), at(0.99),
      500.0 / at(0.5));
  return 0;
}
