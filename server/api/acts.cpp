#include "server/api/acts.hpp"

#include <algorithm>
#include <array>

#include "server/api/backend.hpp"

namespace api {
namespace {

constexpr std::size_t kMaxDetail_bytes = 4096;
constexpr std::array<std::string_view, 9> kSecret{
    "password", "old", "new", "pin", "code", "token", "token_sha256", "secret", "seed"};

void redact(core::Json& json) {
  if (json.is_object())
    for (const std::string_view field : kSecret)
      if (json.contains(std::string(field))) json[std::string(field)] = "(not kept)";
  if (json.is_structured())
    for (auto& inner : json) redact(inner);
}

core::Json detail_of(const http::Request& request) {
  if (request.body.empty()) return core::Json::object();
  if (request.body.size() <= kMaxDetail_bytes) {
    core::Json json = core::Json::parse(request.body, nullptr, false);
    if (json.is_object()) return redact(json), json;
  }
  return {{"size_bytes", request.body.size()},
          {"sha256", core::sha256(core::bytes_of(request.body))}};
}

}  // namespace

std::string object_text(const std::map<std::string, std::string>& segments) {
  std::string out;
  for (const auto& [key, value] : segments)
    out += (out.empty() ? "" : " ") + key + "=" + value.substr(0, 128);
  return out;
}

store::Act act_of(const RouteInfo& route, const Call& call,
                  const std::map<std::string, std::string>& segments) {
  return {
      .who = call.caller.name,
      .role = route.open ? "" : std::string(name(call.caller.role)),
      .peer = call.request.peer,
      .what = route.id,
      .object = object_text(segments),
      .detail = detail_of(call.request).dump(-1, ' ', false, core::Json::error_handler_t::replace),
      .at_utc_us = call.backend.now_utc_us()};
}

}  // namespace api
