/// CT volumes that people bring in: held until somebody has looked at them, then ready for cases.
#include <fmt/format.h>

#include "core/try.hpp"
#include "db/store/volumes/volumes.hpp"
#include "server/api/backend.hpp"
#include "server/api/schema.hpp"
#include "server/api/volumes/volume_intake.hpp"
#include "server/api/volumes/volume_pictures.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;
using store::VolumeState;

constexpr std::size_t kMaxVolumeReason = 1000;

Json volume_json(const store::VolumeRecord& v) {
  Json out{{"id", v.id}, {"name", v.name}, {"source", v.source}, {"state", name(v.state)}};
  const Json facts = core::stored_json(v.facts);
  for (const char* key : {"format", "modality", "dims", "spacing_m", "origin_m", "directions",
                          "range", "notes", "suspicions"})
    out[key] = facts.contains(key) ? facts.at(key) : Json();
  out["size_bytes"] = v.size_bytes;
  out["made_utc_us"] = v.made_utc_us;
  out["made_by"] = v.made_by;
  out["released_by"] = v.state == VolumeState::released ? Json(v.decided_by.value_or("")) : Json();
  out["decided_utc_us"] = v.decided_utc_us ? Json(*v.decided_utc_us) : Json();
  out["reason"] = v.reason;
  return out;
}

Result<store::VolumeRecord> volume_of_call(const Call& call) {
  auto known = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return store::volume_of(tx, call.text("id")); }));
  if (!known) return Error{Errc::not_found, "there is no volume " + call.text("id").substr(0, 64)};
  return *known;
}

/// Opens the voxels of a volume. Administrators, directors and the person who uploaded the volume
/// may see it while it is held; everybody else only sees released volumes.
Result<volume::VolumeFile> pictured(const Call& call) {
  auto v = TRY(volume_of_call(call));
  const bool decides = call.caller.role == Role::admin || call.caller.role == Role::director;
  if (v.state == VolumeState::refused)
    return Error{Errc::conflict, "this volume was refused: its voxels were removed"};
  if (v.state == VolumeState::held && !decides && call.caller.id != v.made_by_id)
    return Error{Errc::forbidden,
                 "this volume is held: a person must look at its pictures and release it first"};
  return volume::VolumeFile::open(TRY(call.backend.objects.file(v.sha256)));
}

Result<http::Response> list_volumes(const Call& call) {
  auto known =
      TRY(call.backend.store.read([](store::Reading& tx) { return store::all_volumes(tx); }));
  Json list = Json::array();
  for (const auto& v : known) list.push_back(volume_json(v));
  return json_response({{"volumes", list}});
}

Result<http::Response> one_volume(const Call& call) {
  auto v = TRY(volume_of_call(call));
  return json_response(volume_json(v));
}

Result<http::Response> add_volume(const Call& call) {
  const auto taken = TRY(take_in(call));
  const auto v = TRY(keep_volume(call.backend, taken,
                                 {.name = call.text("name"),
                                  .source = call.text("source"),
                                  .by = call.caller.name,
                                  .by_id = call.caller.id}));
  return json_response(volume_json(v), 201);
}

Result<http::Response> decided(const Call& call, const store::Decision& decision) {
  std::string to_remove;
  auto done = TRY(call.backend.store.write(
      [&](store::Writing& tx) -> Result<std::optional<store::VolumeRecord>> {
        auto gone = TRY(store::decide_volume(tx, call.text("id"), decision));
        to_remove = gone;
        return store::volume_of(tx, call.text("id"));
      }));
  if (!to_remove.empty()) {
    if (auto removed = call.backend.objects.remove(to_remove); !removed)
      return Error{
          removed.error().code,
          "the volume was refused, but its file cannot be removed: " + removed.error().what};
  }
  return json_response(volume_json(done.value()));
}

Result<http::Response> release_volume(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const Json* looked = fields.member("looked_at");
  if (looked && *looked != Json(true))
    fields.wrong("looked_at",
                 "true is expected, after you looked at the pictures and saw no text and no face");
  TRY(fields.done());
  return decided(call, {VolumeState::released, call.caller.name, "", call.backend.now_utc_us()});
}

