#include "station/uplink/models.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/file.hpp"
#include "core/try.hpp"

namespace tractus {
namespace uplink {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMaxModel_bytes = 1u << 20;
constexpr std::size_t kMaxModels = 1000, kLeastOfId = 8;
constexpr const char* kNames = "names.json";
constexpr const char* kPath = "/api/v1/station/models";

struct Offered {
  KeptModel model;
  std::string sha256;
};

bool is_id(const std::string& id) {
  return id.size() == 32 && std::ranges::all_of(id, [](unsigned char c) {
           return std::isdigit(c) || (c >= 'a' && c <= 'f');
         });
}

/// Nothing from a server that is older than the sending of models.
core::Result<std::optional<std::vector<Offered>>> offered(Server& server) {
  const Request request{.method = "GET", .path = kPath};
  auto answer = TRY(server.send(request));
  if (answer.status == 404) return std::optional<std::vector<Offered>>();
  auto json = TRY(json_of(request, answer));
  const core::Error odd{core::Errc::bad_input,
                        "the server's list of models is not what was agreed"};
  if (!json.is_object() || !json.contains("models") || !json["models"].is_array() ||
      json["models"].size() > kMaxModels)
    return odd;
  std::vector<Offered> out;
  for (const core::Json& one : json["models"]) {
    core::Fields fields(one, "the server's model: ");
    Offered read{{fields.text("id", 32), fields.text("name", 400), fields.text("rig", 16)},
                 fields.text("sha256", 64)};
    TRY(fields.done());
    if (!is_id(read.model.id) || !core::is_sha256(read.sha256)) return odd;
    out.push_back(std::move(read));
  }
  return std::optional(std::move(out));
}

core::Result<void> fetch(Server& server, const Offered& one, const fs::path& target) {
  const Request request{.method = "GET",
                        .path = fmt::format("{}/{}", kPath, one.model.id),
                        .max_answer_bytes = kMaxModel_bytes};
  auto answer = TRY(server.send(request));
  if (answer.status != 200) return error_of(request, answer);
  if (core::sha256(answer.body) != one.sha256)
    return core::Error{core::Errc::corrupt,
                       fmt::format("model {}: is not what the server named", one.model.name)};
  return core::write_file(target, answer.body);
}

core::Result<void> say_there(Server& server, const std::string& id) {
  const Request request{.method = "POST", .path = fmt::format("{}/{}/there", kPath, id)};
  auto answer = TRY(server.send(request));
  if (answer.status / 100 != 2) return error_of(request, answer);
  return {};
}

core::Result<std::vector<KeptModel>> kept(const fs::path& folder) {
  std::vector<KeptModel> out;
  std::error_code failure;
  if (!fs::exists(folder / kNames, failure)) return out;
  auto json = TRY(core::read_json(folder / kNames));
  if (!json.is_array())
    return core::Error{core::Errc::corrupt, (folder / kNames).string() + ": an array is expected"};
  for (const core::Json& one : json) {
    core::Fields fields(one, (folder / kNames).string() + ": ");
    out.push_back({fields.text("id", 32), fields.text("name", 400), fields.text("rig", 16)});
    TRY(fields.done());
  }
  return out;
}

core::Result<void> keep_names(const fs::path& folder, const std::vector<Offered>& models) {
  core::Json list = core::Json::array();
  for (const auto& [model, _] : models)
    list.push_back({{"id", model.id}, {"name", model.name}, {"rig", model.rig}});
  return core::write_json(folder / kNames, list);
}

/// Removes the versions that are on the disk and no longer offered; returns their names.
core::Result<std::vector<std::string>> forget_recalled(const fs::path& folder,
                                                       const std::vector<Offered>& models) {
  auto known = TRY(kept(folder));
  std::vector<std::string> out;
  std::error_code failure;
  for (const KeptModel& one : known) {
    const auto is_it = [&](const Offered& other) { return other.model.id == one.id; };
    if (std::ranges::any_of(models, is_it)) continue;
    fs::remove(folder / (one.id + ".json"), failure);
    out.push_back(one.name);
  }
  return out;
}

}  // namespace

core::Json ModelReport::to_json() const {
  return {{"fetched", fetched}, {"present", present}, {"refused", refused}, {"recalled", recalled}};
}

core::Result<ModelReport> sync_models(Server& server, const fs::path& folder) {
  auto models = TRY(offered(server));
  ModelReport report;
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (!models) return report;
  for (const Offered& one : *models) {
    const fs::path target = folder / (one.model.id + ".json");
    const bool here = fs::exists(target, failure);
    auto got = here ? core::Result<void>() : fetch(server, one, target);
    if (!got && got.error().code != core::Errc::corrupt) return got.error();
    if (!got) {
      report.refused.push_back(got.error().what);
      continue;
    }
    (here ? report.present : report.fetched).push_back(one.model.name);
    TRY(say_there(server, one.model.id));
  }
  report.recalled = TRY(forget_recalled(folder, *models));
  if (models->empty() && report.recalled.empty()) return report;
  TRY(keep_names(folder, *models));
  return report;
}

core::Result<fs::path> model_named(const fs::path& folder, const std::string& name) {
  auto models = TRY(kept(folder));
  std::string there;
  for (auto at = models.rbegin(); at != models.rend(); ++at) {
    const bool by_id = name.size() >= kLeastOfId && at->id.starts_with(name);
    if (at->name == name || by_id) return folder / (at->id + ".json");
    there += (there.empty() ? "" : ", ") + at->name;
  }
  return core::Error{
      core::Errc::not_found,
      fmt::format("--model {}: no such file, and no model of this name was sent here "
                  "({})",
                  name, there.empty() ? "none was" : "there are: " + there)};
}

}  // namespace uplink
}  // namespace tractus
