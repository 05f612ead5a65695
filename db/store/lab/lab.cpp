#include "db/store/lab/lab.hpp"

#include "core/try.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {

constexpr const char* kModel =
    "select id, name, rig, sha256, parent, run_id, made_utc_us, made_by, note from models ";
constexpr const char* kSet =
    "select s.id, s.name, s.made_utc_us, s.made_by, s.rig, s.simulated, s.trials, s.samples, "
    "o.size_bytes from measurement_sets s join objects o on o.sha256 = s.id ";
constexpr const char* kSelectRun =
    "select id, kind, model_id, against_id, set_id, wish, state, share, phase, stop, ranking, "
    "result, report, samples, model_sha256, error, made_utc_us, made_by from lab_runs ";

core::Result<ModelVersion> model_from(const Row& row) {
  return ModelVersion{row.text(0),    row.text(1),         row.text(2),
                      row.text(3),    row.text_or_null(4), row.text_or_null(5),
                      row.integer(6), row.text(7),         row.text(8)};
}

core::Result<MeasurementSet> set_from(const Row& row) {
  MeasurementSet out{row.text(0), row.text(1),         row.integer(2),
                     row.text(3), row.text_or_null(4), row.truth_or_null(5)};
  if (out.rig) out.trials = row.count(6), out.samples = row.count(7);
  out.size_bytes = row.count(8);
  return out;
}

core::Result<LabRun> lab_run_from(const Row& row) {
  LabRun out;
  out.id = row.text(0);
  out.kind = TRY(row.word<LabRunKind>(1, "lab_runs.kind"));
  out.model_id = row.text(2);
  out.against_id = row.text_or_null(3);
  out.set_id = row.text(4);
  out.wish = row.text(5);
  out.state = TRY(row.word<LabRunState>(6, "lab_runs.state"));
  out.share = row.number(7);
  out.phase = row.text(8);
  out.stop = row.truth(9);
  out.ranking = row.text_or_null(10);
  out.result = row.text_or_null(11);
  out.report = row.text_or_null(12);
  out.samples = row.text_or_null(13);
  out.model = row.text_or_null(14);
  out.error = row.text(15);
  out.made_utc_us = row.integer(16);
  out.made_by = row.text(17);
  return out;
}

}  // namespace

core::Result<void> add_model(Writing& tx, const ModelVersion& model) {
  return done(
      tx.query("insert into models (id, name, rig, sha256, parent, run_id, made_utc_us, made_by, "
               "note) values (?, ?, ?, ?, ?, ?, ?, ?, ?)",
               {model.id, model.name, model.rig, model.sha256, or_null(model.parent),
                or_null(model.run), model.made_utc_us, model.made_by, model.note}));
}

core::Result<std::optional<ModelVersion>> model_of(Reading& tx, const std::string& id) {
  return one_of(tx.query(std::string(kModel) + "where id = ?", {id}), model_from);
}

core::Result<std::optional<ModelVersion>> model_made_by(Reading& tx, const std::string& run) {
  return one_of(tx.query(std::string(kModel) + "where run_id = ?", {run}), model_from);
}

core::Result<std::vector<ModelVersion>> all_models(Reading& tx) {
  return all_of(tx.query(std::string(kModel) + "order by made_utc_us desc, id", {}), model_from);
}

core::Result<void> add_measurement_set(Writing& tx, const MeasurementSet& set) {
  const std::optional<std::string>& rig = set.rig;
  return done(tx.query(
      "insert into measurement_sets (id, name, made_utc_us, made_by, rig, simulated, "
      "trials, samples) values (?, ?, ?, ?, ?, ?, ?, ?) on conflict (id) do update set "
      "rig = excluded.rig, simulated = excluded.simulated, trials = excluded.trials, "
      "samples = excluded.samples",
      {set.id, set.name, set.made_utc_us, set.made_by, or_null(rig),
       set.simulated ? bool_value(*set.simulated) : Value(),
       rig ? count_value(set.trials) : Value(), rig ? count_value(set.samples) : Value()}));
}

core::Result<std::optional<MeasurementSet>> measurement_set_of(Reading& tx, const std::string& id) {
  return one_of(tx.query(std::string(kSet) + "where s.id = ?", {id}), set_from);
}

core::Result<std::vector<MeasurementSet>> all_measurement_sets(Reading& tx) {
  return all_of(tx.query(std::string(kSet) + "order by s.made_utc_us desc, s.id", {}), set_from);
}

core::Result<void> add_lab_run(Writing& tx, const LabRun& run) {
  return done(tx.query(
      "insert into lab_runs (id, kind, model_id, against_id, set_id, wish, state, share, phase, "
      "stop, error, made_utc_us, made_by, changed_utc_us) "
      "values (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
      {run.id, name_value(run.kind), run.model_id, or_null(run.against_id), run.set_id, run.wish,
       name_value(run.state), run.share, run.phase, bool_value(run.stop), run.error,
       run.made_utc_us, run.made_by, run.made_utc_us}));
}

core::Result<std::optional<LabRun>> lab_run_of(Reading& tx, const std::string& id) {
  return one_of(tx.query(std::string(kSelectRun) + "where id = ?", {id}), lab_run_from);
}

core::Result<std::vector<LabRun>> lab_runs(Reading& tx, const LabRunFilter& filter) {
  const std::string kind(filter.kind ? core::name(*filter.kind) : "");
  return all_of(tx.query(std::string(kSelectRun) +
                             "where (? = '' or kind = ?) and (? = '' or model_id = ? or "
                             "against_id = ?) and (? = '' or set_id = ?) "
                             "order by made_utc_us desc, id limit ?",
                         {kind, kind, filter.model_id, filter.model_id, filter.model_id,
                          filter.set_id, filter.set_id, filter.limit}),
                lab_run_from);
}

core::Result<bool> note_lab_share(Writing& tx, const std::string& id, double share,
                                  const std::string& phase, std::int64_t now_utc_us) {
  auto rows = TRY(
      tx.query("update lab_runs set state = 'running', share = ?, phase = ?, changed_utc_us = ? "
               "where id = ? returning stop",
               {share, phase, now_utc_us, id}));
  return rows.empty() || rows.front().truth(0);
}

core::Result<void> note_lab_ranking(Writing& tx, const std::string& id, const std::string& json) {
  return done(tx.query("update lab_runs set ranking = ? where id = ?", {json, id}));
}

core::Result<void> finish_lab_run(Writing& tx, const LabRun& run, std::int64_t now_utc_us) {
  return done(tx.query(
      "update lab_runs set state = 'done', share = 1.0, phase = '', result = ?, report = ?, "
      "samples = ?, model_sha256 = ?, changed_utc_us = ? where id = ?",
      {or_null(run.result), or_null(run.report), or_null(run.samples), or_null(run.model),
       now_utc_us, run.id}));
}

core::Result<void> end_lab_run(Writing& tx, const std::string& id, LabRunState state,
                               const std::string& why, std::int64_t now_utc_us) {
  return done(tx.query(
      "update lab_runs set state = ?, phase = '', error = ?, changed_utc_us = ? where id = ?",
      {name_value(state), why, now_utc_us, id}));
}

core::Result<void> ask_to_stop(Writing& tx, const std::string& id, std::int64_t now_utc_us) {
  return done(
      tx.query("update lab_runs set stop = 1, changed_utc_us = ?, "
               "state = case state when 'queued' then 'cancelled' else state end "
               "where id = ? and state in ('queued', 'running')",
               {now_utc_us, id}));
}

}  // namespace store
}  // namespace tractus
