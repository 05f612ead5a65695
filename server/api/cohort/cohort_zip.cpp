#include "server/api/cohort/cohort_zip.hpp"

#include <archive.h>
#include <archive_entry.h>

#include <fstream>
#include <memory>

#include "core/json.hpp"
#include "core/try.hpp"
#include "server/api/trials/samples_array.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Result;
using store::Tier;

constexpr std::uint64_t kMostZip_bytes = 256u << 20;
constexpr std::streamsize kPiece_bytes = 256 << 10;

struct FreesArchive {
  void operator()(archive* writer) const { archive_write_free(writer); }
};

struct Output {
  std::ofstream file;
  std::uint64_t size = 0;
};

la_ssize_t append(archive*, void* into, const void* bytes, size_t size) {
  auto& out = *static_cast<Output*>(into);
  out.size += size;
  if (out.size > kMostZip_bytes) return -1;
  out.file.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
  return out.file ? static_cast<la_ssize_t>(size) : -1;
}

class Zip {
 public:
  explicit Zip(const std::filesystem::path& path)
      : out_{std::ofstream(path, std::ios::binary)}, writer_(archive_write_new()) {
    archive_write_set_format_zip(writer_.get());
    archive_write_set_bytes_in_last_block(writer_.get(), 1);
    archive_write_open(writer_.get(), &out_, nullptr, append, nullptr);
  }
  /// No times are written: the same cohort is the same bytes.
  Result<void> add(const std::string& name, const std::string& content) {
    if (begin(name, content.size()) && write(content)) return {};
    return failure();
  }
  Result<void> add(const std::string& name, const std::filesystem::path& content) {
    std::ifstream in(content, std::ios::binary);
    bool added = begin(name, std::filesystem::file_size(content));
    for (std::string piece(kPiece_bytes, 0); added && in;) {
      in.read(piece.data(), kPiece_bytes);
      added = write(std::string_view(piece).substr(0, static_cast<std::size_t>(in.gcount())));
    }
    if (added) return {};
    return failure();
  }
  Result<void> finish() {
    if (archive_write_close(writer_.get()) != ARCHIVE_OK) return failure();
    out_.file.close();
    if (out_.file) return {};
    return failure();
  }

 private:
  bool begin(const std::string& name, std::uint64_t size) {
    archive_entry* entry = archive_entry_new();
    archive_entry_set_pathname(entry, name.c_str());
    archive_entry_set_size(entry, static_cast<la_int64_t>(size));
    archive_entry_set_filetype(entry, AE_IFREG);
    archive_entry_set_perm(entry, 0644);
    const bool begun = archive_write_header(writer_.get(), entry) == ARCHIVE_OK;
    archive_entry_free(entry);
    return begun;
  }
  bool write(std::string_view bytes) {
    return archive_write_data(writer_.get(), bytes.data(), bytes.size()) ==
           static_cast<la_ssize_t>(bytes.size());
  }
  Error failure() const {
    if (out_.size <= kMostZip_bytes)
      return {Errc::io, "the zip cannot be written: the disk is possibly full"};
    return {Errc::too_large,
            "the zip is larger than 256 MiB: export one study or use a lower tier"};
  }
  Output out_;
  std::unique_ptr<archive, FreesArchive> writer_;
};

Result<void> add_samples(Zip& zip, Backend& backend, const std::string& client,
                         const store::ReleasedTrial& trial, Tier tier) {
  const Tier allowed = std::min(tier, trial.tier);
  if (allowed < Tier::reduced) return {};
  const auto file = TRY(trial.file(allowed));
  auto array = TRY(http::scratch_file(*backend.scratch, client, samples_npy_bytes(trial.samples)));
  TRY(write_samples_npy(backend.objects.path_of(file), allowed == Tier::full ? 0.0 : kReduced_Hz,
                        array->path));
  return zip.add("samples/" + trial.id + ".npy", array->path);
}

}  // namespace

Result<std::shared_ptr<http::ScratchFile>> cohort_zip(Backend& backend, const std::string& client,
                                                      const std::string& study, Tier tier) {
  const auto counted = TRY(released_trials(backend, study, Tier::summary));
  // A zip of summaries lists nobody's trials.
  const auto listed =
      tier < Tier::metrics ? store::ReleasedTrials() : counted.at_least(Tier::metrics);
  auto file = TRY(http::scratch_file(*backend.scratch, client, kMostZip_bytes));
  Zip zip(file->path);
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
    TRY(zip.add(name, content));
  for (const auto& one : listed.all()) TRY(add_samples(zip, backend, client, one, tier));
  TRY(zip.finish());
  return file;
}

}  // namespace api
}  // namespace tractus
