#include "server/api/route.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/file.hpp"

namespace tractus::api {

std::vector<Grant> people() {
  std::vector<Grant> out(kRoles.begin(), kRoles.end());
  std::erase_if(out, [](const Grant& grant) { return grant.role == Role::station; });
  return out;
}

Parameter path_text(std::string name, std::string meaning) {
  return {.in = Parameter::In::path,
          .name = std::move(name),
          .kind = Parameter::Kind::text,
          .unit = "",
          .meaning = std::move(meaning),
          .fallback = std::nullopt};
}

const std::string& Call::text(const std::string& name) const {
  const auto found = arguments.find(name);
  core::require(found != arguments.end(), "a handler asks for arguments its route declares");
  return found->second;
}

std::int64_t Call::integer(const std::string& name) const {
  const std::string& given = text(name);
  std::int64_t value = 0;
  std::from_chars(given.data(), given.data() + given.size(), value);
  return value;
}

double Call::number(const std::string& name) const {
  const std::string& given = text(name);
  double value = 0.0;
  std::from_chars(given.data(), given.data() + given.size(), value);
  return value;
}

const std::vector<RouteInfo>& routes() {
  static const std::vector<RouteInfo> flat = [] {
    std::vector<RouteInfo> out;
    for (auto& file : all())
      for (auto& route : file) out.push_back(std::move(route));
    return out;
  }();
  return flat;
}

RouteInfo research_route(std::string method, std::string path, std::string id, std::string summary,
                         std::string answer, core::Result<http::Response> (*handle)(const Call&)) {
  RouteInfo out{.method = std::move(method),
                .path = "/api/v1/" + path,
                .id = std::move(id),
                .summary = std::move(summary),
                .who = {Role::admin, Role::researcher},
                .parameters = {},
                .body = "",
                .answer = std::move(answer),
                .schemas = {},
                .handle = handle};
  if (out.path.find("{id}") != std::string::npos)
    out.parameters.push_back(path_text("id", "Id of the object, 32 hexadecimal characters"));
  return out;
}

RouteInfo taking(RouteInfo out, std::string body, std::uint64_t limit_bytes,
                 std::vector<NamedSchema> schemas) {
  out.body = std::move(body);
  out.body_limit_bytes = limit_bytes;
  out.schemas = std::move(schemas);
  return out;
}

http::Response as_report(http::Response response) {
  response.with("Content-Security-Policy",
                "default-src 'none'; style-src 'unsafe-inline'; img-src data:; sandbox");
  return response;
}

http::Response redirection(const std::string& address, int status) {
  http::Response out{.status = status, .headers = {}, .body = std::string()};
  return out.with("Location", address).with("Cache-Control", "no-store"), out;
}

http::Response json_response(const core::Json& json, int status) {
  http::Response response{.status = status,
                          .headers = {},
                          .body = json.dump(-1, ' ', false, core::Json::error_handler_t::replace)};
  response.with("Content-Type", "application/json").with("Cache-Control", "no-store");
  return response;
}

core::Result<std::filesystem::path> body_in(const Call& call, const std::filesystem::path& folder,
                                            const std::string& name) {
  const std::filesystem::path path = folder / name;
  if (call.request.body_file.empty()) {
    auto written = core::write_file(path, core::bytes_of(call.request.body));
    return written ? core::Result<std::filesystem::path>(path) : written.error();
  }
  std::error_code failure;
  std::filesystem::create_hard_link(call.request.body_file, path, failure);
  if (!failure) return path;
  return core::Error{core::Errc::io, path.string() + ": cannot be made: " + failure.message()};
}

core::Result<http::Response> scratch_response(std::shared_ptr<http::ScratchFile> file,
                                              const char* content_type, const char* download_name) {
  std::error_code failure;
  const std::uint64_t size = std::filesystem::file_size(file->path, failure);
  if (failure) return core::Error{core::Errc::io, file->path.string() + ": " + failure.message()};
  file->share.shrink_to(size);
  http::Response response{
      .status = 200, .headers = {}, .body = http::FileSlice{file->path, 0, size, std::move(file)}};
  response.with("Content-Type", content_type)
      .with("Content-Disposition", std::string("attachment; filename=\"") + download_name + "\"")
      .with("Cache-Control", "no-store");
  return response;
}

core::Result<http::Response> wants_websocket(const Call&) {
  auto response = http::error_response(426, "bad_input",
                                       "this address is a WebSocket: send an upgrade request");
  response.with("Upgrade", "websocket").with("Connection", "upgrade");
  return response;
}

int status_of(core::Errc code) {
  switch (code) {
    case core::Errc::bad_input:
    case core::Errc::out_of_range:
    case core::Errc::corrupt:
      return 400;
    case core::Errc::unauthorised:
      return 401;
    case core::Errc::forbidden:
      return 403;
    case core::Errc::not_found:
      return 404;
    case core::Errc::conflict:
      return 409;
    case core::Errc::too_large:
      return 413;
    case core::Errc::unavailable:
    case core::Errc::cancelled:
      return 503;
    case core::Errc::io:
      return 500;
  }
  return 500;
}

http::Response error_response(const core::Error& error) {
  return http::error_response(status_of(error.code), name(error.code), error.what);
}

core::Error absent(const char* what, const std::string& id) {
  return {core::Errc::not_found, fmt::format("no {} {} here", what, id.substr(0, 64))};
}

}  // namespace tractus::api
