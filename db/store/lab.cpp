#include "db/store/lab.hpp"

namespace store {
namespace {

constexpr const char* kModel =
    "select id, name, rig, sha256, parent, diagnosis_id, made_utc_us, made_by from models ";

ModelVersion model_from(const Row& row) {
  return {row.text(0),         row.text(1),         row.text(2),    row.text(3),
          row.text_or_null(4), row.text_or_null(5), row.integer(6), row.text(7)};
}

core::Result<std::optional<ModelVersion>> one_model(Reading& tx, const char* where,
                                                    const std::string& value) {
  auto rows = tx.query(std::string(kModel) + where, {value});
  if (!rows) return rows.error();
  if (rows->empty()) return std::optional<ModelVersion>();
  return std::optional(model_from(rows->front()));
}

core::Result<void> done(core::Result<Rows> rows) {
  if (!rows) return rows.error();
  return {};
}

}  // namespace

core::Result<void> add_model(Writing& tx, const ModelVersion& model) {
  return done(tx.query(
      "insert into models (id, name, rig, sha256, parent, diagnosis_id, made_utc_us, made_by) "
      "values (?, ?, ?, ?, ?, ?, ?, ?)",
      {model.id, model.name, model.rig, model.sha256, or_null(model.parent),
       or_null(model.diagnosis), model.made_utc_us, model.made_by}));
}

core::Result<std::optional<ModelVersion>> model_of(Reading& tx, const std::string& id) {
  return one_model(tx, "where id = ?", id);
}

core::Result<std::optional<ModelVersion>> model_made_by(Reading& tx, const std::string& diagnosis) {
  return one_model(tx, "where diagnosis_id = ?", diagnosis);
}

core::Result<std::vector<ModelVersion>> all_models(Reading& tx) {
  auto rows = tx.query(std::string(kModel) + "order by made_utc_us desc, id");
  if (!rows) return rows.error();
  std::vector<ModelVersion> out;
  for (const Row& row : *rows) out.push_back(model_from(row));
  return out;
}

core::Result<void> add_measurement_set(Writing& tx, const MeasurementSet& set) {
  return done(
      tx.query("insert into measurement_sets (id, name, made_utc_us, made_by) values (?, ?, ?, ?) "
               "on conflict (id) do nothing",
               {set.id, set.name, set.made_utc_us, set.made_by}));
}

core::Result<std::optional<MeasurementSet>> measurement_set_of(Reading& tx, const std::string& id) {
  auto rows =
      tx.query("select id, name, made_utc_us, made_by from measurement_sets where id = ?", {id});
  if (!rows) return rows.error();
  if (rows->empty()) return std::optional<MeasurementSet>();
  const Row& row = rows->front();
  return std::optional(MeasurementSet{row.text(0), row.text(1), row.integer(2), row.text(3)});
}

core::Result<void> add_diagnosis(Writing& tx, const DiagnosisRun& run) {
  return done(tx.query(
      "insert into diagnoses (id, model_id, set_id, state, share, stop, error, made_utc_us, "
      "made_by, changed_utc_us) values (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
      {run.id, run.model_id, run.set_id, run.state, run.share, bool_value(run.stop), run.error,
       run.made_utc_us, run.made_by, run.made_utc_us}));
}

core::Result<std::optional<DiagnosisRun>> diagnosis_of(Reading& tx, const std::string& id) {
  auto rows = tx.query(
      "select id, model_id, set_id, state, share, stop, result, report, error, made_utc_us, "
      "made_by from diagnoses where id = ?",
      {id});
  if (!rows) return rows.error();
  if (rows->empty()) return std::optional<DiagnosisRun>();
  const Row& row = rows->front();
  return std::optional(DiagnosisRun{
      row.text(0), row.text(1), row.text(2), row.text(3), row.number(4), row.truth(5),
      row.text_or_null(6), row.text_or_null(7), row.text(8), row.integer(9), row.text(10)});
}

core::Result<bool> note_diagnosis_share(Writing& tx, const std::string& id, double share,
                                        std::int64_t now_utc_us) {
  auto rows = tx.query(
      "update diagnoses set state = 'running', share = ?, changed_utc_us = ? where id = ? "
      "returning stop",
      {share, now_utc_us, id});
  if (!rows) return rows.error();
  return rows->empty() || rows->front().truth(0);
}

core::Result<void> finish_diagnosis(Writing& tx, const std::string& id, const std::string& result,
                                    const std::string& report, std::int64_t now_utc_us) {
  return done(
      tx.query("update diagnoses set state = 'done', share = 1.0, result = ?, report = ?, "
               "changed_utc_us = ? where id = ?",
               {result, report, now_utc_us, id}));
}

core::Result<void> end_diagnosis(Writing& tx, const std::string& id, const std::string& state,
                                 const std::string& why, std::int64_t now_utc_us) {
  return done(tx.query("update diagnoses set state = ?, error = ?, changed_utc_us = ? where id = ?",
                       {state, why, now_utc_us, id}));
}

core::Result<void> ask_to_stop(Writing& tx, const std::string& id, std::int64_t now_utc_us) {
  return done(
      tx.query("update diagnoses set stop = 1, changed_utc_us = ?, "
               "state = case state when 'queued' then 'cancelled' else state end "
               "where id = ? and state in ('queued', 'running')",
               {now_utc_us, id}));
}

}  // namespace store
