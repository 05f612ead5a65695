#include "db/store/stations/sent_models.hpp"

#include "core/try.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {

std::optional<std::int64_t> time_or_nothing(const Row& row, std::size_t column) {
  if (std::holds_alternative<std::monostate>(row.value(column))) return std::nullopt;
  return row.integer(column);
}

core::Result<void> check_sent(Reading& tx, const std::string& model_id,
                              const std::string& station_id) {
  auto sent =
      TRY(tx.query("select model_id from station_models where station_id = ? and model_id = ?",
                   {station_id, model_id}));
  if (!sent.empty()) return {};
  return core::Error{core::Errc::not_found, "no model " + model_id.substr(0, 32) + " was sent"};
}

}  // namespace

core::Result<void> send_model(Writing& tx, const std::string& model_id,
                              const std::string& station_id, const std::string& by,
                              std::int64_t now_utc_us) {
  auto there = TRY(
      tx.query("select id from stations where id = ? and revoked_utc_us is null", {station_id}));
  if (there.empty())
    return core::Error{core::Errc::not_found, "no station " + station_id.substr(0, 32)};
  return done(
      tx.query("insert into station_models (station_id, model_id, asked_utc_us, asked_by) values "
               "(?, ?, ?, ?) on conflict (station_id, model_id) do nothing",
               {station_id, model_id, now_utc_us, by}));
}

core::Result<void> recall_model(Writing& tx, const std::string& model_id,
                                const std::string& station_id) {
  TRY(check_sent(tx, model_id, station_id));
  return done(tx.query("delete from station_models where station_id = ? and model_id = ?",
                       {station_id, model_id}));
}

core::Result<std::vector<SentModel>> sent_to(Reading& tx, const std::string& model_id) {
  auto rows = TRY(tx.query(
      "select s.id, s.name, m.asked_utc_us, m.asked_by, m.there_utc_us from stations s left join "
      "station_models m on m.station_id = s.id and m.model_id = ? where s.revoked_utc_us is null "
      "order by s.name",
      {model_id}));
  std::vector<SentModel> out;
  for (const Row& row : rows)
    out.push_back({row.text(0), row.text(1), time_or_nothing(row, 2),
                   row.text_or_null(3).value_or(""), time_or_nothing(row, 4)});
  return out;
}

core::Result<std::vector<ModelVersion>> models_for(Reading& tx, const std::string& station_id) {
  auto rows = TRY(tx.query(
      "select model_id from station_models where station_id = ? order by asked_utc_us, model_id",
      {station_id}));
  std::vector<ModelVersion> out;
  for (const Row& row : rows) {
    auto model = TRY(model_of(tx, row.text(0)));
    if (model) out.push_back(std::move(*model));
  }
  return out;
}

core::Result<void> note_model_there(Writing& tx, const std::string& model_id,
                                    const std::string& station_id, std::int64_t now_utc_us) {
  TRY(check_sent(tx, model_id, station_id));
  return done(
      tx.query("update station_models set there_utc_us = ? where station_id = ? and model_id = ? "
               "and there_utc_us is null",
               {now_utc_us, station_id, model_id}));
}

}  // namespace store
}  // namespace tractus
