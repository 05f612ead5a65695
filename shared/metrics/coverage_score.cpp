#include "metrics/coverage_score.hpp"

namespace tractus::metrics {

Score coverage_score(const Subject& subject, std::optional<volume::Wall> side) {
  const auto& contacts = coverage(subject);
  if (!contacts) return {{}, "the trial does not say how long the probe is"};
  return {contacts->share(side), ""};
}

}  // namespace tractus::metrics
