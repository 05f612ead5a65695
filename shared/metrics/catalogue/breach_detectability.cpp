#include "metrics/metric.hpp"

namespace tractus {
namespace metrics {
namespace {
Score told(const Subject& subject) {
  if (!subject.truth) return {{}, "the truth is not known here"};
  if (!subject.truth->breached) return {{}, "the case has no breach"};
  if (!subject.truth->d_prime) return {{}, "the case has no certificate of its breach"};
  return {subject.truth->d_prime, ""};
}
}  // namespace

MetricInfo breach_detectability() {
  return {
      "breach_detectability",
      "Detectability of the breach",
      "1",
      "d′ with which an ideal observer tells the case's breach by feel: by its certificate, the "
      "lesser of K and B, and K of an anterior breach.",
      "own definition, after signal detection theory",
      trial::Rig::palpation,
      told};
}

}  // namespace metrics
}  // namespace tractus
