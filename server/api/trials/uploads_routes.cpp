/// A station hands over its trials, in pieces, each acknowledged once it is on the disk.
#include <charconv>

#include "core/try.hpp"
#include "db/store/stations/fleet.hpp"
#include "server/api/backend.hpp"
#include "server/api/schema.hpp"
#include "server/api/trials/uploads.hpp"
#include "tracing/tracer.hpp"

namespace tractus {
namespace api {
namespace {

constexpr const char* kUploadPath = "/api/v1/uploads/{trial_id}";

core::Result<http::Response> as_response(const core::Result<wire::UploadState>& state) {
  if (!state) return state.error();
  return json_response(state->to_json());
}

core::Result<http::Response> announce(const Call& call, const tracing::Span&) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  auto announced = TRY(wire::UploadAnnouncement::from_json(json, "body"));
  return as_response(announce_upload(call.backend, call.caller, call.text("trial_id"), announced));
}

core::Result<http::Response> state(const Call& call, const tracing::Span&) {
  return as_response(upload_state(call.backend, call.caller, call.text("trial_id")));
}

core::Result<std::uint32_t> checksum(const std::string& text) {
  std::uint32_t value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (text.size() != 8 || failure != std::errc() || end != text.data() + 8)
    return core::Error{core::Errc::bad_input, "X-Crc32c: 8 hexadecimal characters are expected"};
  return value;
}

core::Result<http::Response> append(const Call& call, const tracing::Span&) {
  auto crc32c = TRY(checksum(call.text("X-Crc32c")));
  auto appended = TRY(append_upload(call.backend, call.caller, call.text("trial_id"),
                                    static_cast<std::uint64_t>(call.integer("offset_bytes")),
                                    crc32c, core::bytes_of(call.request.body)));
  if (appended.taken) return json_response(appended.state.to_json());
  return json_response({{"error", "the server expects another offset: continue from offset_bytes"},
                        {"code", name(core::Errc::conflict)},
                        {"offset_bytes", appended.state.offset_bytes}},
                       409);
}

/// The offset of the station's clock, which a station may send when it commits an upload.
core::Result<std::optional<store::TrialClock>> clock_of(const std::string& body) {
  if (body.empty()) return std::optional<store::TrialClock>();
  auto json = TRY(core::parse_json(body, "body"));
  core::Fields fields(json, "body");
  constexpr double kMost_s = 1e10;
  const store::TrialClock clock{fields.number("clock_offset_s", -kMost_s, kMost_s),
                                fields.number("clock_error_s", 0.0, kMost_s)};
  TRY(fields.done());
  return std::optional(clock);
}

core::Result<http::Response> commit(const Call& call, const tracing::Span& span) {
  auto clock = TRY(clock_of(call.request.body));
  const std::string& id = call.text("trial_id");
  auto state = commit_upload(call.backend, call.caller, id, span.traceparent());
  if (!state || !clock) return as_response(state);
  TRY(call.backend.store.write(
      [&](store::Writing& tx) { return store::add_trial_clock(tx, id, *clock); }));
  return as_response(state);
}

/// A step of an upload as a span, whose parent is the station's request. Only a station that may
/// call the route comes here: nobody else's traceparent is believed.
template <core::Result<http::Response> (*step)(const Call&, const tracing::Span&)>
core::Result<http::Response> traced(const Call& call) {
  const http::Request& request = call.request;
  const std::string path =
      request.path.ends_with("/commit") ? kUploadPath + std::string("/commit") : kUploadPath;
  tracing::Span span(call.backend.tracer, request.method + " " + path, tracing::SpanKind::server,
                     tracing::parse_traceparent(request.header("traceparent")));
  auto answer = step(call, span);
  const int status = answer ? answer->status : status_of(answer.error().code);
  span.set("http.request.method", request.method);
  span.set("http.route", path);
  span.set("http.request.body.size", request.body.size());
  span.set("http.response.status_code", status);
  if (status >= 500) span.set_failed(std::to_string(status));
  return answer;
}

RouteInfo upload_route(std::string method, std::string tail, std::string id, std::string summary) {
  return {.method = std::move(method),
          .path = kUploadPath + tail,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = {Role::station},
          .parameters = {path_text(
              "trial_id", "Id of the trial, 32 hexadecimal characters, chosen by the station")},
          .body = "",
          .answer = "UploadState",
          .schemas = {},
          .handle = nullptr};
}

}  // namespace

std::vector<RouteInfo> uploads_routes() {
  RouteInfo put = upload_route(
      "PUT", "", "announceUpload",
      "Announce the upload of a trial; the same announcement again gives the same upload");
  put.body = "UploadAnnouncement";
  put.body_limit_bytes = 4096;
  put.schemas = {
      {"UploadAnnouncement",
       schema::object(
           {{"case_id",
             schema::text(
                 "Id of the case, or of the slot for an assigned trial or a study's trial")},
            {"size_bytes", schema::integer("B", "Size of the trial file, in bytes")},
            {"sha256", schema::text("SHA-256 of the trial file")}})},
      {"UploadState",
       schema::object({{"offset_bytes",
                        schema::integer("B", "Number of bytes that the server has stored durably")},
                       {"state", schema::one_of<trial::UploadPhase>(
                                     "State of the upload; complete: the trial is stored")}})}};
  put.handle = traced<announce>;

  RouteInfo read = upload_route("GET", "", "uploadState", "Read the state of an upload");
  read.handle = traced<state>;

  RouteInfo patch = upload_route("PATCH", "", "appendUpload",
                                 "Upload the next chunk, at most 4 MiB; answers 409 with "
                                 "offset_bytes if the server expects another offset");
  patch.parameters.push_back({.in = Parameter::In::query,
                              .name = "offset_bytes",
                              .kind = Parameter::Kind::integer,
                              .unit = "B",
                              .meaning = "Offset of the chunk in the trial file, in bytes",
                              .low = 0,
                              .high = double(kMaxTrial_bytes),
                              .fallback = std::nullopt});
  patch.parameters.push_back({.in = Parameter::In::header,
                              .name = "X-Crc32c",
                              .kind = Parameter::Kind::text,
                              .unit = "",
                              .meaning = "CRC-32C of the body, 8 hexadecimal characters",
                              .fallback = std::nullopt});
  patch.body = kBytes;
  patch.body_limit_bytes = wire::kMaxChunk_bytes;
  patch.audited = false;  // announcing and committing are
  patch.handle = traced<append>;

  RouteInfo post = upload_route("POST", "/commit", "commitUpload",
                                "Commit an upload: the server checks the whole file and stores it "
                                "as a trial; a second commit has no effect; the body may be empty");
  post.body = "CommitUpload";
  post.body_limit_bytes = 4096;
  post.schemas = {
      {"CommitUpload",
       schema::object(
           {{"clock_offset_s",
             schema::number("s", "Server's clock minus the station's clock, in seconds")},
            {"clock_error_s",
             schema::number("s", "Bound of the error of clock_offset_s, in seconds")}})}};
  post.handle = traced<commit>;
  return {put, read, patch, post};
}

}  // namespace api
}  // namespace tractus
