/// Series that a PACS or a scanner's workstation sends by itself (STOW-RS, PS3.18 section 10.5).
#include <fmt/format.h>

#include <array>
#include <ctime>
#include <fstream>

#include "core/file.hpp"
#include "core/try.hpp"
#include "server/api/backend.hpp"
#include "server/api/schema.hpp"
#include "server/api/volumes/series_files.hpp"
#include "server/api/volumes/volume_intake.hpp"
#include "server/jobs/dicom_references.hpp"

namespace tractus {
namespace api {
namespace {

namespace fs = std::filesystem;
using core::Errc;
using core::Error;
using core::Json;
using core::Result;

Result<void> split_body(const Call& call, const fs::path& body, const fs::path& into) {
  auto files = TRY(SeriesFiles::make(call.request.header("content-type"), into, "the sender",
                                     {.bytes = kMaxVolume_bytes}));
  std::ifstream stream(body, std::ios::binary);
  std::string piece(1 << 16, '\0');
  while (stream.read(piece.data(), std::streamsize(piece.size())), stream.gcount() > 0)
    TRY(files->take(std::string_view(piece.data(), std::size_t(stream.gcount()))));
  return files->finish();
}

/// A sender states no name: the time, by which the person who reviews it finds it.
std::string name_of_received(std::int64_t utc_us) {
  const std::time_t seconds = utc_us / 1'000'000;
  std::tm parts{};
  ::gmtime_r(&seconds, &parts);
  std::array<char, 64> out{};
  const std::size_t size =
      std::strftime(out.data(), out.size(), "received %Y-%m-%d %H:%M:%S UTC", &parts);
  return {out.data(), size};
}

/// The standard's answer, without an address: the instances cannot be had from here.
Json stored_json_of(const std::vector<jobs::InstanceReference>& instances) {
  Json list = Json::array();
  for (const auto& [class_uid, instance_uid] : instances)
    list.push_back({{"00081150", {{"vr", "UI"}, {"Value", {class_uid}}}},
                    {"00081155", {{"vr", "UI"}, {"Value", {instance_uid}}}}});
  return {{"00081199", {{"vr", "SQ"}, {"Value", list}}}};
}

Result<http::Response> store_series(const Call& call) {
  const auto scratch = TRY(core::ScratchFolder::make(call.backend.scratch->folder() / "volume"));
  const auto body = TRY(body_in(call, scratch.path(), "upload"));
  const fs::path series = scratch.path() / "series";
  std::error_code failure;
  if (!fs::create_directory(series, failure))
    return Error{Errc::io, "a folder for the series cannot be made: " + failure.message()};
  TRY(split_body(call, body, series));
  const auto instances = TRY(jobs::instances_in(series));
  const auto taken = TRY(take_in_series(call.backend, series, scratch.path(), Turn::now));
  TRY(keep_volume(call.backend, taken,
                  {.name = name_of_received(call.backend.now_utc_us()),
                   .source = "sent by STOW-RS",
                   .by = call.caller.name,
                   .by_id = call.caller.id}));
  http::Response response{.status = 200, .headers = {}, .body = stored_json_of(instances).dump()};
  response.with("Content-Type", "application/dicom+json").with("Cache-Control", "no-store");
  return response;
}

}  // namespace

std::vector<RouteInfo> stow_routes() {
  using namespace schema;
  const auto uid = [](const char* meaning) {
    return object({{"vr", text("UI")}, {"Value", array(text(meaning), "One identifier")}});
  };
  const Json instance = object({{"00081150", uid("Referenced SOP Class UID")},
                                {"00081155", uid("Referenced SOP Instance UID")}});
  return {{.method = "POST",
           .path = "/api/v1/dicom-web/studies",
           .id = "storeSeries",
           .summary =
               "Store one series by DICOMweb (STOW-RS): a body multipart/related of parts "
               "application/dicom, the whole series in one request; the server de-identifies it "
               "as an uploaded one and holds it for review",
           .who = {Role::admin, Role::director, Role::faculty, Role::researcher},  // as of volumes
           .parameters = {},
           .body = kBytes,
           .body_limit_bytes = kMaxVolume_bytes,
           .body_to_file = true,
           .answer = "StoredSeries",
           .schemas = {{"StoredSeries",
                        object({{"00081199", object({{"vr", text("SQ")},
                                                     {"Value", array(instance,
                                                                     "Instances that were "
                                                                     "stored")}})}})}},
           .handle = store_series}};
}

}  // namespace api
}  // namespace tractus
