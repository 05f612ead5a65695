/// The language in which the caller reads pages, kiosks and e-mails.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/try.hpp"
#include "db/store/people/accounts.hpp"
#include "server/api/backend.hpp"
#include "server/api/operations/messages.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

constexpr std::uint64_t kMaxLanguage_bytes = 1024;

core::Result<http::Response> set_own_language(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const std::string language = fields.text("language", 16);
  if (std::ranges::count(languages(), language) == 0)
    fields.wrong("language", fmt::format("one of {} is expected", fmt::join(languages(), ", ")));
  TRY(fields.done());
  TRY(call.backend.store.write(
      [&](store::Writing& tx) { return store::set_language(tx, call.caller.id, language); }));
  return http::Response{.status = 204, .headers = {}, .body = std::string()};
}

}  // namespace

std::vector<RouteInfo> language_routes() {
  return {{.method = "POST",
           .path = "/api/v1/session/language",
           .id = "setLanguage",
           .summary = "Choose the language of the caller's pages, kiosks and e-mails",
           .who = people(),
           .before_password_change = true,
           .parameters = {},
           .body = "LanguageChoice",
           .body_limit_bytes = kMaxLanguage_bytes,
           .answer = "",
           .schemas = {{"LanguageChoice",
                        schema::object({{"language", schema::one_of(languages(), "Language")}})}},
           .handle = set_own_language}};
}

}  // namespace api
}  // namespace tractus
