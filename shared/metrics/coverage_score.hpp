/// What the five coverage metrics share.
#pragma once

#include "metrics/metric.hpp"

namespace tractus::metrics {

/// Share of the bins touched, of all side walls or of one; no value when the tip cannot be placed.
Score coverage_score(const Subject& subject, std::optional<volume::Wall> side);

}  // namespace tractus::metrics
