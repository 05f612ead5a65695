#include "server/api/volumes/pacs_imports.hpp"

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "core/words.hpp"

namespace tractus {
namespace api {
namespace {

namespace fs = std::filesystem;
using core::Errc;
using core::Error;
using core::Result;
using store::PacsImportState;

constexpr std::int64_t kNotedEvery_us = 1'000'000;

}  // namespace

Result<store::PacsImport> PacsImports::start(PacsImportWish wish) {
  const std::lock_guard held(mutex_);
  if (runs_)
    return Error{Errc::unavailable, "another series is being imported: try again in a minute"};
  auto room = TRY(backend_.scratch->reserve(wish.volume.by_id, SeriesLimits{}.bytes));
  const store::PacsImport import{.id = core::new_id(),
                                 .account_id = wish.volume.by_id,
                                 .changed_utc_us = backend_.now_utc_us()};
  TRY(backend_.store.write([&](store::Writing& tx) { return store::add_pacs_import(tx, import); }));
  runs_ = true;
  thread_ = std::jthread([this, wish = std::move(wish), import, room = std::move(room)](
                             const std::stop_token& stop) { run(stop, wish, import); });
  return import;
}

void PacsImports::run(const std::stop_token& stop, const PacsImportWish& wish,
                      store::PacsImport import) {
  const auto volume = volume_from(stop, wish, import);
  import.state = volume ? PacsImportState::done : PacsImportState::failed;
  if (volume) import.volume_id = *volume;
  if (!volume)
    import.error = stop.stop_requested() ? "the server was stopped: import the series again"
                                         : core::one_line(volume.error().what, 1000);
  note(import);
  const std::lock_guard held(mutex_);
  runs_ = false;
}

Result<std::string> PacsImports::volume_from(const std::stop_token& stop,
                                             const PacsImportWish& wish,
                                             store::PacsImport& import) {
  // On the data's disk, as an upload (volume_intake.cpp).
  const auto scratch = TRY(core::ScratchFolder::make(backend_.scratch->folder() / "pacs"));
  const fs::path series = scratch.path() / "series";
  std::error_code failure;
  if (!fs::create_directory(series, failure))
    return Error{Errc::io, "a folder for the series cannot be made: " + failure.message()};
  TRY(fetch(stop, {.study_uid = wish.study_uid, .series_uid = wish.series_uid, .folder = series},
            import));
  import.state = PacsImportState::reading;
  note(import);
  const auto taken = TRY(take_in_series(backend_, series, scratch.path(), Turn::wait));
  store::AuditedAction act = wish.act;
  act.at_utc_us = backend_.now_utc_us();
  const store::AuditScope acting(std::move(act));
  return TRY(keep_volume(backend_, taken, wish.volume)).id;
}

Result<void> PacsImports::fetch(const std::stop_token& stop, const SeriesWish& wish,
                                store::PacsImport& import) {
  const auto count = [&import](const FetchedSeries& so_far) {
    import.files = so_far.files;
    import.size_bytes = so_far.bytes;
  };
  SeriesWish watched = wish;
  watched.may_go_on = [&](const FetchedSeries& so_far) {
    count(so_far);
    if (backend_.now_utc_us() - import.changed_utc_us >= kNotedEvery_us) note(import);
    return !stop.stop_requested();
  };
  count(TRY(fetch_series(settings_, watched)));
  return {};
}

/// A record that cannot be written ends nothing: it is written again, or left.
void PacsImports::note(store::PacsImport& import) const {
  import.changed_utc_us = backend_.now_utc_us();
  const auto noted = backend_.store.write(
      [&](store::Writing& tx) { return store::change_pacs_import(tx, import); });
  if (!noted && backend_.log)
    backend_.log({{"what", "pacs import"}, {"error", noted.error().what}});
}

}  // namespace api
}  // namespace tractus
