/// Opacity, blur and what the gradient needs, from the counts of a 512 × 512 × 300 volume: ours
/// against the time it takes to read the counts and write as many floats, and against VTK and ITK.
/// All on one thread, by processor time.
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "bench/field_preparation/rivals.hpp"
#include "bench/support/report.hpp"
#include "bench/support/scene.hpp"
#include "volume/force_field.hpp"

namespace tractus {
namespace {

constexpr double kVtkAgrees = 2e-6, kItkAgrees = 0.05;

/// Largest difference of blurred opacity at voxels 8 or more from the edge.
double difference(const volume::ForceField& field, const bench::Prepared& rival) {
  std::mt19937 random(1);
  const auto& g = field.geometry();
  double worst = 0.0;
  for (int n = 0; n < 20000; ++n) {
    std::array<int, 3> v{};
    for (std::size_t a = 0; a < 3; ++a)
      v[a] = std::uniform_int_distribution<int>(8, g.dims[a] - 9)(random);
    const double ours = field.opacity(g.position_of({double(v[0]), double(v[1]), double(v[2])}));
    worst = std::max(worst, std::abs(ours - rival.blurred(v[0], v[1], v[2])));
  }
  return worst;
}

bench::Opacities opacities_of(const volume::Volume& v, const volume::TransferFunction& transfer) {
  bench::Opacities out{v.geometry.dims, {}};
  out.alpha.reserve(v.counts.size());
  for (const std::uint16_t count : v.counts)
    out.alpha.push_back(float(transfer.opacity(v.intercept + v.slope * count)));
  return out;
}

void judge(bench::Report& report, const std::string& name, const volume::ForceField& field,
           double ours_s, const bench::Prepared& rival, double agrees, double times) {
  report.row(name + ", smooth and gradient, transfer function not counted", rival.time_s * 1e3,
             "ms");
  const double apart = difference(field, rival);
  report.row("  largest difference of blurred opacity to ours", apart, "");
  report.must("  " + name + " finds the same", apart <= agrees);
  report.at_least("times faster than " + name, rival.time_s / ours_s, times, "");
}

}  // namespace

}  // namespace tractus

int main(int argc, char** argv) {
  using namespace tractus;
  bench::Report report("field_preparation, 512 x 512 x 300");
  const volume::Volume block = bench::noise_block(512, 512, 300);
  const volume::Box whole{{0, 0, 0}, block.geometry.dims};
  const auto transfer = volume::TransferFunction::bone();

  const double wall_s = bench::seconds(2, bench::wall_s, [&] {
    (void)volume::ForceField::make(block, transfer, volume::FieldKind::paper);
  });
  report.row("ours, all threads, memory fetched from the system, wall clock", wall_s * 1e3, "ms");

  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const double fresh_s = bench::seconds(2, bench::process_s, [&] {
    (void)volume::ForceField::make(block, transfer, volume::FieldKind::paper);
  });
  report.row("ours, memory fetched from the system", fresh_s * 1e3, "ms");
  auto field = volume::ForceField::make(block, transfer, volume::FieldKind::paper);
  if (!field) return 2;
  double ours_s = 1e300, copy_s = 1e300;
  for (int round = 0; round < 4;
       ++round) {  // in turn, so that both meet the machine in the same mood
    ours_s =
        std::min(ours_s, bench::seconds(1, bench::process_s, [&] { field->update(block, whole); }));
    copy_s = std::min(copy_s, bench::copy_bound_s(block.counts, 2));
  }
  report.row("ours, memory at hand", ours_s * 1e3, "ms");
  report.row("read counts, write floats (the bound)", copy_s * 1e3, "ms");
  report.at_most("times the bound", ours_s / copy_s, 8, "");

  const bench::Opacities opacities = opacities_of(block, transfer);
#ifdef TRACTUS_BENCH_VTK
  judge(report, "VTK", *field, ours_s, bench::vtk_rival(opacities), kVtkAgrees, 20);
#else
  report.row("VTK is not installed", 0, "");
#endif
#ifdef TRACTUS_BENCH_ITK
  judge(report, "ITK", *field, ours_s, bench::itk_rival(opacities), kItkAgrees, 25);
#else
  report.row("ITK is not installed", 0, "");
#endif
  return report.finish(argc, argv);
}
