#include "assessment/snapshot.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "assessment/formula.hpp"
#include "assessment/report.hpp"
#include "core/csv.hpp"
#include "core/file.hpp"
#include "core/try.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;

constexpr std::size_t kMostListedLevels = 50;

Json described(const Table& table, const std::string& column, const std::string& meaning) {
  const auto& cells = table.texts(column);
  std::size_t missing = 0;
  bool numeric = true;
  double low = 0.0, high = 0.0;
  bool first = true;
  for (const auto cell : cells) {
    if (is_missing(cell)) {
      ++missing;
      continue;
    }
    const auto number = number_in(cell);
    numeric = numeric && number.has_value();
    if (!number) continue;
    low = first ? *number : std::min(low, *number);
    high = first ? *number : std::max(high, *number);
    first = false;
  }
  Json out = {{"name", column}, {"kind", numeric && !first ? "number" : "text"}};
  if (const auto unit = unit_of(column); !unit.empty()) out["unit"] = unit;
  if (!meaning.empty()) out["meaning"] = meaning;
  out["missing"] = missing;
  if (numeric && !first) {
    out["lowest"] = low;
    out["highest"] = high;
    return out;
  }
  const auto levels = levels_of(table, column);
  if (levels.size() <= kMostListedLevels)
    out["levels"] = levels;
  else
    out["different_values"] = levels.size();
  return out;
}

core::Result<std::string> text_member(const Json& json, const char* key, const std::string& where) {
  if (!json.is_object() || !json.contains(key) || !json[key].is_string())
    return core::bad_input(fmt::format("{}: /{}: a text is expected", where, key));
  return json[key].get<std::string>();
}

}  // namespace

std::string unit_of(const std::string& column) {
  static const std::pair<const char*, const char*> kUnits[] = {{"_Ns_per_m", "N·s/m"},
                                                               {"_N_per_m", "N/m"},
                                                               {"_N_per_s", "N/s"},
                                                               {"_rad_s", "rad/s"},
                                                               {"_m_s", "m/s"},
                                                               {"_mm_s", "mm/s"},
                                                               {"_mm2_s2", "mm²/s²"},
                                                               {"_m2_s2", "m²/s²"},
                                                               {"_N2", "N²"},
                                                               {"_Ns", "N·s"},
                                                               {"_Nm", "N·m"},
                                                               {"_rad", "rad"},
                                                               {"_mm", "mm"},
                                                               {"_years", "years"},
                                                               {"_Hz", "Hz"},
                                                               {"_Pa", "Pa"},
                                                               {"_N", "N"},
                                                               {"_m", "m"},
                                                               {"_s", "s"}};
  for (const auto& [suffix, unit] : kUnits)
    if (column.ends_with(suffix)) return unit;
  return "";
}

core::Result<Snapshot> frozen(core::Bytes data, const Freezing& by) {
  auto table = TRY(Table::parse(data, by.name, {}, Missing::keep));
  Snapshot out{{{"format", "tractus-snapshot/1"},
                {"name", by.name},
                {"frozen_utc", by.utc},
                {"simulated", by.simulated},
                {"source", by.source},
                {"file", "data.csv"},
                {"sha256", core::sha256(data)},
                {"rows", table.rows()},
                {"dictionary", Json::array()}},
               std::move(data),
               std::move(table)};
  for (const auto& [column, _] : by.meanings)
    if (!out.table.has(column))
      return core::bad_input(
          fmt::format("{}: the dictionary names '{}', which is no column", by.name, column));
  for (const auto& column : out.table.columns()) {
    const auto meaning = by.meanings.find(column);
    out.description["dictionary"].push_back(
        described(out.table, column, meaning == by.meanings.end() ? "" : meaning->second));
  }
  return out;
}

core::Result<Snapshot> Snapshot::read(const std::filesystem::path& folder) {
  const auto path = folder / "snapshot.json";
  auto description = TRY(core::read_json(path));
  for (const char* key : {"format", "name", "frozen_utc", "sha256"})
    TRY(text_member(description, key, path.string()));
  if (description["format"] != "tractus-snapshot/1")
    return core::bad_input(path.string() + ": /format: should be \"tractus-snapshot/1\"");
  auto data = TRY(core::read_file(folder / "data.csv", 512ull << 20));
  if (core::sha256(data) != description["sha256"].get<std::string>())
    return core::Error{
        core::Errc::conflict,
        fmt::format("{}: the data were changed after they were frozen on {}",
                    (folder / "data.csv").string(), description["frozen_utc"].get<std::string>())};
  auto table = TRY(Table::parse(data, "data.csv", {}, Missing::keep));
  return Snapshot{std::move(description), std::move(data), std::move(table)};
}

core::Result<void> write(const Snapshot& snapshot, const std::filesystem::path& folder) {
  auto scratch = TRY(core::ScratchFolder::make(folder));
  TRY(core::write_file(scratch.path() / "data.csv", snapshot.data));
  TRY(core::write_json(scratch.path() / "snapshot.json", snapshot.description));
  return scratch.keep_as(folder);
}

std::string marked(const Table& table, const std::vector<std::string>& excluded_because) {
  std::string out;
  const auto add = [&](std::string_view cell, bool last) {
    out += core::csv_cell(cell) + (last ? '\n' : ',');
  };
  for (const auto& column : table.columns()) add(column, false);
  add("excluded_because", true);
  for (std::size_t i = 0; i < table.rows(); ++i) {
    for (const auto& column : table.columns()) add(table.texts(column)[i], false);
    add(excluded_because[i], true);
  }
  return out;
}

Json dictionary_of_marked(const Json& description) {
  Json out = description["dictionary"];
  out.push_back({{"name", "excluded_because"},
                 {"kind", "text"},
                 {"meaning", "why the plan leaves the row out; empty for rows used"}});
  return out;
}

}  // namespace assessment
}  // namespace tractus
