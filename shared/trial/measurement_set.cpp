#include "trial/measurement_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "core/file.hpp"
#include "trial/csv.hpp"

namespace trial {
namespace {

namespace fs = std::filesystem;
using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::size_t kMaxRowsOfSet = 20'000'000;
constexpr std::size_t kMaxTrials = 10'000;
constexpr double kMaxPosition_m = 100.0;
constexpr double kMaxWrench = 1e6;  // N and N·m
constexpr double kMaxTime_s = 1e9;

/// Letters, digits, '.', '_' and '-', not led by a dot: safe as part of a file's name.
bool is_trial_id(std::string_view id) {
  return !id.empty() && id.size() <= 64 && id[0] != '.' &&
         std::ranges::all_of(id, [](unsigned char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                  c == '.' || c == '_' || c == '-';
         });
}

/// What is wrong with a relative path that must stay within `folder`, or nothing.
std::string leaves(const fs::path& folder, const std::string& relative) {
  const fs::path path(relative);
  if (relative.empty() || relative.find('\0') != std::string::npos)
    return "a relative path is expected";
  if (path.is_absolute())
    return fmt::format("'{}' is an absolute path, one relative to the set is expected", relative);
  std::error_code failure;
  const fs::path root = fs::weakly_canonical(folder, failure);
  const fs::path target = failure ? fs::path() : fs::weakly_canonical(folder / path, failure);
  if (!failure && target == root) return fmt::format("'{}' is not a file", relative);
  const auto [at_root, at_target] =
      std::mismatch(root.begin(), root.end(), target.begin(), target.end());
  if (failure || at_root != root.end() || at_target == target.end() ||
      std::ranges::find(path, fs::path("..")) != path.end())
    return fmt::format("'{}' leaves the set's folder", relative);
  return {};
}

Result<StatedTract> read_tract(const Json& object, const std::string& where) {
  core::Fields fields(object, where);
  const auto entry = fields.numbers("entry_m", 3), axis = fields.numbers("axis", 3);
  StatedTract tract{{entry[0], entry[1], entry[2]}, {axis[0], axis[1], axis[2]}, 0.0};
  tract.length_m = fields.number("length_m", 1e-6, 10.0);
  if (!(std::abs(tract.axis.norm() - 1.0) <= 0.01))
    fields.wrong("axis",
                 fmt::format("has length {:.4g}, a unit vector is expected", tract.axis.norm()));
  if (auto done = fields.done(); !done) return done.error();
  tract.axis.normalize();
  return tract;
}

Result<PalpationMeasurement> read_entry(const Json& object, const std::string& where,
                                        const fs::path& folder, std::set<std::string>& ids) {
  core::Fields fields(object, where);
  PalpationMeasurement trial;
  trial.id = fields.text("id", 64);
  trial.file = fields.text("file");
  trial.operator_name = fields.text_or("operator", "");
  trial.notes = fields.text_or("notes", "");
  if (!is_trial_id(trial.id))
    fields.wrong("id",
                 "letters, digits, '.', '_' and '-' are expected, at most 64, not led by '.'");
  if (!ids.insert(trial.id).second)
    fields.wrong("id", fmt::format("'{}' is there twice", trial.id));
  if (auto why = leaves(folder, trial.file); !why.empty()) fields.wrong("file", why);
  if (auto done = fields.done(); !done) return done.error();
  return trial;
}

Result<PalpationSet> read_index(const fs::path& folder) {
  const fs::path path = folder / "set.json";
  const auto json = core::read_json(path);
  if (!json) return json.error();
  core::Fields fields(*json, path.string() + ": ");
  PalpationSet set;
  set.folder = folder;
  if (const auto format = fields.text("format", 64); format != "tractus-measurements/1")
    fields.wrong("format", fmt::format("'{}', \"tractus-measurements/1\" is expected", format));
  if (const auto rig = fields.text("rig", 64); rig != "palpation")
    fields.wrong("rig", fmt::format("'{}', \"palpation\" is expected here", rig));
  if (fields.has("volume")) {
    set.volume = fields.text("volume");
    if (auto why = leaves(folder, set.volume); !why.empty()) fields.wrong("volume", why);
  }
  if (const Json* object = fields.member("tract", false)) {
    const auto tract = read_tract(*object, path.string() + ": /tract");
    if (!tract) return tract.error();
    set.tract = *tract;
  }
  for (const char* key : kStatedFields)
    if (const Json* value = fields.member(key, false)) set.stated[key] = *value;
  const Json* trials = fields.member("trials");
  if (trials && (!trials->is_array() || trials->empty() || trials->size() > kMaxTrials))
    fields.wrong("trials", fmt::format("an array of 1 to {} trials is expected", kMaxTrials));
  if (auto done = fields.done(); !done) return done.error();
  std::set<std::string> ids;
  for (std::size_t k = 0; k < trials->size(); ++k) {
    auto trial =
        read_entry((*trials)[k], fmt::format("{}: /trials/{}", path.string(), k), folder, ids);
    if (!trial) return trial.error();
    set.trials.push_back(std::move(*trial));
  }
  return set;
}

/// Takes a row in; says what is wrong with it, if anything.
std::string take(std::span<const double> v, PalpationMeasurement& trial) {
  const double t = v[0];
  if (!trial.t_s.empty() && t == trial.t_s.back())
    return fmt::format("column t_s: {} is there twice", t);
  if (!trial.t_s.empty() && t < trial.t_s.back())
    return fmt::format("column t_s: time runs backwards, {} after {}", t, trial.t_s.back());
  if (std::abs(t) > kMaxTime_s) return fmt::format("column t_s: {} is over {} s", t, kMaxTime_s);
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
  Json json{{"format", "tractus-measurements/1"}, {"rig", "palpation"}};
  if (!set.volume.empty()) json["volume"] = set.volume;
  if (set.tract) {
    const auto list = [](const math::Vec3& v) { return Json{v.x(), v.y(), v.z()}; };
    json["tract"] = Json{{"entry_m", list(set.tract->entry_m)},
                         {"axis", list(set.tract->axis)},
                         {"length_m", set.tract->length_m}};
  }
  for (const auto& [key, value] : set.stated.items()) json[key] = value;
  for (const auto& trial : set.trials)
    json["trials"].push_back({{"id", trial.id},
                              {"file", trial.file},
                              {"operator", trial.operator_name},
                              {"notes", trial.notes}});
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
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored))
    return Error{Errc::not_found,
                 fmt::format("{}: a folder with set.json is expected", folder.string())};
  auto set = read_index(folder);
  if (!set) return set;
  std::size_t total = 0;
  for (auto& trial : set->trials) {
    const auto rows = read_rows(folder / trial.file, trial);
    if (!rows) return rows.error();
    total += *rows;
    if (total > kMaxRowsOfSet)
      return Error{Errc::too_large,
                   fmt::format("{}: more than {} rows in the set", folder.string(), kMaxRowsOfSet)};
  }
  return set;
}

Result<void> write_palpation_set(const fs::path& folder, const PalpationSet& set) {
  auto scratch = core::ScratchFolder::make(folder);
  if (!scratch) return scratch.error();
  for (const auto& trial : set.trials) {
    const fs::path path = scratch->path() / trial.file;
    std::error_code ignored;
    if (auto why = leaves(scratch->path(), trial.file); !why.empty())
      return Error{Errc::bad_input, why};
    fs::create_directories(path.parent_path(), ignored);
    if (auto written = core::write_file(path, core::bytes_of(csv_of(trial))); !written)
      return written;
  }
  if (auto written = core::write_json(scratch->path() / "set.json", index_of(set)); !written)
    return written;
  return scratch->keep_as(folder);
}

}  // namespace trial
