/// Scores of a trial that drilled: from its own "drilled" event (shared/drilling/README.md), as the
/// station measured it on the bone; `tractus drill report` makes it again from the samples.
#pragma once

#include "metrics/metric.hpp"

namespace tractus::metrics {

/// What the event's detail says; null when the trial was cut short.
const core::Json* drilled_detail(const Subject& subject);

/// The number under `key` of the event's `channel`, or no value and why.
Score channel_score(const Subject& subject, const char* key);

inline constexpr const char* kCutShort = "the trial was cut short";

/// Was the tool a burr?
bool drills(const trial::Trial& trial);

}  // namespace tractus::metrics
