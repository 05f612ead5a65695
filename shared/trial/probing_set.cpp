#include "trial/probing_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/file.hpp"
#include "core/try.hpp"
#include "trial/csv.hpp"
#include "trial/set_index.hpp"

namespace tractus {
namespace trial {
namespace {

namespace fs = std::filesystem;
using core::Errc;
using core::Error;
using core::Json;
using core::Result;

/// A column beyond time: where its numbers go and how large they may be.
struct SetColumn {
  std::string_view name;
  std::vector<double> ProbingMeasurement::*numbers;
  double largest;
  const char* unit;
};
constexpr std::array kColumns{
    SetColumn{kProbingColumns[1], &ProbingMeasurement::x_m, 10.0, "m"},
    SetColumn{kProbingColumns[2], &ProbingMeasurement::theta_rad, 1e6, "rad"},
    SetColumn{kProbingColumns[3], &ProbingMeasurement::fz_N, 1e6, "N"},
    SetColumn{kProbingColumns[4], &ProbingMeasurement::tz_Nm, 1e6, "N·m"},
};

/// The columns of a file that are ours, or what it lacks.
Result<std::vector<SetColumn>> columns_of(const fs::path& path) {
  const auto header = TRY(csv_header(path));
  const auto there = [&](std::string_view name) {
    return std::ranges::find(header, name) != header.end();
  };
  const bool slides = there("x_m") && there("fz_N");
  const bool turns = there("theta_rad") && there("tz_Nm");
  if (there("t_s") && !slides && !turns)
    return Error{Errc::bad_input,
                 fmt::format("{}:1: column {} is missing; x_m with fz_N is expected, or theta_rad "
                             "with tz_Nm where the rig only turns",
                             path.string(), there("x_m") ? "fz_N" : "x_m")};
  std::vector<SetColumn> columns;
  for (const SetColumn& column : kColumns)
    if (there(column.name)) columns.push_back(column);
  return columns;
}

Result<std::size_t> read_rows(const fs::path& path, ProbingMeasurement& trial) {
  const auto columns = TRY(columns_of(path));
  std::vector<std::string_view> names{"t_s"};
  for (const SetColumn& column : columns) names.push_back(column.name);
  const auto rows = read_csv(path, names, [&](std::size_t, std::span<const double> v) {
    if (auto why = wrong_time(trial.t_s, v[0]); !why.empty()) return why;
    for (std::size_t c = 0; c < columns.size(); ++c)
      if (std::abs(v[c + 1]) > columns[c].largest)
        return fmt::format("column {}: {} is over {} {}", names[c + 1], v[c + 1],
                           columns[c].largest, columns[c].unit);
    trial.t_s.push_back(v[0]);
    for (std::size_t c = 0; c < columns.size(); ++c)
      (trial.*columns[c].numbers).push_back(v[c + 1]);
    return std::string();
  });
  if (rows && *rows < 2)
    return Error{Errc::bad_input,
                 fmt::format("{}: {} rows, at least 2 are expected", path.string(), *rows)};
  return rows;
}

/// What is stated in our columns' names; anything else that stands there is left as it is.
StatedNoise noise_of(const Json& stated) {
  StatedNoise noise;
  if (!stated.contains("noise") || !stated["noise"].is_object()) return noise;
  const auto number = [&](const char* key) -> std::optional<double> {
    const Json& object = stated["noise"];
    if (!object.contains(key) || !object[key].is_number()) return {};
    const double value = object[key].get<double>();
    return std::isfinite(value) && value > 0.0 ? std::optional(value) : std::nullopt;
  };
  noise.x_m = number("x_m");
  noise.theta_rad = number("theta_rad");
  noise.fz_N = number("fz_N");
  noise.tz_Nm = number("tz_Nm");
  return noise;
}

std::string csv_of(const ProbingMeasurement& trial) {
  std::string out = "t_s";
  for (const SetColumn& column : kColumns)
    if (!(trial.*column.numbers).empty()) out += fmt::format(",{}", column.name);
  out += '\n';
  for (std::size_t k = 0; k < trial.t_s.size(); ++k) {
    out += fmt::format("{}", trial.t_s[k]);
    for (const SetColumn& column : kColumns)
      if (!(trial.*column.numbers).empty()) out += fmt::format(",{}", (trial.*column.numbers)[k]);
    out += '\n';
  }
  return out;
}

}  // namespace

Result<ProbingSet> read_probing_set(const fs::path& folder) {
  auto index = TRY(read_set_index(folder, "probing"));
  ProbingSet set;
  set.folder = folder;
  set.stated = std::move(index.stated);
  set.noise = noise_of(set.stated);
  std::size_t total = 0;
  for (SetEntry& entry : index.entries) {
    ProbingMeasurement trial;
    trial.id = std::move(entry.id);
    trial.file = std::move(entry.file);
    trial.operator_name = std::move(entry.operator_name);
    trial.notes = std::move(entry.notes);
    const auto rows = TRY(read_rows(folder / trial.file, trial));
    total += rows;
    if (total > kMaxRowsOfSet)
      return Error{Errc::too_large,
                   fmt::format("{}: more than {} rows in the set", folder.string(), kMaxRowsOfSet)};
    set.trials.push_back(std::move(trial));
  }
  return set;
}

Result<void> write_probing_set(const fs::path& folder, const ProbingSet& set) {
  auto scratch = TRY(core::ScratchFolder::make(folder));
  std::vector<SetEntry> entries;
  for (const auto& trial : set.trials) {
    TRY(write_set_file(scratch.path(), trial.file, csv_of(trial)));
    entries.push_back({trial.id, trial.file, trial.operator_name, trial.notes});
  }
  const Json json = set_json("probing", set.stated, entries);
  TRY(core::write_json(scratch.path() / "set.json", json));
  return scratch.keep_as(folder);
}

}  // namespace trial
}  // namespace tractus
