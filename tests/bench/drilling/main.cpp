/// What a burr at work costs: a chunk of 5 ms worn and its change of the field computed (the
/// worker's), and that change copied in between two ticks (the loop's), against making the field
/// anew.
#include <algorithm>

#include "bench/support/report.hpp"
#include "bench/support/scene.hpp"
#include "drilling/erosion.hpp"
#include "volume/force_field.hpp"

namespace tractus {
namespace {

constexpr double kTick_s = 0.00025, kFeed_m_s = 0.003;

/// The burr on its way into the block, button held, at full force.
trial::Sample feed(std::uint32_t tick) {
  trial::Sample sample;
  sample.tick = tick;
  sample.t_s = tick * kTick_s;
  sample.p_VH_m = {0.0, 0.0, kFeed_m_s * sample.t_s - 0.13};
  sample.force_N = {0.0f, 0.0f, -1.0f};
  sample.flags = trial::kPressed;
  return sample;
}

}  // namespace

}  // namespace tractus

int main(int argc, char** argv) {
  using namespace tractus;
  bench::Report report("drilling, burr of 1.5 mm radius in voxels of 0.35 mm");
  const auto transfer = volume::TransferFunction::bone();
  volume::Volume placed = bench::noise_block(200, 200, 240);
  placed.geometry.origin_m = math::Vec3(-0.035, -0.035, -0.010);  // the tip begins at V's origin
  auto live = volume::ForceField::make(placed, transfer, volume::FieldKind::paper);
  auto erosion = drilling::Erosion::make(placed, transfer, {}, {.length_m = 0.13});
  if (!live || !erosion) return 2;
  const double full_s = bench::seconds(3, bench::process_s, [&] {
    live->update(placed, {{0, 0, 0}, placed.geometry.dims});
  });

  volume::FieldPatch patch(drilling::kMostPatchFloats);
  std::vector<double> chunks, computes, applies, wall_applies;
  double computed_s = 0.0;
  std::size_t floats = 0;
  const drilling::Erosion::Take take = [&](const drilling::Change& change) {
    const double start = bench::thread_s();
    live->compute(erosion->volume(), change.box, patch);
    computed_s = bench::thread_s() - start;
    const double wall = bench::wall_s();
    live->apply(patch);
    wall_applies.push_back(bench::wall_s() - wall);
    floats = std::max(floats, volume::FieldPatch::floats_for(change.box, placed.geometry.dims));
  };
  for (std::uint32_t tick = 0; tick < 40000;) {
    const double start = bench::thread_s();
    computed_s = 0.0;
    for (std::uint32_t i = 0; i < drilling::kChunkTicks; ++i) erosion->add(feed(tick++), take);
    if (computed_s == 0.0) continue;
    chunks.push_back(bench::thread_s() - start);
    computes.push_back(computed_s);
  }
  const auto anew = volume::ForceField::make(erosion->volume(), transfer, volume::FieldKind::paper);
  if (!anew || chunks.size() < 100) return 2;
  double apart = 0.0;
  for (int n = 0; n < 200000; ++n) {
    const math::Vec3 p =
        placed.geometry.position_of({80.0 + n % 41, 80.0 + n / 41 % 41, double(n / 1681 % 120)});
    apart = std::max(apart, std::abs(live->opacity(p) - anew->opacity(p)));
  }
  report.must("the patched field is the field made anew, to the last bit", apart == 0.0);
  report.row("chunks that changed the bone", double(chunks.size()), "");
  report.row("largest change", double(floats) * 4e-3, "kB");
  report.row("chunk worn, change computed and copied, median", bench::quantile(chunks, 0.5) * 1e6,
             "us");
  report.row("the same, 99.9 %", bench::quantile(chunks, 0.999) * 1e6, "us");
  report.row("of it the change computed, median", bench::quantile(computes, 0.5) * 1e6, "us");
  report.row("the change copied in, median, wall", bench::quantile(wall_applies, 0.5) * 1e6, "us");
  report.row("the same, 99.9 %", bench::quantile(wall_applies, 0.999) * 1e6, "us");
  report.at_most("copy, median, share of a tick of 250 us",
                 bench::quantile(wall_applies, 0.5) / kTick_s, 0.1, "");
  report.at_least("chunks worn in the time of a chunk",
                  drilling::kChunkTicks * kTick_s / bench::quantile(chunks, 0.5), 5, "");
  report.at_least("changes computed in the time of a full preparation",
                  full_s / bench::quantile(computes, 0.5), 100, "");
  return report.finish(argc, argv);
}
