/// The model lab on the server: versions of models, measurement sets, and what was asked of them.
#pragma once

#include <vector>

#include "db/store/store.hpp"

namespace store {

/// One version of a model. Never changed: a better one is another version, with this as its parent.
struct ModelVersion {
  std::string id;
  std::string name;
  std::string rig;                       ///< "probing", "palpation"
  std::string sha256;                    ///< of its file
  std::optional<std::string> parent;     ///< the version it was made from
  std::optional<std::string> diagnosis;  ///< that made it: the measurements and the fit are there
  std::int64_t made_utc_us = 0;
  std::string made_by;
};

struct MeasurementSet {
  std::string id;  ///< SHA-256 of the zip
  std::string name;
  std::int64_t made_utc_us = 0;
  std::string made_by;
};

/// "queued", "running", "done", "failed" or "cancelled".
struct DiagnosisRun {
  std::string id, model_id, set_id;
  std::string state = "queued";
  double share = 0.0;                         ///< of the work, 0 … 1
  bool stop = false;                          ///< someone asked to stop it
  std::optional<std::string> result, report;  ///< objects, once done
  std::string error;
  std::int64_t made_utc_us = 0;
  std::string made_by;
};

core::Result<void> add_model(Writing& tx, const ModelVersion& model);
core::Result<std::optional<ModelVersion>> model_of(Reading& tx, const std::string& id);
/// Newest first.
core::Result<std::vector<ModelVersion>> all_models(Reading& tx);
/// The version that a diagnosis made, if it did.
core::Result<std::optional<ModelVersion>> model_made_by(Reading& tx, const std::string& diagnosis);

/// The same bytes again are the same set: nothing happens.
core::Result<void> add_measurement_set(Writing& tx, const MeasurementSet& set);
core::Result<std::optional<MeasurementSet>> measurement_set_of(Reading& tx, const std::string& id);

core::Result<void> add_diagnosis(Writing& tx, const DiagnosisRun& run);
core::Result<std::optional<DiagnosisRun>> diagnosis_of(Reading& tx, const std::string& id);
/// Notes how far it is; the answer says whether someone asked to stop it.
core::Result<bool> note_diagnosis_share(Writing& tx, const std::string& id, double share,
                                        std::int64_t now_utc_us);
core::Result<void> finish_diagnosis(Writing& tx, const std::string& id, const std::string& result,
                                    const std::string& report, std::int64_t now_utc_us);
/// @param state  "failed" or "cancelled".
core::Result<void> end_diagnosis(Writing& tx, const std::string& id, const std::string& state,
                                 const std::string& why, std::int64_t now_utc_us);
/// One that waits is cancelled at once, one that runs when it next looks; one that ended stays.
core::Result<void> ask_to_stop(Writing& tx, const std::string& id, std::int64_t now_utc_us);

}  // namespace store
