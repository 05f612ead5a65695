#include "station/uplink/sync.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cases/case.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "station/uplink/part_fetch.hpp"

namespace tractus {
namespace uplink {
namespace fs = std::filesystem;
namespace {
constexpr std::uint64_t kMaxManifest_bytes = 1u << 20;
constexpr std::uint64_t kMaxPart_bytes = 4ull << 30;
constexpr std::size_t kMaxCases = 10'000;

core::Result<core::Bytes> fetch(Server& server, const std::string& path, std::uint64_t limit) {
  const Request request{.method = "GET", .path = path, .max_answer_bytes = limit};
  auto answer = TRY(server.send(request));
  if (answer.status != 200) return error_of(request, answer);
  return std::move(answer.body);
}

core::Result<std::vector<std::string>> case_ids(Server& server) {
  const Request request{.method = "GET", .path = "/api/v1/cases", .max_answer_bytes = 16u << 20};
  auto answer = TRY(server.send(request));
  auto json = TRY(json_of(request, answer));
  const core::Error odd{core::Errc::bad_input, "the server's list of cases is not what was agreed"};
  if (!json.is_object() || !json.contains("cases") || !json["cases"].is_array()) return odd;
  std::vector<std::string> out;
  for (const auto& one : json["cases"]) {
    if (!one.is_object() || !one.contains("id") || !one["id"].is_string()) return odd;
    out.push_back(one["id"].get<std::string>());
    if (!core::is_sha256(out.back()) || out.size() > kMaxCases) return odd;
  }
  return out;
}

bool plain_name(const std::string& name) {
  return !name.empty() && name.size() <= 100 && name.front() != '.' &&
         std::ranges::all_of(name, [](unsigned char c) {
           return std::isalnum(c) || c == '.' || c == '-' || c == '_';
         });
}

fs::path incoming_of(const fs::path& cases_folder) {
  return cases_folder.parent_path() / "incoming";
}

/// The manifest of that name, kept in `folder` with its signature.
core::Result<cases::Case> fetch_manifest(Server& server, const std::string& id,
                                         const fs::path& folder) {
  const std::string path = "/api/v1/cases/" + id;
  auto manifest = TRY(fetch(server, path, kMaxManifest_bytes));
  if (core::sha256(manifest) != id)
    return case_changed(id, "the manifest is not the one of that name");
  auto json = TRY(core::parse_json(core::text_of(manifest), "case.json"));
  auto definition = cases::Case::from_json(json, "case.json: ");
  if (!definition) return definition.error();
  auto signature = TRY(fetch(server, path + "/parts/case.sig", 64u << 10));
  std::error_code failure;
  fs::create_directories(folder, failure);
  for (const auto& entry :
       fs::directory_iterator(folder, failure))  // what a kill left half written
    if (entry.path().extension() == ".part") fs::remove(entry.path(), failure);
  TRY(core::write_file(folder / "case.json", manifest));
  TRY(core::write_file(folder / "case.sig", signature));
  return definition;
}

/// Room for what is still to come, and for the trials to come.
core::Result<void> check_room(const std::string& id, const cases::Case& definition,
                              const fs::path& folder, const SyncLimits& limits) {
  std::uint64_t wanted = limits.reserve_bytes;
  std::error_code ignored;
  for (const cases::Part& part : definition.parts) {
    if (part.secret) continue;
    if (!plain_name(part.name) || part.size_bytes > kMaxPart_bytes)
      return case_changed(id, "a part's name or size is not acceptable");
    const fs::path there = folder / part.name;
    const std::uint64_t here = fs::exists(there, ignored) ? fs::file_size(there, ignored) : 0;
    wanted += part.size_bytes - std::min(here, part.size_bytes);
  }
  const std::uint64_t free =
      limits.free_bytes ? limits.free_bytes() : fs::space(folder, ignored).available;
  if (free >= wanted) return {};
  return core::Error{core::Errc::io,
                     fmt::format("case {}: {} MB are wanted with what trials need, {} MB are free: "
                                 "make room first",
                                 id.substr(0, 12), wanted >> 20, free >> 20)};
}

core::Result<void> fetch_case(Server& server, const std::string& id, const fs::path& cases_folder,
                              const std::vector<std::string>& trusted, const SyncLimits& limits,
                              SyncReport& report) {
  const fs::path folder = incoming_of(cases_folder) / id;
  auto definition = TRY(fetch_manifest(server, id, folder));
  TRY(check_room(id, definition, folder, limits));
  const LocalParts local(cases_folder);
  for (const cases::Part& part : definition.parts) {
    if (part.secret) continue;
    report.bytes_of_cases += part.size_bytes;
    TRY(fetch_part(server, id, part, local, folder / part.name, report.bytes_fetched));
  }
  auto opened = TRY(cases::open_case(folder));
  if (opened.id != id) return case_changed(id, "holds another case");
  if (std::ranges::find(trusted, opened.signer_public_hex) == trusted.end())
    return core::Error{core::Errc::forbidden,
                       fmt::format("case {}: signed by {}, whom this station does not trust",
                                   id.substr(0, 12), opened.signer_public_hex)};
  TRY(core::sync_folder(folder));
  std::error_code failure;
  fs::rename(folder, cases_folder / id, failure);  // whole, in one step
  if (failure)
    return core::Error{core::Errc::io,
                       fmt::format("case {}: {}", id.substr(0, 12), failure.message())};
  return core::sync_folder(cases_folder);
}

bool goes_on_later(core::Errc code) {  // worth going on with later
  return code == core::Errc::unavailable || code == core::Errc::io ||
         code == core::Errc::unauthorised;
}
}  // namespace

core::Json SyncReport::to_json() const {
  return {{"fetched", fetched},
          {"present", present},
          {"refused", refused},
          {"bytes_fetched", bytes_fetched},
          {"bytes_of_cases", bytes_of_cases}};
}

core::Result<SyncReport> sync_cases(Server& server, const fs::path& cases_folder,
                                    const std::vector<std::string>& trusted,
                                    const core::Progress& progress, const SyncLimits& limits) {
  auto ids = TRY(case_ids(server));
  SyncReport report;
  std::error_code ignored;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::string& id = ids[i];
    if (fs::exists(cases_folder / id, ignored)) {
      report.present.push_back(id);
    } else if (auto got = fetch_case(server, id, cases_folder, trusted, limits, report); got) {
      report.fetched.push_back(id);
    } else if (goes_on_later(got.error().code)) {
      return got.error();
    } else {
      fs::remove_all(incoming_of(cases_folder) / id, ignored);
      report.refused.push_back(got.error().what);
    }
    if (progress && !progress(double(i + 1) / double(ids.size())))
      return core::Error{core::Errc::cancelled, "the synchronisation was stopped"};
  }
  return report;
}

}  // namespace uplink
}  // namespace tractus
