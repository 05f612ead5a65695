#include "trial/measurement_set.hpp"

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

constexpr double kMaxPosition_m = 100.0;
constexpr double kMaxWrench = 1e6;  // N and N·m

Result<StatedTract> read_tract(const Json& object, const std::string& where) {
  core::Fields fields(object, where);
  const auto entry = fields.numbers("entry_m", 3), axis = fields.numbers("axis", 3);
  StatedTract tract{{entry[0], entry[1], entry[2]}, {axis[0], axis[1], axis[2]}, 0.0};
  tract.length_m = fields.number("length_m", 1e-6, 10.0);
  if (!(std::abs(tract.axis.norm() - 1.0) <= 0.01))
    fields.wrong("axis",
                 fmt::format("has length {:.4g}, a unit vector is expected", tract.axis.norm()));
  TRY(fields.done());
  tract.axis.normalize();
  return tract;
}

Result<PalpationSet> read_index(const fs::path& folder) {
  PalpationSet set;
  set.folder = folder;
  auto index = TRY(read_set_index(folder, "palpation", [&](core::Fields& fields) -> Result<void> {
    if (fields.has("volume")) {
      set.volume = fields.text("volume");
      if (auto why = leaves_folder(folder, set.volume); !why.empty()) fields.wrong("volume", why);
    }
    if (const Json* object = fields.member("tract", false)) {
      const auto tract = TRY(read_tract(*object, fields.where() + "/tract"));
      set.tract = tract;
    }
    return {};
  }));
  set.stated = std::move(index.stated);
  for (SetEntry& entry : index.entries)
    set.trials.push_back({std::move(entry.id),
                          std::move(entry.file),
                          std::move(entry.operator_name),
                          std::move(entry.notes),
                          {},
                          {},
                          {}});
  return set;
}

/// Takes a row in; says what is wrong with it, if anything.
std::string take(std::span<const double> v, PalpationMeasurement& trial) {
  const double t = v[0];
  if (auto why = wrong_time(trial.t_s, t); !why.empty()) return why;
  for (std::size_t c = 1; c < 4; ++c)
    if (std::abs(v[c]) > kMaxPosition_m)
      return fmt::format("column {}: {} is over {} m; metres are expected", kPalpationColumns[c],
                         v[c], kMaxPosition_m);
  for (std::size_t c = 8; c < 14; ++c)
    if (std::abs(v[c]) > kMaxWrench)
      return fmt::format("column {}: {} is over {}; N and N·m are expected", kPalpationColumns[c],
                         v[c], kMaxWrench);
  const math::Quat q(v[4], v[5], v[6], v[7]);
  if (!(std::abs(q.norm() - 1.0) <= 0.01))
    return fmt::format("columns qw to qz: the quaternion's length is {:.4g}, 1 is expected",
                       q.norm());
  trial.t_s.push_back(t);
  trial.X_VH.push_back({{v[1], v[2], v[3]}, q.normalized()});
  trial.wrench_H.push_back({{v[8], v[9], v[10]}, {v[11], v[12], v[13]}});
  return {};
}

Result<std::size_t> read_rows(const fs::path& path, PalpationMeasurement& trial) {
  const auto rows = read_csv(path, kPalpationColumns, [&](std::size_t, std::span<const double> v) {
    return take(v, trial);
  });
  if (rows && *rows < 2)
    return Error{Errc::bad_input,
                 fmt::format("{}: {} rows, at least 2 are expected", path.string(), *rows)};
  return rows;
}

std::string csv_of(const PalpationMeasurement& trial) {
  std::string out = fmt::format("{}\n", fmt::join(kPalpationColumns, ","));
  for (std::size_t k = 0; k < trial.t_s.size(); ++k)
    out += palpation_row(trial.t_s[k], trial.X_VH[k], trial.wrench_H[k]) + "\n";
  return out;
}

Json index_of(const PalpationSet& set) {
  std::vector<SetEntry> entries;
  for (const auto& trial : set.trials)
    entries.push_back({trial.id, trial.file, trial.operator_name, trial.notes});
  Json json = set_json("palpation", set.stated, entries);
  if (!set.volume.empty()) json["volume"] = set.volume;
  if (set.tract) {
    const auto list = [](const math::Vec3& v) { return Json{v.x(), v.y(), v.z()}; };
    json["tract"] = Json{{"entry_m", list(set.tract->entry_m)},
                         {"axis", list(set.tract->axis)},
                         {"length_m", set.tract->length_m}};
  }
  return json;
}

}  // namespace

std::string palpation_row(double t_s, const math::Pose& X_VH, const math::Wrench& wrench_H) {
  const auto& [f, t] = wrench_H;
  const auto& [p, q] = X_VH;
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}", t_s, p.x(), p.y(), p.z(), q.w(),
                     q.x(), q.y(), q.z(), f.x(), f.y(), f.z(), t.x(), t.y(), t.z());
}

Result<PalpationSet> read_palpation_set(const fs::path& folder) {
  auto set = read_index(folder);
  if (!set) return set;
  std::size_t total = 0;
  for (auto& trial : set->trials) {
    const auto rows = TRY(read_rows(folder / trial.file, trial));
    total += rows;
    if (total > kMaxRowsOfSet)
      return Error{Errc::too_large,
                   fmt::format("{}: more than {} rows in the set", folder.string(), kMaxRowsOfSet)};
  }
  return set;
}

Result<void> write_palpation_set(const fs::path& folder, const PalpationSet& set) {
  auto scratch = TRY(core::ScratchFolder::make(folder));
  for (const auto& trial : set.trials) {
    TRY(write_set_file(scratch.path(), trial.file, csv_of(trial)));
  }
  TRY(core::write_json(scratch.path() / "set.json", index_of(set)));
  return scratch.keep_as(folder);
}

}  // namespace trial
}  // namespace tractus
