#include "trial/set_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/file.hpp"
#include "core/try.hpp"
#include "trial/measurement_set.hpp"
#include "trial/probing_set.hpp"

namespace tractus {
namespace trial {
namespace {

namespace fs = std::filesystem;
using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::size_t kMaxTrials = 10'000;
constexpr double kMaxSetTime_s = 1e9;

/// Letters, digits, '.', '_' and '-', not led by a dot: safe as part of a file's name.
bool is_trial_id(std::string_view id) {
  return !id.empty() && id.size() <= 64 && id[0] != '.' &&
         std::ranges::all_of(id, [](unsigned char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                  c == '.' || c == '_' || c == '-';
         });
}

Result<SetEntry> read_entry(const Json& object, const std::string& where, const fs::path& folder,
                            std::set<std::string>& ids) {
  core::Fields fields(object, where);
  SetEntry trial;
  trial.id = fields.text("id", 64);
  trial.file = fields.text("file");
  trial.operator_name = fields.text_or("operator", "");
  trial.notes = fields.text_or("notes", "");
  if (!is_trial_id(trial.id))
    fields.wrong("id",
                 "letters, digits, '.', '_' and '-' are expected, at most 64, not led by '.'");
  if (!ids.insert(trial.id).second)
    fields.wrong("id", fmt::format("'{}' is there twice", trial.id));
  if (auto why = leaves_folder(folder, trial.file); !why.empty()) fields.wrong("file", why);
  TRY(fields.done());
  return trial;
}

/// The list of trials, ids once each.
Result<std::vector<SetEntry>> read_entries(const Json& list, const fs::path& folder,
                                           const std::string& path) {
  std::vector<SetEntry> entries;
  std::set<std::string> ids;
  for (std::size_t k = 0; k < list.size(); ++k) {
    auto entry = TRY(read_entry(list[k], fmt::format("{}: /trials/{}", path, k), folder, ids));
    entries.push_back(std::move(entry));
  }
  return entries;
}

Result<Json> read_set_json(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored))
    return Error{Errc::not_found,
                 fmt::format("{}: a folder with set.json is expected", folder.string())};
  return core::read_json(folder / "set.json");
}

}  // namespace

std::string leaves_folder(const fs::path& folder, const std::string& relative) {
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

std::string wrong_time(std::span<const double> before, double t_s) {
  if (!before.empty() && t_s == before.back())
    return fmt::format("column t_s: {} is there twice", t_s);
  if (!before.empty() && t_s < before.back())
    return fmt::format("column t_s: time runs backwards, {} after {}", t_s, before.back());
  if (std::abs(t_s) > kMaxSetTime_s)
    return fmt::format("column t_s: {} is over {} s", t_s, kMaxSetTime_s);
  return {};
}

Result<SetIndex> read_set_index(const fs::path& folder, std::string_view rig,
                                const std::function<Result<void>(core::Fields&)>& more) {
  const auto json = TRY(read_set_json(folder));
  const std::string path = (folder / "set.json").string();
  core::Fields fields(json, path + ": ");
  SetIndex index;
  if (const auto format = fields.text("format", 64); format != "tractus-measurements/1")
    fields.wrong("format", fmt::format("'{}', \"tractus-measurements/1\" is expected", format));
  if (const auto stated = fields.text("rig", 64); stated != rig)
    fields.wrong("rig", fmt::format("'{}', \"{}\" is expected here", stated, rig));
  if (more) TRY(more(fields));
  for (const char* key : kStatedFields)
    if (const Json* value = fields.member(key, false)) index.stated[key] = *value;
  const Json* trials = fields.member("trials");
  if (trials && (!trials->is_array() || trials->empty() || trials->size() > kMaxTrials))
    fields.wrong("trials", fmt::format("an array of 1 to {} trials is expected", kMaxTrials));
  TRY(fields.done());
  auto entries = TRY(read_entries(*trials, folder, path));
  index.entries = std::move(entries);
  return index;
}

Result<std::string> rig_of_set(const fs::path& folder) {
  const auto json = TRY(read_set_json(folder));
  core::Fields fields(json, (folder / "set.json").string() + ": ");
  const auto rig = fields.text("rig", 64);
  if (rig != "probing" && rig != "palpation")
    fields.wrong("rig", fmt::format("'{}', \"probing\" or \"palpation\" is expected", rig));
  if (json.is_object())
    for (const auto& [key, value] : json.items()) fields.skip(key.c_str());
  TRY(fields.done());
  return rig;
}

Json set_json(std::string_view rig, const Json& stated, std::span<const SetEntry> entries) {
  Json json{{"format", "tractus-measurements/1"}, {"rig", rig}};
  for (const auto& [key, value] : stated.items()) json[key] = value;
  for (const auto& entry : entries)
    json["trials"].push_back({{"id", entry.id},
                              {"file", entry.file},
                              {"operator", entry.operator_name},
                              {"notes", entry.notes}});
  return json;
}

Result<void> write_set_file(const fs::path& folder, const std::string& relative,
                            std::string_view text) {
  if (auto why = leaves_folder(folder, relative); !why.empty()) return Error{Errc::bad_input, why};
  std::error_code ignored;
  fs::create_directories((folder / relative).parent_path(), ignored);
  return core::write_file(folder / relative, core::bytes_of(text));
}

}  // namespace trial
}  // namespace tractus
