/// Trials as the pages get them.
#pragma once

#include "db/store/trials.hpp"
#include "server/api/route.hpp"
#include "volume/tract.hpp"

namespace api {

core::Json summary_json(const store::TrialSummary& trial);
core::Json trial_json(const store::TrialRecord& trial,
                      const std::vector<store::ScoreRecord>& scores, const volume::Tract* tract,
                      const core::Json& truth);

/// Their schemas: TrialSummary, TrialList, Trial, Score, TrialEvent, Tract, Coverage, Truth,
/// Answer.
std::vector<NamedSchema> trial_schemas();
/// TrialSignals, Envelope, TrialPath.
std::vector<NamedSchema> curve_schemas();

}  // namespace api
