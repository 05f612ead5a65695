#include "server/api/trials/trial_signals.hpp"

#include "core/try.hpp"
#include "server/api/trials/uploads.hpp"
#include "server/jobs/case_facts.hpp"

namespace tractus {
namespace api {
namespace {

core::Result<trial::Signals> decode(Backend& backend, const store::TrialRecord& trial) {
  auto header = TRY(header_of(trial));
  std::optional<trial::TractLine> line;
  if (header.rig == trial::Rig::palpation) {
    auto facts = TRY(jobs::case_facts(backend.store, backend.objects, trial.summary.case_id));
    line = trial::TractLine{facts.definition.tract.entry_m, facts.definition.tract.axis};
  }
  trial::Signals signals(header, line);
  TRY(trial::scan_trial(TRY(backend.objects.file(trial.sha256)),
                        [&](const trial::Block& block) { signals.add(block); },
                        {.max_samples = kMaxTrialSamples, .max_bytes = kMaxTrial_bytes}));
  return signals;
}

}  // namespace

core::Result<trial::Header> header_of(const store::TrialRecord& trial) {
  auto json = TRY(core::parse_json(trial.header, "trial " + trial.summary.id, core::kStoredJson));
  return trial::Header::from_json(json, "trial " + trial.summary.id);
}

core::Result<std::shared_ptr<const trial::Signals>> signals_of(Backend& backend,
                                                               const std::string& trial_id) {
  auto record =
      TRY(backend.store.read([&](store::Reading& tx) { return store::trial_of(tx, trial_id); }));
  if (!record) return core::Error{core::Errc::not_found, "no trial " + trial_id.substr(0, 32)};
  return backend.trial_views.of(trial_id, [&] { return decode(backend, *record); });
}

}  // namespace api
}  // namespace tractus