Result<http::Response> refuse(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const std::string reason = fields.text("reason", kMaxVolumeReason);
  TRY(fields.done());
  return decided(call, {VolumeState::refused, call.caller.name, reason, call.backend.now_utc_us()});
}

Result<http::Response> report_volume(const Call& call) {
  auto v = TRY(volume_of_call(call));
  return json_response(core::stored_json(v.report));
}

std::string three(const volume::Vec3& v) { return fmt::format("{},{},{}", v.x(), v.y(), v.z()); }

Result<Window> window_of(const Call& call) {
  const Window out{call.number("low"), call.number("high")};
  if (out.low < out.high) return out;
  return Error{Errc::out_of_range, "low: a value smaller than high is expected"};
}

http::Response bytes_response(std::string bytes) {
  http::Response out{.status = 200, .headers = {}, .body = std::move(bytes)};
  out.with("Content-Type", "application/octet-stream")
      .with("Cache-Control", "private, max-age=3600");
  return out;
}

Result<http::Response> slice(const Call& call) {
  const std::string& axis = call.text("axis");
  const Plane plane = axis == "axial"     ? Plane::axial
                      : axis == "coronal" ? Plane::coronal
                                          : Plane::sagittal;
  if (axis != "axial" && axis != "coronal" && axis != "sagittal")
    return Error{Errc::bad_input, "axis: axial, coronal or sagittal is expected"};
  auto window = TRY(window_of(call));
  auto file = TRY(pictured(call));
  const Bounds bounds = bounds_of(file.geometry());
  const int normal = plane == Plane::axial ? 2 : plane == Plane::coronal ? 1 : 0;
  const double at_m =
      call.has("at_m") ? call.number("at_m") : 0.5 * (bounds.low_m[normal] + bounds.high_m[normal]);
  auto picture =
      TRY(slice_picture(file, plane, at_m, static_cast<int>(call.integer("max_side")), window));
  auto response = bytes_response(std::move(picture.pixels));
  response.with("X-Dims", fmt::format("{},{}", picture.dims[0], picture.dims[1]))
      .with("X-Spacing-m", fmt::format("{0},{0}", picture.spacing_m))
      .with("X-Origin-m", three(picture.origin_m))
      .with("X-Directions", three(picture.along_row) + "," + three(picture.along_column));
  return response;
}

Result<http::Response> preview(const Call& call) {
  auto window = TRY(window_of(call));
  auto file = TRY(pictured(call));
  auto block = TRY(whole_preview(file, static_cast<int>(call.integer("max_side")), window));
  const volume::Geometry& g = block.geometry;
  const math::Mat3 rows = g.directions.transpose();  // Eigen stores by column
  auto response = bytes_response(std::move(block.opacity));
  response.with("X-Dims", fmt::format("{},{},{}", g.dims[0], g.dims[1], g.dims[2]))
      .with("X-Spacing-m", three(g.spacing_m))
      .with("X-Origin-m", three(g.origin_m))
      .with("X-Directions", fmt::format("{}", fmt::join(std::span(rows.data(), 9), ",")));
  return response;
}

Parameter text_in_query(std::string name, std::string meaning, bool required = true) {
  return {.in = Parameter::In::query,
          .name = std::move(name),
          .kind = Parameter::Kind::text,
          .unit = "",
          .meaning = std::move(meaning),
          .required = required,
          .fallback = required ? std::nullopt : std::optional<std::string>("")};
}

Parameter value_in_query(std::string name, std::string fallback, std::string meaning) {
  return {.in = Parameter::In::query,
          .name = std::move(name),
          .kind = Parameter::Kind::number,
          .unit = "CT value",
          .meaning = std::move(meaning),
          .low = -1e6,
          .high = 1e6,
          .fallback = std::move(fallback)};
}

Parameter side_in_query(std::string fallback, double most) {
  return {.in = Parameter::In::query,
          .name = "max_side",
          .kind = Parameter::Kind::integer,
          .unit = "1",
          .meaning = "Largest number of pixels or voxels along the longest side",
          .low = 8,
          .high = most,
          .fallback = std::move(fallback)};
}

