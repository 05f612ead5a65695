#include "server/jobs/assess.hpp"

#include "core/json.hpp"
#include "core/try.hpp"
#include "db/store/trials/trials.hpp"
#include "metrics/metric.hpp"
#include "server/jobs/case_facts.hpp"
#include "server/jobs/scenario_facts.hpp"
#include "trial/trial_file.hpp"

namespace tractus {
namespace jobs {
namespace {

struct Assessment {
  std::vector<store::ScoreRecord> scores;
  std::optional<bool> correct;
  std::string coverage;
};

std::string coverage_text(const metrics::Subject& subject) {
  const auto coverage = metrics::coverage(subject);
  if (!coverage) return "null";
  return core::Json{{"depth_bins", coverage->depth_bins},
                    {"angle_bins", coverage->angle_bins},
                    {"samples", coverage->samples}}
      .dump();
}

Assessment assessment(const metrics::Subject& subject) {
  Assessment out;
  for (const auto& [info, score] : metrics::score_all(subject)) {
    out.scores.push_back({info.id, score.value, score.note});
    if (info.shown_as == metrics::ShownAs::correct_or_incorrect && score.value)
      out.correct = *score.value > 0.5;
  }
  out.coverage = coverage_text(subject);
  return out;
}

}  // namespace

core::Result<void> assess_trial(store::Store& store, const store::Objects& objects,
                                const std::string& trial_id) {
  auto record = TRY(store.read([&](store::Reading& tx) { return store::trial_of(tx, trial_id); }));
  if (!record) return core::Error{core::Errc::not_found, "no trial " + trial_id};
  auto trial = trial::read_trial(TRY(objects.file(record->sha256)));
  if (!trial) return trial.error();
  metrics::Subject subject{.trial = *trial};
  std::optional<CaseFacts> facts;
  if (trial->header.rig == trial::Rig::palpation) {
    auto known = TRY(facts_of_trial(store, objects, record->summary.case_id, trial->header));
    facts = std::move(known);
    subject.tract = &facts->definition.tract;
    if (facts->truth)
      subject.truth = metrics::Truth{.breached = facts->truth->breached, .d_prime = facts->d_prime};
  } else {
    auto scenario = TRY(scenario_of(store, objects, record->summary.case_id));
    subject.truth =
        metrics::Truth{.breached = {}, .walls = static_cast<int>(scenario.walls_m.size())};
  }
  const Assessment done = assessment(subject);
  return store.write([&](store::Writing& tx) {
    return store::set_assessment(tx, trial_id, done.scores, done.correct, done.coverage);
  });
}

}  // namespace jobs
}  // namespace tractus
