/// Volumes from the hospital's PACS: find a study, choose a series, import it as an uploaded one.
///
/// What names a patient or a study stands in bodies, never in an address: addresses are logged.
#include "core/try.hpp"
#include "server/api/schema.hpp"
#include "server/api/volumes/pacs_imports.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::uint64_t kMaxPacsBody_bytes = 8192;

Result<PacsImports*> pacs_of(const Call& call) {
  if (call.backend.pacs) return call.backend.pacs;
  return Error{Errc::conflict, "no PACS is stated: start the server with --pacs FILE"};
}

Result<http::Response> show_pacs(const Call& call) {
  const PacsImports* pacs = call.backend.pacs;
  return json_response({{"address", pacs ? Json(pacs->settings().base) : Json()}});
}

Json study_json(const PacsStudy& study) {
  return {{"uid", study.uid},
          {"date", core::or_null(study.date)},
          {"description", study.description},
          {"modalities", study.modalities},
          {"series", core::or_null(study.series)},
          {"files", core::or_null(study.files)}};
}

Result<http::Response> find_pacs_studies(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const StudySearch search = study_search_from(fields);
  TRY(fields.done());
  const PacsImports* pacs = TRY(pacs_of(call));
  // Whoever looks into the PACS is in the audit trail, which a write notes.
  TRY(call.backend.store.write([](store::Writing&) { return Result<void>(); }));
  const auto found = TRY(find_studies(pacs->settings(), search));
  Json list = Json::array();
  for (const PacsStudy& study : found) list.push_back(study_json(study));
  return json_response({{"studies", list}, {"more", found.size() >= kStudiesOfPage}});
}

std::string uid_field(core::Fields& fields, const char* key) {
  const std::string uid = fields.text(key, 64);
  if (!is_uid(uid)) fields.wrong(key, "digits and dots are expected");
  return uid;
}

Json series_json(const PacsSeries& series) {
  return {{"uid", series.uid},
          {"number", core::or_null(series.number)},
          {"modality", series.modality},
          {"description", series.description},
          {"files", core::or_null(series.files)},
          {"row_spacing_m", core::or_null(series.row_spacing_m)},
          {"column_spacing_m", core::or_null(series.column_spacing_m)},
          {"thickness_m", core::or_null(series.thickness_m)},
          {"slice_spacing_m", core::or_null(series.slice_spacing_m)}};
}

Result<http::Response> list_pacs_series(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const std::string study = uid_field(fields, "study_uid");
  TRY(fields.done());
  const PacsImports* pacs = TRY(pacs_of(call));
  const auto found = TRY(series_of(pacs->settings(), study));
  Json list = Json::array();
  for (const PacsSeries& series : found) list.push_back(series_json(series));
  return json_response({{"series", list}});
}

Json import_json(const store::PacsImport& import) {
  return {{"id", import.id},       {"state", name(import.state)},
          {"files", import.files}, {"size_bytes", import.size_bytes},
          {"error", import.error}, {"volume", core::or_null(import.volume_id)}};
}

Result<http::Response> import_pacs_series(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  PacsImportWish wish{.study_uid = uid_field(fields, "study_uid"),
                      .series_uid = uid_field(fields, "series_uid"),
                      .volume = {.name = fields.text("name", 200),
                                 .source = fields.text_or("source", "", 1000),
                                 .by = call.caller.name,
                                 .by_id = call.caller.id},
                      .act = {.who = call.caller.name,
                              .role = std::string(name(call.caller.role)),
                              .peer = call.request.peer,
                              .what = "addVolume"}};
  if (wish.volume.name.find_first_not_of(" \t\r\n") == std::string::npos)
    fields.wrong("name", "a name is expected");
  TRY(fields.done());
  PacsImports* pacs = TRY(pacs_of(call));
  const auto import = TRY(pacs->start(std::move(wish)));
  return json_response(import_json(import), 202);
}

Result<http::Response> show_pacs_import(const Call& call) {
  const std::string& id = call.text("id");
  const auto found = TRY(call.backend.store.read([&](store::Reading& tx) {
    return store::pacs_import_of(tx, call.caller.id, id, call.backend.now_utc_us());
  }));
  if (!found) return absent("import from the PACS", id);
  return json_response(import_json(*found));
}

RouteInfo pacs_route(std::string method, std::string tail, std::string id, std::string summary,
                     std::string answer, Result<http::Response> (*handle)(const Call&)) {
  return {.method = std::move(method),
          .path = "/api/v1/pacs" + tail,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = {Role::admin, Role::director, Role::faculty, Role::researcher},  // as of volumes
          .parameters = {},
          .body = "",
          .answer = std::move(answer),
          .schemas = {},
          .handle = handle};
}

