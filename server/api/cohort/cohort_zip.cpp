#include "server/api/cohort/cohort_zip.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <memory>
#include <unordered_map>

#include "core/bytes.hpp"
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

constexpr std::size_t kTablePiece_bytes = 256 << 10;
constexpr std::int64_t kCheckedEvery_us = 1'000'000;
constexpr std::int64_t kLeastPause = 10;  ///< between two checks, in times that a check took

class TableContent : public EntryContent {
 public:
  explicit TableContent(std::string_view left) : left_(left) {}
  Result<void> append_to(std::string& out) override {
    out += left_.substr(0, kTablePiece_bytes);
    left_.remove_prefix(std::min(left_.size(), kTablePiece_bytes));
    return {};
  }

 private:
  std::string_view left_;
};

class ArrayContent : public EntryContent {
 public:
  ArrayContent(std::string head, SampleRows rows)
      : head_(std::move(head)), rows_(std::move(rows)) {}
  Result<void> append_to(std::string& out) override {
    out += std::exchange(head_, "");
    for (bool more = out.empty(); more && out.empty();) more = TRY(rows_.append_to(out));
    return {};
  }

 private:
  std::string head_;
  SampleRows rows_;
};

struct CountedRows {
  std::uint64_t rows = 0;
  std::uint32_t crc32 = 0;  ///< of the whole array
};

std::uint32_t crc32_after(std::uint32_t before, std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

Result<CountedRows> count_rows(SampleRows rows, trial::Rig rig,
                               const CohortArchive::CalledOff& called_off) {
  std::uint64_t size = 0;
  std::uint32_t crc = 0;
  std::string piece;
  for (bool more = true; more; piece.clear()) {
    if (called_off && called_off())
      return Error{Errc::unavailable, "the client no longer waits for the cohort"};
    more = TRY(rows.append_to(piece));
    size += piece.size();
    crc = crc32_after(crc, piece);
  }
  CountedRows out{.rows = npy_rows(rig, size)};
  const std::uint32_t head = crc32_after(0, npy_head(rig, out.rows));
  out.crc32 = static_cast<std::uint32_t>(crc32_combine64(head, crc, static_cast<z_off64_t>(size)));
  return out;
}

/// An archive that is no longer released is held no longer.
Result<void> check_held(Backend& backend, const CohortArchive& archive) {
  auto released = archive.check_released(backend);
  if (!released) backend.held_cohorts.drop(archive);
  return released;
}

/// Ends when a trial of the archive is no longer released, or who asked may not export any more.
class ReleasedSource : public http::BodySource {
 public:
  ReleasedSource(std::shared_ptr<const CohortArchive> archive, Backend& backend,
                 StoredZipSource source, std::function<bool()> still_allowed)
      : archive_(std::move(archive)),
        backend_(backend),
        source_(std::move(source)),
        still_allowed_(std::move(still_allowed)),
        checked_utc_us_(backend.now_utc_us()) {}

  Result<void> read(std::string& piece) override {
    auto read = read_checked(piece);
    if (!read && backend_.log)
      backend_.log({{"what", "an export ended before its end"}, {"why", read.error().what}});
    return read;
  }

 private:
  Result<void> read_checked(std::string& piece) {
    const std::int64_t now = backend_.now_utc_us();
    if (now < checked_utc_us_ || now - checked_utc_us_ >= pause_us_) {
      if (!still_allowed_())
        return Error{Errc::forbidden, "who asked for this export may not export any more"};
      TRY(check_held(backend_, *archive_));
      checked_utc_us_ = backend_.now_utc_us();
      pause_us_ = std::max(kCheckedEvery_us, kLeastPause * (checked_utc_us_ - now));
    }
    return source_.read(piece);
  }

  std::shared_ptr<const CohortArchive> archive_;
  Backend& backend_;
  StoredZipSource source_;
  std::function<bool()> still_allowed_;
  std::int64_t checked_utc_us_;
  std::int64_t pause_us_ = kCheckedEvery_us;
};

Result<std::shared_ptr<CohortArchive>> archive_for(Backend& backend, const CohortWish& wish,
                                                   const http::Request& request) {
  auto held = backend.held_cohorts.find(request.header("if-range"));
  if (held && held->wish() == wish && check_held(backend, *held)) return held;
  return CohortArchive::make(backend, wish, request.called_off);
}

}  // namespace

