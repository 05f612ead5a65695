#include "station/uplink/sync.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "cases/case.hpp"
#include "core/file.hpp"

namespace uplink {
namespace fs = std::filesystem;
namespace {
constexpr std::uint64_t kMaxManifest_bytes = 1u << 20;
constexpr std::uint64_t kMaxPart_bytes = 4ull << 30;
constexpr std::uint64_t kPiece_bytes = 4u << 20;
constexpr std::size_t kMaxCases = 10'000;

core::Result<core::Bytes> fetch(Server& server, const std::string& path, std::uint64_t limit) {
  const Request request{.method = "GET", .path = path, .max_answer_bytes = limit};
  auto answer = server.send(request);
  if (!answer) return answer.error();
  if (answer->status != 200) return error_of(request, *answer);
  return std::move(answer->body);
}

core::Result<std::vector<std::string>> case_ids(Server& server) {
  const Request request{.method = "GET", .path = "/api/v1/cases", .max_answer_bytes = 16u << 20};
  auto answer = server.send(request);
  if (!answer) return answer.error();
  auto json = json_of(request, *answer);
  if (!json) return json.error();
  const core::Error odd{core::Errc::bad_input, "the server's list of cases is not what was agreed"};
  if (!json->is_object() || !json->contains("cases") || !(*json)["cases"].is_array()) return odd;
  std::vector<std::string> out;
  for (const auto& one : (*json)["cases"]) {
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

core::Error changed(const std::string& id, const std::string& what) {
  return {core::Errc::corrupt, fmt::format("case {}: {}", id.substr(0, 12), what)};
}

/// In pieces by Range, so that the memory stays small.
core::Result<void> fetch_part(Server& server, const std::string& id, const cases::Part& part,
                              const fs::path& target) {
  std::ofstream file(target, std::ios::binary);
  core::Sha256 hash;
  for (std::uint64_t at = 0; at < part.size_bytes;) {
    const std::uint64_t size = std::min(kPiece_bytes, part.size_bytes - at);
    const Request request{.method = "GET",
                          .path = fmt::format("/api/v1/cases/{}/parts/{}", id, part.name),
                          .headers = {{"Range", fmt::format("bytes={}-{}", at, at + size - 1)}},
                          .max_answer_bytes = size};
    auto answer = server.send(request);
    if (!answer) return answer.error();
    if (answer->status != 206 && !(answer->status == 200 && size == part.size_bytes))
      return answer->status / 100 == 2 ? changed(id, part.name + ": the server ignores ranges")
                                       : error_of(request, *answer);
    if (answer->body.size() != size) return changed(id, part.name + ": a piece has the wrong size");
    file.write(reinterpret_cast<const char*>(answer->body.data()),
               static_cast<std::streamsize>(size));
    hash.add(answer->body);
    at += size;
  }
  file.close();
  if (!file) return core::Error{core::Errc::io, fmt::format("{}: cannot write", target.string())};
  if (hash.hex() != part.sha256) return changed(id, part.name + ": is not what the manifest names");
  return {};
}

core::Result<void> fetch_case(Server& server, const std::string& id, const fs::path& cases_folder,
                              const std::vector<std::string>& trusted) {
  const std::string path = "/api/v1/cases/" + id;
  auto manifest = fetch(server, path, kMaxManifest_bytes);
  if (!manifest) return manifest.error();
  if (core::sha256(*manifest) != id) return changed(id, "the manifest is not the one of that name");
  auto json = core::parse_json(core::text_of(*manifest), "case.json");
  if (!json) return json.error();
  auto definition = cases::Case::from_json(*json, "case.json: ");
  if (!definition) return definition.error();
  auto signature = fetch(server, path + "/parts/case.sig", 64u << 10);
  if (!signature) return signature.error();

  auto scratch = core::ScratchFolder::make(cases_folder / id);
  if (!scratch) return scratch.error();
  if (auto written = core::write_file(scratch->path() / "case.json", *manifest); !written)
    return written;
  if (auto written = core::write_file(scratch->path() / "case.sig", *signature); !written)
    return written;
  for (const cases::Part& part : definition->parts) {
    if (part.secret) continue;
    if (!plain_name(part.name) || part.size_bytes > kMaxPart_bytes)
      return changed(id, "a part's name or size is not acceptable");
    if (auto got = fetch_part(server, id, part, scratch->path() / part.name); !got) return got;
  }
  auto opened = cases::open_case(scratch->path());
  if (!opened) return opened.error();
  if (opened->id != id) return changed(id, "holds another case");
  if (std::ranges::find(trusted, opened->signer_public_hex) == trusted.end())
    return core::Error{core::Errc::forbidden,
                       fmt::format("case {}: signed by {}, whom this station does not trust",
                                   id.substr(0, 12), opened->signer_public_hex)};
  return scratch->keep_as(cases_folder / id);
}
}  // namespace

core::Json SyncReport::to_json() const {
  return {{"fetched", fetched}, {"present", present}, {"refused", refused}};
}

core::Result<SyncReport> sync_cases(Server& server, const fs::path& cases_folder,
                                    const std::vector<std::string>& trusted,
                                    const core::Progress& progress) {
  auto ids = case_ids(server);
  if (!ids) return ids.error();
  SyncReport report;
  std::error_code ignored;
  for (std::size_t i = 0; i < ids->size(); ++i) {
    const std::string& id = (*ids)[i];
    if (fs::exists(cases_folder / id, ignored)) {
      report.present.push_back(id);
    } else if (auto got = fetch_case(server, id, cases_folder, trusted); got) {
      report.fetched.push_back(id);
    } else if (got.error().code == core::Errc::unavailable || got.error().code == core::Errc::io ||
               got.error().code == core::Errc::unauthorised) {
      return got.error();
    } else {
      report.refused.push_back(got.error().what);
    }
    if (progress && !progress(double(i + 1) / double(ids->size())))
      return core::Error{core::Errc::cancelled, "the synchronisation was stopped"};
  }
  return report;
}

}  // namespace uplink
