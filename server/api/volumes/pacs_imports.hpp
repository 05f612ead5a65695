/// Imports series from the PACS, one at a time, by a thread of its own: a request would wait minutes.
#pragma once

#include <mutex>
#include <thread>

#include "db/store/operations/audit.hpp"
#include "db/store/volumes/pacs_imports.hpp"
#include "server/api/backend.hpp"
#include "server/api/volumes/pacs.hpp"
#include "server/api/volumes/volume_intake.hpp"

namespace tractus::api {

struct PacsImportWish {
  std::string study_uid, series_uid;
  VolumeWish volume;
  store::AuditedAction act;  ///< notes in the audit trail that the volume was added
};

class PacsImports {
 public:
  PacsImports(Backend& backend, PacsSettings settings)
      : backend_(backend), settings_(std::move(settings)) {}
  /// Ends a transfer; a volume that is being read is waited for.
  ~PacsImports() = default;
  PacsImports(const PacsImports&) = delete;
  PacsImports& operator=(const PacsImports&) = delete;
  const PacsSettings& settings() const { return settings_; }

  /// Begins an import, whose record then says how far it is. Errors: unavailable while another one
  /// runs, or without room for the files.
  core::Result<store::PacsImport> start(PacsImportWish wish);

 private:
  void run(const std::stop_token& stop, const PacsImportWish& wish, store::PacsImport import);
  core::Result<std::string> volume_from(const std::stop_token& stop, const PacsImportWish& wish,
                                        store::PacsImport& import);
  core::Result<void> fetch(const std::stop_token& stop, const SeriesWish& wish,
                           store::PacsImport& import);
  void note(store::PacsImport& import) const;

  Backend& backend_;
  const PacsSettings settings_;
  std::mutex mutex_;  ///< guards what follows
  bool runs_ = false;
  std::jthread thread_;
};

}  // namespace tractus::api