std::shared_ptr<CohortArchive> HeldCohorts::find(std::string_view entity_tag) {
  const std::lock_guard held(mutex_);
  for (auto at = archives_.begin(); at != archives_.end(); ++at) {
    if ((*at)->entity_tag() != entity_tag) continue;
    archives_.splice(archives_.begin(), archives_, at);
    return archives_.front();
  }
  return nullptr;
}

void HeldCohorts::keep(std::shared_ptr<CohortArchive> archive) {
  const std::lock_guard held(mutex_);
  archives_.remove_if([&](const auto& one) { return one->entity_tag() == archive->entity_tag(); });
  archives_.push_front(std::move(archive));
  if (archives_.size() > kMost) archives_.pop_back();
}

void HeldCohorts::drop(const CohortArchive& archive) {
  const std::lock_guard held(mutex_);
  archives_.remove_if([&](const auto& one) { return one.get() == &archive; });
}

void HeldCohorts::forget() {
  const std::lock_guard held(mutex_);
  archives_.clear();
}

CohortArchive::CohortArchive(CohortWish wish, const store::ReleasedTrials& counted)
    : wish_(std::move(wish)) {
  // A zip of summaries lists nobody's trials.
  const auto listed =
      wish_.tier < Tier::metrics ? store::ReleasedTrials() : counted.at_least(Tier::metrics);
  const core::Json about{{"format", "tractus-cohort/1"},
                         {"study", wish_.study.empty() ? core::Json() : core::Json(wish_.study)},
                         {"tier", store::name(wish_.tier)},
                         {"trials_counted", counted.all().size()},
                         {"trials_listed", listed.all().size()}};
  tables_ = {{"cohort.json", about.dump(2) + "\n"},
             {"dictionary.csv", dictionary_csv()},
             {"summary.csv", summary_csv(counted)},
             {"trials.csv", trials_csv(listed)},
             {"scores.csv", scores_csv(listed)}};
  for (const auto& one : counted.all())
    needed_.push_back({one.id, one.participant, std::min(wish_.tier, one.tier)});
}

Result<void> CohortArchive::add_array(const store::ReleasedTrial& trial) {
  const Tier allowed = std::min(wish_.tier, trial.tier);
  if (allowed < Tier::reduced) return {};
  const bool full = allowed == Tier::full;
  auto sha256 = TRY(trial.file(allowed));
  arrays_.push_back({.name = "samples/" + trial.id + ".npy",
                     .sha256 = std::move(sha256),
                     .rate_Hz = full ? 0.0 : kReduced_Hz,
                     .rig = trial.rig,
                     .rows = full ? trial.samples : 0});
  return {};
}

Result<std::shared_ptr<CohortArchive>> CohortArchive::make(Backend& backend, CohortWish wish,
                                                           const CalledOff& called_off) {
  const auto counted = TRY(released_trials(backend, wish.study, Tier::summary));
  std::shared_ptr<CohortArchive> out(new CohortArchive(std::move(wish), counted));
  for (const auto& trial : counted.all()) TRY(out->add_array(trial));
  core::Sha256 hash;
  const auto add = [&](const std::string& text) {
    hash.add(core::bytes_of(std::to_string(text.size()) + ":" + text));
  };
  add("stored zip 1");
  for (const Needed& one : out->needed_) add(one.trial), add(one.participant);
  for (const auto& [name, content] : out->tables_) add(name), add(content);
  for (const Array& array : out->arrays_)
    for (const auto& text :
         {array.name, array.sha256, std::to_string(array.rate_Hz), std::to_string(array.rows)})
      add(text);
  out->entity_tag_ = "\"" + hash.hex().substr(0, 32) + "\"";
  if (auto held = backend.held_cohorts.find(out->entity_tag_)) return held;
  TRY(out->lay_out(backend, called_off));
  backend.held_cohorts.keep(out);
  return out;
}

