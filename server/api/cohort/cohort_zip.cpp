#include "server/api/cohort/cohort_zip.hpp"

#include <memory>

#include "core/json.hpp"
#include "core/try.hpp"
#include "server/api/trials/samples_array.hpp"
#include "server/api/zip_file.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Result;
using store::Tier;

constexpr std::uint64_t kMostZip_bytes = 256u << 20;

/// The zip's own words for what the caller can do about its size.
Result<void> advised(Result<void> added) {
  if (added || added.error().code != Errc::too_large) return added;
  return Error{Errc::too_large, added.error().what + ": export one study or use a lower tier"};
}

Result<void> add_samples(ZipFile& zip, Backend& backend, const std::string& client,
                         const store::ReleasedTrial& trial, Tier tier) {
  const Tier allowed = std::min(tier, trial.tier);
  if (allowed < Tier::reduced) return {};
  const auto file = TRY(trial.file(allowed));
  auto array = TRY(http::scratch_file(*backend.scratch, client, samples_npy_bytes(trial.samples)));
  TRY(write_samples_npy(backend.objects.path_of(file), allowed == Tier::full ? 0.0 : kReduced_Hz,
                        array->path));
  return advised(zip.add("samples/" + trial.id + ".npy", array->path));
}

}  // namespace

Result<std::shared_ptr<http::ScratchFile>> cohort_zip(Backend& backend, const std::string& client,
                                                      const std::string& study, Tier tier) {
  const auto counted = TRY(released_trials(backend, study, Tier::summary));
  // A zip of summaries lists nobody's trials.
  const auto listed =
      tier < Tier::metrics ? store::ReleasedTrials() : counted.at_least(Tier::metrics);
  auto file = TRY(http::scratch_file(*backend.scratch, client, kMostZip_bytes));
  ZipFile zip(file->path, kMostZip_bytes);
  const core::Json about{{"format", "tractus-cohort/1"},
                         {"study", study.empty() ? core::Json() : core::Json(study)},
                         {"tier", store::name(tier)},
                         {"trials_counted", counted.all().size()},
                         {"trials_listed", listed.all().size()}};
  for (const auto& [name, content] :
       std::vector<std::pair<std::string, std::string>>{{"cohort.json", about.dump(2) + "\n"},
                                                        {"dictionary.csv", dictionary_csv()},
                                                        {"summary.csv", summary_csv(counted)},
                                                        {"trials.csv", trials_csv(listed)},
                                                        {"scores.csv", scores_csv(listed)}})
    TRY(advised(zip.add(name, content)));
  for (const auto& one : listed.all()) TRY(add_samples(zip, backend, client, one, tier));
  TRY(advised(zip.finish()));
  return file;
}

}  // namespace api
}  // namespace tractus
