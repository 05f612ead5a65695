#include "db/store/cases/scenarios.hpp"

#include "core/try.hpp"

namespace tractus {
namespace store {
namespace {

constexpr const char* kVersion =
    "select id, sha256, name, kind, parent, published, made_utc_us, made_by from "
    "scenario_versions ";

core::Result<std::vector<ScenarioVersion>> all_of(core::Result<Rows> rows) {
  if (!rows) return rows.error();
  std::vector<ScenarioVersion> out;
  for (const Row& row : *rows)
    out.push_back({row.text(0), row.text(1), row.text(2), row.text(3), row.text_or_null(4),
                   row.truth(5), row.integer(6), row.text(7)});
  return out;
}

}  // namespace

core::Result<void> add_scenario_version(Writing& tx, const ScenarioVersion& version) {
  TRY(tx.query(
      "insert into scenario_versions (id, sha256, name, kind, parent, published, made_utc_us, "
      "made_by) values (?, ?, ?, ?, ?, ?, ?, ?)",
      {version.id, version.sha256, version.name, version.kind, or_null(version.parent),
       bool_value(version.published), version.made_utc_us, version.made_by}));
  return {};
}

core::Result<std::optional<ScenarioVersion>> scenario_version_of(Reading& tx,
                                                                 const std::string& id) {
  auto found = TRY(all_of(tx.query(std::string(kVersion) + "where id = ?", {id})));
  if (found.empty()) return std::optional<ScenarioVersion>();
  return std::optional(std::move(found.front()));
}

core::Result<std::vector<ScenarioVersion>> all_scenario_versions(Reading& tx) {
  return all_of(tx.query(std::string(kVersion) + "order by made_utc_us desc, id", {}));
}

core::Result<void> set_scenario_published(Writing& tx, const std::string& id, bool published) {
  auto rows = TRY(tx.query("update scenario_versions set published = ? where id = ? returning id",
                           {bool_value(published), id}));
  if (rows.empty()) return core::Error{core::Errc::not_found, "no scenario " + id.substr(0, 64)};
  return {};
}

}  // namespace store
}  // namespace tractus
