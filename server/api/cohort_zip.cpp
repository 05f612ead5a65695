#include "server/api/cohort_zip.hpp"

#include <archive.h>
#include <archive_entry.h>

#include <memory>

#include "core/json.hpp"

namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Result;
using store::Tier;

constexpr std::size_t kMostZip_bytes = 256u << 20;

struct Frees {
  void operator()(archive* writer) const { archive_write_free(writer); }
};

la_ssize_t append(archive*, void* into, const void* bytes, size_t size) {
  auto& out = *static_cast<std::string*>(into);
  if (out.size() + size > kMostZip_bytes) return -1;
  out.append(static_cast<const char*>(bytes), size);
  return static_cast<la_ssize_t>(size);
}

class Zip {
 public:
  Zip() : writer_(archive_write_new()) {
    archive_write_set_format_zip(writer_.get());
    archive_write_set_bytes_in_last_block(writer_.get(), 1);
    archive_write_open(writer_.get(), &bytes_, nullptr, append, nullptr);
  }
  /// No times are written: the same cohort is the same bytes.
  Result<void> add(const std::string& name, const std::string& content) {
    archive_entry* entry = archive_entry_new();
    archive_entry_set_pathname(entry, name.c_str());
    archive_entry_set_size(entry, static_cast<la_int64_t>(content.size()));
    archive_entry_set_filetype(entry, AE_IFREG);
    archive_entry_set_perm(entry, 0644);
    const bool added = archive_write_header(writer_.get(), entry) == ARCHIVE_OK &&
                       archive_write_data(writer_.get(), content.data(), content.size()) ==
                           static_cast<la_ssize_t>(content.size());
    archive_entry_free(entry);
    if (added) return {};
    return too_large();
  }
  Result<std::string> whole() {
    if (archive_write_close(writer_.get()) != ARCHIVE_OK) return too_large();
    return std::move(bytes_);
  }

 private:
  static Error too_large() {
    return {Errc::too_large, "the cohort's zip is over 256 MiB: ask for one study or a lower tier"};
  }
  std::string bytes_;
  std::unique_ptr<archive, Frees> writer_;
};

Result<void> add_samples(Zip& zip, Backend& backend, const store::ReleasedTrial& trial, Tier tier) {
  const Tier allowed = std::min(tier, trial.tier);
  if (allowed < Tier::reduced) return {};
  const auto file = trial.file(allowed);
  if (!file) return file.error();
  auto array =
      samples_npy(backend.objects.path_of(*file), allowed == Tier::full ? 0.0 : kReduced_Hz);
  if (!array) return array.error();
  return zip.add("samples/" + trial.id + ".npy", *array);
}

}  // namespace

Result<std::string> cohort_zip(Backend& backend, const std::string& study, Tier tier) {
  const auto counted = released_trials(backend, study, Tier::summary);
  if (!counted) return counted.error();
  // A zip of summaries lists nobody's trials.
  const auto listed =
      tier < Tier::metrics ? store::ReleasedTrials() : counted->at_least(Tier::metrics);
  Zip zip;
  const core::Json about{{"format", "tractus-cohort/1"},
                         {"study", study.empty() ? core::Json() : core::Json(study)},
                         {"tier", store::name(tier)},
                         {"trials_counted", counted->all().size()},
                         {"trials_listed", listed.all().size()}};
  for (const auto& [name, content] :
       std::vector<std::pair<std::string, std::string>>{{"cohort.json", about.dump(2) + "\n"},
                                                        {"dictionary.csv", dictionary_csv()},
                                                        {"summary.csv", summary_csv(*counted)},
                                                        {"trials.csv", trials_csv(listed)},
                                                        {"scores.csv", scores_csv(listed)}})
    if (auto added = zip.add(name, content); !added) return added.error();
  for (const auto& one : listed.all())
    if (auto added = add_samples(zip, backend, one, tier); !added) return added.error();
  return zip.whole();
}

}  // namespace api