RouteInfo volumes_route(std::string method, std::string tail, std::string id, std::string summary,
                        std::string answer, Result<http::Response> (*handle)(const Call&)) {
  RouteInfo out{.method = std::move(method),
                .path = "/api/v1/volumes" + tail,
                .id = std::move(id),
                .summary = std::move(summary),
                .who = {Role::admin, Role::director, Role::faculty, Role::researcher},
                .parameters = {},
                .body = "",
                .answer = std::move(answer),
                .schemas = {},
                .handle = handle};
  if (tail.starts_with("/{id}")) out.parameters = {path_text("id", "Id of the volume")};
  return out;
}

std::vector<NamedSchema> schemas() {
  using namespace schema;
  const Json volume = object(
      {{"id", text("Id of the volume, 32 hexadecimal characters")},
       {"name", text("Name of the volume, shown to people")},
       {"source", text("Origin of the volume and its licence")},
       {"state", one_of<VolumeState>(
                     "State of the volume: held = waits for a person's review, released = cases "
                     "can be made from it, refused = its voxels were removed")},
       {"format", text("File format from which the volume was read")},
       {"modality", nullable(text("DICOM modality; null if the file states none"))},
       {"dims", tuple(integer("1", "Number of voxels along one axis"), 3,
                      "Number of voxels along the axes i, j and k")},
       {"spacing_m",
        tuple(number("m", "Distance between neighbouring voxels along one axis, in metres"), 3,
              "Distance between neighbouring voxels along the axes i, j and k, in metres")},
       {"origin_m", tuple(number("m", "One coordinate, in metres"), 3,
                          "Centre of the first voxel in patient coordinates (LPS), in metres")},
       {"directions", tuple(number("1", "One component of a unit vector"), 9,
                            "Row-major 3 × 3 matrix; its columns are the unit vectors of the axes "
                            "i, j and k in patient coordinates (LPS)")},
       {"range", tuple(number("CT value", "One CT value"), 2, "Smallest and largest CT value")},
       {"notes", array(text("One note"), "Assumptions and losses when the file was read")},
       {"suspicions",
        array(text("One suspicion"), "Places where the pixels possibly show text or a face")},
       {"size_bytes", integer("B", "Size of the stored volume, in bytes")},
       {"made_utc_us", integer("us", "Time of the upload, in microseconds since 1970-01-01 UTC")},
       {"made_by", text("Name of the account that uploaded the volume")},
       {"released_by",
        nullable(text(
            "Name of the account that released the volume; null if the volume is not released"))},
       {"decided_utc_us", nullable(integer("us",
                                           "Time of the release or refusal, in microseconds since "
                                           "1970-01-01 UTC; null while the volume is held"))},
       {"reason", text("Reason for the refusal; empty if the volume was not refused")}});
  const Json attribute =
      object({{"tag", text("DICOM tag (gggg,eeee); for private attributes only the group")},
              {"name", text("Name of the attribute in the DICOM dictionary")},
              {"vr", text("Value representation of the attribute, if the file states it")},
              {"profile", text("Action that DICOM PS3.15 Table E.1-1 requires; empty if the table "
                               "does not list the attribute")},
              {"done", text("Action taken: removed, replaced, kept or new identifier")},
              {"count", integer("1", "Number of occurrences in the data sets of the files")},
              {"nested", integer("1", "Number of occurrences within sequences")}});
  return {
      {"Volume", volume},
      {"VolumeList", object({{"volumes", array(ref("Volume"), "CT volumes, newest first")}})},
      {"VolumeRelease",
       object(
           {{"looked_at",
             truth(
                 "Must be true: the caller looked at the pictures and saw no text and no face")}})},
      {"VolumeRefusal",
       object({{"reason", text("Reason for the refusal, at most 1000 characters")}})},
      {"DeidentifiedAttribute", attribute},
      {"VolumeReport",
       object({{"format", optional(text("Format of this report, tractus-deidentification/1"))},
               {"profile", optional(text("De-identification profile that was applied"))},
               {"codes", optional(array(text("One code of DICOM PS3.16 CID 7050"),
                                        "Codes of the profile and its options"))},
               {"files", optional(integer("1", "Number of files that were read"))},
               {"attributes", optional(array(ref("DeidentifiedAttribute"),
                                             "Attributes of the files, without their values"))},
               {"text_in_pixels", optional(text("Action taken against text in the pixels"))},
               {"faces", optional(text("Action taken against faces in the pixels"))}})}};
}

}  // namespace

