/// The field made right again after a drill of 1.5 mm radius took voxels away, against making it
/// anew: 512 × 512 × 300 voxels of 0.35 mm, one thread.
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "bench/support/report.hpp"
#include "bench/support/scene.hpp"
#include "volume/force_field.hpp"

namespace tractus {
namespace {

using math::Vec3;

constexpr double kRadius_voxels = 1.5 / 0.35;

/// Takes away what a ball-nosed drill along z covers when its tip is at voxel `tip`, from `from`
/// on; the box it changed.
volume::Box drill(volume::Volume& v, const std::array<int, 3>& tip, int from) {
  const int r = int(std::ceil(kRadius_voxels));
  const volume::Box box{{tip[0] - r, tip[1] - r, from},
                        {tip[0] + r + 1, tip[1] + r + 1, tip[2] + 1}};
  for (int k = box.begin[2]; k < box.end[2]; ++k)
    for (int j = box.begin[1]; j < box.end[1]; ++j)
      for (int i = box.begin[0]; i < box.end[0]; ++i) {
        const double behind = std::max(0.0, k - (tip[2] - kRadius_voxels));  // into the nose
        const double off = std::hypot(i - tip[0], j - tip[1]);
        if (off * off + behind * behind <= kRadius_voxels * kRadius_voxels)
          v.counts[v.offset(i, j, k)] = 0;
      }
  return box;
}

/// Largest difference of blurred opacity round the hole between the updated field and one made
/// anew.
double difference(const volume::ForceField& a, const volume::ForceField& b,
                  const std::array<int, 3>& low, const std::array<int, 3>& high) {
  double worst = 0.0;
  for (int k = low[2]; k < high[2]; ++k)
    for (int j = low[1]; j < high[1]; ++j)
      for (int i = low[0]; i < high[0]; ++i) {
        const Vec3 p = a.geometry().position_of(Vec3(i, j, k));
        worst = std::max(worst, std::abs(a.opacity(p) - b.opacity(p)));
      }
  return worst;
}

}  // namespace

}  // namespace tractus

int main(int argc, char** argv) {
  using namespace tractus;
  bench::Report report("local_update, 512 x 512 x 300, drill of 1.5 mm radius");
  volume::Volume block = bench::noise_block(512, 512, 300);
  const auto transfer = volume::TransferFunction::bone();
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  auto field = volume::ForceField::make(block, transfer, volume::FieldKind::paper);
  if (!field) return 2;
  double full_s = 1e300;
  for (int n = 0; n < 3; ++n)
    full_s = std::min(full_s, bench::seconds(1, bench::process_s, [&] {
                        field->update(block, {{0, 0, 0}, block.geometry.dims});
                      }));

  // One voxel deeper at each feed, 80 times; then the whole plunge of 28 mm at once, beside it.
  std::vector<double> feeds;
  for (int z = 101; z <= 180; ++z) {
    const volume::Box box = drill(block, {200, 210, z}, z - 1 - int(kRadius_voxels));
    feeds.push_back(bench::seconds(1, bench::process_s, [&] { field->update(block, box); }));
  }
  std::vector<double> plunges;
  for (int n = 0; n < 20; ++n) {
    const volume::Box box = drill(block, {300 + n, 210, 180}, 100);
    plunges.push_back(bench::seconds(1, bench::process_s, [&] { field->update(block, box); }));
  }
  const double feed_s = bench::quantile(feeds, 0.5), plunge_s = bench::quantile(plunges, 0.5);
  const auto anew = volume::ForceField::make(block, transfer, volume::FieldKind::paper);
  if (!anew) return 2;
  const double apart = difference(*field, *anew, {180, 190, 80}, {340, 230, 200});
  report.row("largest difference of blurred opacity to a field made anew", apart, "");
  report.must("the updated field is the field (within 1e-5)", apart <= 1e-5);
  report.row("a full preparation, memory at hand", full_s * 1e3, "ms");
  report.row("a plunge of 28 mm, median", plunge_s * 1e3, "ms");
  report.row("a feed of one voxel, median", feed_s * 1e3, "ms");
  report.at_least("plunges in the time of a full preparation", full_s / plunge_s, 100, "");
  report.at_least("feeds in the time of a full preparation", full_s / feed_s, 400, "");
  return report.finish(argc, argv);
}
