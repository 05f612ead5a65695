#include "station/uplink/server.hpp"

#include <fmt/format.h>

namespace tractus {
namespace uplink {
core::Errc error_code_of(int status) {
  switch (status) {
    case 400:
      return core::Errc::bad_input;
    case 401:
      return core::Errc::unauthorised;
    case 403:
      return core::Errc::forbidden;
    case 404:
      return core::Errc::not_found;
    case 409:
      return core::Errc::conflict;
    case 413:
      return core::Errc::too_large;
    default:
      return status >= 500 || status == 429 ? core::Errc::unavailable : core::Errc::bad_input;
  }
}

core::Error error_of(const Request& request, const HttpResponse& answer) {
  std::string why = "no reason given";
  if (const auto json = core::parse_json(core::text_of(answer.body), "answer");
      json && json->is_object())
    if (const auto it = json->find("error"); it != json->end() && it->is_string())
      why = it->get<std::string>().substr(0, 300);
  return {error_code_of(answer.status),
          fmt::format("{} {}: the server answers {}: {}", request.method, request.path,
                      answer.status, why)};
}

core::Result<core::Json> json_of(const Request& request, const HttpResponse& answer) {
  if (answer.status / 100 != 2) return error_of(request, answer);
  return core::parse_json(core::text_of(answer.body),
                          fmt::format("answer to {} {}", request.method, request.path));
}

}  // namespace uplink
}  // namespace tractus