std::vector<RouteInfo> volumes_routes() {
  RouteInfo list = volumes_route("GET", "", "volumes", "List the CT volumes, newest first",
                                 "VolumeList", list_volumes);
  list.schemas = schemas();
  RouteInfo take =
      volumes_route("POST", "", "addVolume",
                    "Upload a CT volume: a zip of a DICOM series, or a .nii.gz, .nrrd or "
                    ".tvol file; the server de-identifies it and holds it for review. A zip of "
                    "several series is refused with a list of them, unless series_uid chooses one",
                    "Volume", add_volume);
  take.parameters = {text_in_query("name", "Name of the volume; must not contain a patient's name"),
                     text_in_query("source", "Origin of the volume and its licence", false),
                     text_in_query("series_uid",
                                   "Series Instance UID of the DICOM series to read, one of "
                                   "several in the zip",
                                   false)};
  take.body = kBytes;
  take.body_limit_bytes = kMaxVolume_bytes;
  take.body_to_file = true;
  RouteInfo out = volumes_route(
      "POST", "/{id}/release", "releaseVolume",
      "Release a held volume for making cases, after a person has looked at its pictures", "Volume",
      release_volume);
  out.who = {Role::admin, Role::director};
  out.body = "VolumeRelease";
  out.body_limit_bytes = 4096;
  RouteInfo no = volumes_route(
      "POST", "/{id}/refuse", "refuseVolume",
      "Refuse a held volume: the server removes its voxels and keeps its record", "Volume", refuse);
  no.who = {Role::admin, Role::director};
  no.body = "VolumeRefusal";
  no.body_limit_bytes = 8192;
  RouteInfo plane = volumes_route(
      "GET", "/{id}/slice", "volumeSlice",
      "Read one plane of a volume as grey values 0 to 255, one byte per pixel, row by row; "
      "the headers X-Dims, X-Spacing-m, X-Origin-m (first pixel, LPS) and X-Directions "
      "(along a row, along a column) state its position in the patient",
      kBytes, slice);
  plane.parameters.push_back(
      text_in_query("axis", "Orientation of the plane: axial, coronal or sagittal"));
  Parameter at = value_in_query("at_m", "",
                                "Position of the plane along its axis in patient coordinates "
                                "(LPS), in metres; if it is missing, the middle of the volume");
  at.unit = "m";
  at.required = false;
  at.fallback = std::nullopt;
  plane.parameters.push_back(at);
  plane.parameters.push_back(side_in_query("512", 2048));
  RouteInfo block = volumes_route(
      "GET", "/{id}/preview", "volumePreview",
      "Read the whole volume at low resolution as grey values 0 to 255, one byte per voxel "
      "in the order [k][j][i]; the headers X-Dims, X-Spacing-m, X-Origin-m and X-Directions "
      "(row-major) state its position in the patient (LPS)",
      kBytes, preview);
  block.parameters.push_back(side_in_query("128", 256));
  for (RouteInfo* picture : {&plane, &block}) {
    picture->parameters.push_back(value_in_query("low", "-200", "CT value that is shown black"));
    picture->parameters.push_back(value_in_query("high", "1200", "CT value that is shown white"));
  }
  return {
      list,
      take,
      volumes_route("GET", "/{id}", "volume", "Read one volume's record", "Volume", one_volume),
      out,
      no,
      volumes_route("GET", "/{id}/report", "volumeReport",
                    "Read the de-identification report of a volume: what was removed, replaced and "
                    "kept, by attribute",
                    "VolumeReport", report_volume),
      plane,
      block};
}

}  // namespace api
}  // namespace tractus