RouteInfo studies_route() {
  using namespace schema;
  const std::string day = ", as 2024-03-14";
  RouteInfo out = taking(
      pacs_route("POST", "/studies", "findPacsStudies",
                 "Find studies in the PACS, a page at a time; every search is written into the "
                 "audit trail, without what was searched for",
                 "PacsStudies", find_pacs_studies),
      "PacsSearch", kMaxPacsBody_bytes,
      {{"PacsSearch",
        object({{"patient_id", optional(text("Id of the patient; whole, without wildcards"))},
                {"from", optional(text("First day of the study" + day))},
                {"to", optional(text("Last day of the study" + day))},
                {"description", optional(text("A part of the study's description"))},
                {"offset", optional(integer("1", "Number of studies to pass over"))}})},
       {"PacsStudies",
        object({{"studies",
                 array(object({{"uid", text("Study Instance UID")},
                               {"date", nullable(text("Day of the study" + day))},
                               {"description", text("Description of the study; may be empty")},
                               {"modalities", array(text("DICOM modality"), "Modalities in it")},
                               {"series", nullable(integer("1", "Number of series"))},
                               {"files", nullable(integer("1", "Number of files"))}}),
                       "Studies, without whose they are")},
                {"more", truth("True: there may be more studies after these")}})}});
  out.lane = http::Lane::remote;
  return out;
}

RouteInfo series_route() {
  using namespace schema;
  RouteInfo out = taking(
      pacs_route("POST", "/series", "pacsSeries", "List the series of a study in the PACS",
                 "PacsSeriesList", list_pacs_series),
      "PacsStudyWish", kMaxPacsBody_bytes,
      {{"PacsStudyWish", object({{"study_uid", text("Study Instance UID")}})},
       {"PacsSeriesList",
        object(
            {{"series",
              array(
                  object({{"uid", text("Series Instance UID")},
                          {"number", nullable(integer("1", "Number of the series"))},
                          {"modality", text("DICOM modality; may be empty")},
                          {"description", text("Description of the series; may be empty")},
                          {"files", nullable(integer("1", "Number of files, mostly one a slice"))},
                          {"row_spacing_m",
                           nullable(number("m", "Distance between rows of pixels, in metres"))},
                          {"column_spacing_m",
                           nullable(number("m", "Distance between columns of pixels, in metres"))},
                          {"thickness_m", nullable(number("m", "Thickness of a slice, in metres"))},
                          {"slice_spacing_m",
                           nullable(number("m", "Distance between slices, in metres"))}}),
                  "Series; a number is null where the PACS does not say it")}})}});
  out.lane = http::Lane::remote;
  out.audited = false;  // it changes nothing
  return out;
}

}  // namespace

std::vector<RouteInfo> pacs_routes() {
  using namespace schema;
  RouteInfo show = pacs_route("GET", "", "pacs", "Show from which PACS volumes can be imported",
                              "Pacs", show_pacs);
  show.schemas = {
      {"Pacs", object({{"address", nullable(text("Address of its DICOMweb service; null if the "
                                                 "server was started without one"))}})}};
  RouteInfo import = taking(
      pacs_route("POST", "/imports", "importPacsSeries",
                 "Import a series from the PACS: the server fetches it, de-identifies it as an "
                 "uploaded one and holds it for review; answers at once",
                 "PacsImport", import_pacs_series),
      "PacsImportWish", kMaxPacsBody_bytes,
      {{"PacsImportWish",
        object({{"study_uid", text("Study Instance UID")},
                {"series_uid", text("Series Instance UID")},
                {"name", text("Name of the volume; must not contain a patient's name")},
                {"source", optional(text("Origin of the volume and its licence"))}})},
       {"PacsImport",
        object({{"id", text("Id of the import, 32 hexadecimal characters")},
                {"state", one_of<store::PacsImportState>(
                              "State of the import: fetching = files come from the PACS, reading = "
                              "the server de-identifies them, done, failed")},
                {"files", integer("1", "Number of files that have come")},
                {"size_bytes", integer("B", "Bytes that have come")},
                {"error", text("Reason for the failure; empty if it has not failed")},
                {"volume", nullable(text("Id of the volume; null until the import is done"))}})}});
  RouteInfo one =
      pacs_route("GET", "/imports/{id}", "pacsImport",
                 "Show how far an import from the PACS is that the caller began; it is kept for a "
                 "day",
                 "PacsImport", show_pacs_import);
  one.parameters = {path_text("id", "Id of the import")};
  return {show, studies_route(), series_route(), import, one};
}

}  // namespace api
}  // namespace tractus
