#include "server/api/learning/score_call.hpp"

#include <algorithm>
#include <array>

#include "core/bytes.hpp"
#include "core/clock.hpp"
#include "core/try.hpp"
#include "server/api/learning/launch.hpp"
#include "server/api/people/kept_document.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;

constexpr std::int64_t kAssertionAge_s = 300;

core::Result<std::string> assertion_of(const ScoreCall& call) {
  const std::int64_t now_s = call.at_utc_us / 1'000'000;
  return signed_token(call.key, {{"iss", call.platform.client_id},
                                 {"sub", call.platform.client_id},
                                 {"aud", call.platform.token_url},
                                 {"iat", now_s},
                                 {"exp", now_s + kAssertionAge_s},
                                 {"jti", core::new_id()}});
}

core::Result<std::string> access_token(const ScoreCall& call) {
  const auto assertion = TRY(assertion_of(call));
  const auto answer =
      TRY(fetched_json({.url = call.platform.token_url,
                        .form = {{{"grant_type", "client_credentials"},
                                  {"client_assertion_type",
                                   "urn:ietf:params:oauth:client-assertion-type:jwt-bearer"},
                                  {"client_assertion", assertion},
                                  {"scope", kScoreScope}}},
                        .patience = call.patience,
                        .networks = call.networks,
                        .who = "the learning platform, asked for an access token,"}));
  const std::string token = core::text_member(answer, "access_token");
  const bool clean = std::ranges::all_of(token, [](char c) { return c > 32 && c < 127; });
  if (token.empty() || !clean)
    return Error{Errc::unavailable, "the learning platform gave no access token"};
  return token;
}

bool is_final(int status) {
  return std::ranges::count(std::array{400, 404, 409, 410, 422}, status) > 0;
}

}  // namespace

Json score_json(const store::LineItemScore& what, std::int64_t at_utc_us) {
  const store::AssignedScore& score = what.score;
  return {{"userId", what.item.subject},
          {"scoreGiven", score.right},
          {"scoreMaximum", score.planned},
          {"activityProgress", score.is_complete() ? "Completed" : "InProgress"},
          {"gradingProgress", score.is_graded() ? "FullyGraded" : "Pending"},
          {"timestamp", core::utc_text(at_utc_us)}};
}

std::string scores_address(const std::string& line_item) {
  const auto query = std::min(line_item.find('?'), line_item.size());
  return line_item.substr(0, query) + "/scores" + line_item.substr(query);
}

core::Result<void> post_score(const ScoreCall& call) {
  auto token = access_token(call);
  if (!token) return Error{Errc::unavailable, token.error().what};
  const auto answer = fetch({.url = scores_address(call.what.item.url),
                             .body = score_json(call.what, call.at_utc_us).dump(),
                             .headers = {"Content-Type: application/vnd.ims.lis.v1.score+json",
                                         "Authorization: Bearer " + *token},
                             .patience = call.patience,
                             .networks = call.networks,
                             .who = "the learning platform"});
  if (!answer) return Error{Errc::unavailable, answer.error().what};
  if (answer->status >= 200 && answer->status < 300) return {};
  return Error{
      is_final(answer->status) ? Errc::bad_input : Errc::unavailable,
      "the learning platform answered a score with the status " + std::to_string(answer->status)};
}

}  // namespace api
}  // namespace tractus
