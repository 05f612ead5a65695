/// A station hands over its trials, in pieces, each acknowledged once it is on the disk.
#include "server/api/uploads.hpp"

#include <charconv>

#include "server/api/schema.hpp"

namespace api {
namespace {

core::Result<http::Response> as_response(const core::Result<wire::UploadState>& state) {
  if (!state) return state.error();
  return json_response(state->to_json());
}

core::Result<http::Response> announce(const Call& call) {
  auto json = core::parse_json(call.request.body, "body");
  if (!json) return json.error();
  auto announced = wire::UploadAnnouncement::from_json(*json, "body");
  if (!announced) return announced.error();
  return as_response(announce_upload(call.backend, call.caller, call.text("trial_id"), *announced));
}

core::Result<http::Response> state(const Call& call) {
  return as_response(upload_state(call.backend, call.caller, call.text("trial_id")));
}

core::Result<std::uint32_t> checksum(const std::string& text) {
  std::uint32_t value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (text.size() != 8 || failure != std::errc() || end != text.data() + 8)
    return core::Error{core::Errc::bad_input, "X-Crc32c: 8 hexadecimal characters are expected"};
  return value;
}

core::Result<http::Response> append(const Call& call) {
  auto crc32c = checksum(call.text("X-Crc32c"));
  if (!crc32c) return crc32c.error();
  auto appended = append_upload(call.backend, call.caller, call.text("trial_id"),
                                static_cast<std::uint64_t>(call.integer("offset_bytes")), *crc32c,
                                core::bytes_of(call.request.body));
  if (!appended) return appended.error();
  if (appended->taken) return json_response(appended->state.to_json());
  return json_response({{"error", "the upload stands elsewhere: go on from offset_bytes"},
                        {"code", name(core::Errc::conflict)},
                        {"offset_bytes", appended->state.offset_bytes}},
                       409);
}

core::Result<http::Response> commit(const Call& call) {
  return as_response(commit_upload(call.backend, call.caller, call.text("trial_id")));
}

RouteInfo upload_route(std::string method, std::string tail, std::string id, std::string summary) {
  return {.method = std::move(method),
          .path = "/api/v1/uploads/{trial_id}" + tail,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = {Role::station},
          .parameters = {path_text("trial_id", "32 hexadecimal characters, the station's choice")},
          .body = "",
          .answer = "UploadState",
          .schemas = {},
          .handle = nullptr};
}

}  // namespace

std::vector<RouteInfo> uploads_routes() {
  RouteInfo put = upload_route("PUT", "", "announceUpload",
                               "Announce a trial; the same announcement again is the same upload");
  put.body = "UploadAnnouncement";
  put.body_limit_bytes = 4096;
  put.schemas = {
      {"UploadAnnouncement", schema::object({{"case_id", schema::text("SHA-256 of case.json")},
                                             {"size_bytes", schema::integer("B", "of the file")},
                                             {"sha256", schema::text("of the file")}})},
      {"UploadState",
       schema::object({{"offset_bytes", schema::integer("B", "on the server's disk")},
                       {"state", schema::one_of({"receiving", "complete"}, "")}})}};
  put.handle = announce;

  RouteInfo read = upload_route("GET", "", "uploadState", "Where an upload stands");
  read.handle = state;

  RouteInfo patch = upload_route(
      "PATCH", "", "appendUpload",
      "The next piece, at most 4 MiB; 409 with offset_bytes when the upload stands elsewhere");
  patch.parameters.push_back({.in = Parameter::In::query,
                              .name = "offset_bytes",
                              .kind = Parameter::Kind::integer,
                              .unit = "B",
                              .meaning = "where the piece begins",
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
  patch.handle = append;

  RouteInfo post = upload_route("POST", "/commit", "commitUpload",
                                "Check all of it and make it a trial; repeating it is harmless");
  post.handle = commit;
  return {put, read, patch, post};
}

}  // namespace api
