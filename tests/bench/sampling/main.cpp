/// One sample of the field, next to the last, as a probe's moves: ours against plain loops over 64
/// neighbours.
#include <fmt/core.h>

#include "bench/haptic_step/published_relaxation.hpp"
#include "bench/support/report.hpp"
#include "bench/support/scene.hpp"

namespace tractus {
namespace {

constexpr int kSamples = 2000000;

/// ns a sample. When chained, each point depends on the sample before, so that nothing overlaps.
template <bool kChained, class Sample>
double sample_ns(Sample sample) {
  constexpr double kPull = kChained ? 1e-12 : 0.0;
  double kept = 0.0;
  const double s = bench::seconds(3, bench::thread_s, [&] {
    math::Vec3 p(0.03, 0.03, 0.03);
    for (int n = 0; n < kSamples; ++n) {
      const math::Vec3 g = sample(p);
      p.x() = 0.03 + 1e-3 * std::fabs(1 - 2e-6 * n);
      p.y() = 0.03 + 1e-9 * n;
      if constexpr (kChained) p += kPull * g;
      kept += g.x();
    }
  });
  volatile double sink = kept;
  (void)sink;
  return s / kSamples * 1e9;
}

}  // namespace

}  // namespace tractus

int main(int argc, char** argv) {
  using namespace tractus;
  bench::Report report("sampling");
  const volume::Volume block = bench::noise_block(512, 512, 100);
  for (const auto kind : {volume::FieldKind::paper, volume::FieldKind::potential}) {
    const auto field = volume::ForceField::make(block, volume::TransferFunction::bone(), kind);
    if (!field) return 2;
    const std::string name =
        kind == volume::FieldKind::paper ? "published field" : "potential field";
    const auto gradient = [&](const math::Vec3& p) { return field->gradient_per_m(p); };
    const auto both = [&](const math::Vec3& p) {
      const auto at = field->sample(p);
      return math::Vec3(at.g_per_m + 1e-12 * at.jacobian_per_m2.col(0));
    };
    report.row(name + ", g", sample_ns<false>(gradient), "ns");
    report.at_most(name + ", g, chained", sample_ns<true>(gradient), 40, "ns");
    report.row(name + ", g and its Jacobian", sample_ns<false>(both), "ns");
    if (kind != volume::FieldKind::paper) continue;
    const bench::PublishedRelaxation rival(block, *field, {}, 0.0);
    const math::Vec3 at(0.0312, 0.0307, 0.0169);
    const double difference = (rival.gradient_per_m(at) - field->gradient_per_m(at)).norm();
    report.must("plain loops find the same (within 1e-3 per m)", difference < 1e-3);
    const auto plain = [&](const math::Vec3& p) { return rival.gradient_per_m(p); };
    report.row("published field, plain loops", sample_ns<false>(plain), "ns");
    report.row("published field, plain loops, chained", sample_ns<true>(plain), "ns");
  }
  return report.finish(argc, argv);
}