Result<void> CohortArchive::lay_out(Backend& backend, const CalledOff& called_off) {
  std::vector<StoredEntry> entries;
  std::vector<std::optional<std::uint32_t>> checksums(tables_.size());
  for (const Table& table : tables_) entries.push_back({table.name, table.content.size()});
  for (Array& array : arrays_) {
    checksums.emplace_back();
    if (array.rate_Hz > 0.0) {
      auto rows = TRY(SampleRows::open(TRY(backend.objects.file(array.sha256)), array.rate_Hz));
      const auto counted = TRY(count_rows(std::move(rows), array.rig, called_off));
      array.rows = counted.rows;
      checksums.back() = counted.crc32;
    }
    entries.push_back({array.name, npy_bytes(array.rig, array.rows)});
  }
  zip_ = std::make_shared<StoredZip>(std::move(entries));
  for (std::size_t i = 0; i < checksums.size(); ++i)
    if (checksums[i]) TRY(zip_->note_checksum(i, *checksums[i]));
  return {};
}

Result<void> CohortArchive::check_released(Backend& backend) const {
  const auto now = TRY(released_trials(backend, wish_.study, Tier::summary));
  std::unordered_map<std::string_view, const store::ReleasedTrial*> trials;
  for (const auto& trial : now.all()) trials[trial.id] = &trial;
  const auto gone = std::ranges::count_if(needed_, [&](const Needed& one) {
    const auto at = trials.find(one.trial);
    return at == trials.end() || at->second->tier < one.tier ||
           at->second->participant != one.participant;
  });
  if (gone == 0) return {};
  return Error{Errc::forbidden,
               fmt::format("{} of the {} trials of this export were deleted, or are no longer "
                           "released by those who did them: export the cohort anew",
                           gone, needed_.size())};
}

OpenEntry CohortArchive::opener(const Backend& backend) {
  using Content = std::unique_ptr<EntryContent>;
  return [self = shared_from_this(), &backend](std::size_t entry) -> Result<Content> {
    if (entry < self->tables_.size())
      return Content(std::make_unique<TableContent>(self->tables_[entry].content));
    const Array& array = self->arrays_[entry - self->tables_.size()];
    auto rows = TRY(SampleRows::open(TRY(backend.objects.file(array.sha256)), array.rate_Hz));
    return Content(
        std::make_unique<ArrayContent>(npy_head(array.rig, array.rows), std::move(rows)));
  };
}

Result<StoredZipSource> CohortArchive::part(const Backend& backend, std::uint64_t first,
                                            std::uint64_t size, const CalledOff& called_off) {
  const OpenEntry open = opener(backend);
  const bool in_directory = first >= zip_->directory_begin();
  if (first + size > zip_->directory_begin())
    TRY(note_checksums_before(*zip_, in_directory ? zip_->entries().size() : zip_->entry_at(first),
                              open, called_off));
  return StoredZipSource(zip_, open, first, size);
}

Result<http::Response> cohort_response(Backend& backend, const CohortWish& wish,
                                       const http::Request& request,
                                       std::function<bool()> still_allowed) {
  const auto archive = TRY(archive_for(backend, wish, request));
  http::Response response;
  response.with("Content-Type", "application/zip")
      .with("Content-Disposition", "attachment; filename=\"cohort.zip\"")
      .with("Cache-Control", "no-store")
      .with("ETag", archive->entity_tag());
  http::RequestHead head = request;
  if (head.header("if-range").empty()) head.headers.erase("range");
  const auto part = http::wanted_part(head, archive->size(), archive->entity_tag(), response);
  if (part) {
    auto source = TRY(archive->part(backend, part->first, part->second, request.called_off));
    response.body =
        http::MadeBody{std::make_shared<ReleasedSource>(archive, backend, std::move(source),
                                                        std::move(still_allowed)),
                       part->second};
  }
  TRY(check_held(backend, *archive));  // it may have taken long until here
  return response;
}

}  // namespace api
}  // namespace tractus
