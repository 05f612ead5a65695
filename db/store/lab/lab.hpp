/// The model lab on the server: versions of models, measurement sets, and what was asked of them.
#pragma once

#include <vector>

#include "db/store/store.hpp"

namespace tractus::store {

/// One version of a model. Never changed: a better one is another version, with this as its parent.
struct ModelVersion {
  std::string id;
  std::string name;
  std::string rig;                    ///< "probing", "palpation"
  std::string sha256;                 ///< of its file
  std::optional<std::string> parent;  ///< the version it was made from
  std::optional<std::string> run;     ///< that made it: the measurements and the fit are there
  std::int64_t made_utc_us = 0;
  std::string made_by;
  std::string note;  ///< why, in its maker's words
};

struct MeasurementSet {
  std::string id;  ///< SHA-256 of the zip
  std::string name;
  std::int64_t made_utc_us = 0;
  std::string made_by;
  /// What it holds; nothing for a set that came before this was asked.
  std::optional<std::string> rig = {};
  std::optional<bool> simulated = {};
  std::uint64_t trials = 0, samples = 0;
  std::uint64_t size_bytes = 0;  ///< of the zip; read, not written
};

enum class LabRunKind { diagnosis, comparison, fit };
constexpr auto words(LabRunKind) {
  using enum LabRunKind;
  return std::to_array<core::Word<LabRunKind>>(
      {{diagnosis, "diagnosis"}, {comparison, "comparison"}, {fit, "fit"}});
}

enum class LabRunState { queued, running, done, failed, cancelled };
constexpr auto words(LabRunState) {
  using enum LabRunState;
  return std::to_array<core::Word<LabRunState>>({{queued, "queued"},
                                                 {running, "running"},
                                                 {done, "done"},
                                                 {failed, "failed"},
                                                 {cancelled, "cancelled"}});
}

/// Something asked of a model and a set.
struct LabRun {
  std::string id;
  LabRunKind kind = LabRunKind::diagnosis;
  std::string model_id;
  std::optional<std::string> against_id;  ///< of a comparison: the other version
  std::string set_id;
  std::string wish = "{}";  ///< JSON {"add": [id], "own": [tractus-effect/1]}
  LabRunState state = LabRunState::queued;
  double share = 0.0;                                         ///< of the work, 0 … 1
  std::string phase;                                          ///< what it is at, in words
  bool stop = false;                                          ///< someone asked to stop it
  std::optional<std::string> ranking;                         ///< JSON, early
  std::optional<std::string> result, report, samples, model;  ///< objects, once done
  std::string error;
  std::int64_t made_utc_us = 0;
  std::string made_by;
};

core::Result<void> add_model(Writing& tx, const ModelVersion& model);
core::Result<std::optional<ModelVersion>> model_of(Reading& tx, const std::string& id);
/// Newest first.
core::Result<std::vector<ModelVersion>> all_models(Reading& tx);
/// The version that was published from a run, if one was.
core::Result<std::optional<ModelVersion>> model_made_by(Reading& tx, const std::string& run);

/// The same bytes again are the same set: it keeps its name, time and maker.
core::Result<void> add_measurement_set(Writing& tx, const MeasurementSet& set);
core::Result<std::optional<MeasurementSet>> measurement_set_of(Reading& tx, const std::string& id);
/// Newest first.
core::Result<std::vector<MeasurementSet>> all_measurement_sets(Reading& tx);

core::Result<void> add_lab_run(Writing& tx, const LabRun& run);
core::Result<std::optional<LabRun>> lab_run_of(Reading& tx, const std::string& id);
/// Those that fit, newest first. Empty: any.
struct LabRunFilter {
  std::optional<LabRunKind> kind;
  std::string model_id, set_id;
  std::int64_t limit = 50;
};
core::Result<std::vector<LabRun>> lab_runs(Reading& tx, const LabRunFilter& filter);

/// Notes how far it is; the answer says whether someone asked to stop it.
core::Result<bool> note_lab_share(Writing& tx, const std::string& id, double share,
                                  const std::string& phase, std::int64_t now_utc_us);
core::Result<void> note_lab_ranking(Writing& tx, const std::string& id, const std::string& json);
/// `run`'s objects, with what is left of the rest: done.
core::Result<void> finish_lab_run(Writing& tx, const LabRun& run, std::int64_t now_utc_us);
/// @param state  failed or cancelled
core::Result<void> end_lab_run(Writing& tx, const std::string& id, LabRunState state,
                               const std::string& why, std::int64_t now_utc_us);
/// One that waits is cancelled at once, one that runs when it next looks; one that ended stays.
core::Result<void> ask_to_stop(Writing& tx, const std::string& id, std::int64_t now_utc_us);

}  // namespace tractus::store
