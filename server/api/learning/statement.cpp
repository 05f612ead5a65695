#include "server/api/learning/statement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/try.hpp"
#include "server/api/web_fetch.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;

/// The id as a UUID of version 4 (RFC 4122), which xAPI wants.
std::string statement_id(std::string id) {
  id.resize(32, '0');
  id[12] = '4';
  id[16] = '8';
  return fmt::format("{}-{}-{}-{}-{}", id.substr(0, 8), id.substr(8, 4), id.substr(12, 4),
                     id.substr(16, 4), id.substr(20));
}

std::string verb_of(const std::optional<bool>& correct) {
  if (!correct) return "completed";
  return *correct ? "passed" : "failed";
}

Json result_of(const store::ReleasedTrial& trial) {
  // ISO 8601, to a hundredth of a second: xAPI 1.0.3 part 2, section 4.6.
  Json out{{"completion", true}, {"duration", fmt::format("PT{:.2f}S", trial.duration_s)}};
  if (!trial.correct) return out;
  const int score = *trial.correct ? 1 : 0;
  out["success"] = *trial.correct;
  out["score"] = {{"scaled", score}, {"raw", score}, {"min", 0}, {"max", 1}};
  return out;
}

}  // namespace

Json statement_json(const StatedTrial& what) {
  const std::string verb = verb_of(what.trial.correct);
  return {{"id", statement_id(what.id)},
          {"actor",
           {{"objectType", "Agent"},
            {"account", {{"homePage", what.base + "/"}, {"name", what.trial.participant}}}}},
          {"verb", {{"id", "http://adlnet.gov/expapi/verbs/" + verb}, {"display", {{"en", verb}}}}},
          {"object",
           {{"objectType", "Activity"},
            {"id", what.base + "/assignments/" + what.assignment_id},
            {"definition",
             {{"type", "http://adlnet.gov/expapi/activities/assessment"},
              {"name", {{"en", what.title}}}}}}},
          {"result", result_of(what.trial)},
          {"context", {{"platform", "Tractus"}}},
          {"timestamp", what.trial.date + "T00:00:00Z"}};
}

core::Result<std::optional<store::ReleasedTrial>> released_trial(
    store::Reading& tx, const store::StatementTrial& which,
    const std::optional<std::array<std::byte, 32>>& pseudonym_key) {
  const auto names = TRY(store::Pseudonyms::of(pseudonym_key));
  const auto released =
      TRY(store::ReleasedTrials::read(tx, pseudonym_key, {.study = which.study_id}));
  const auto found =
      std::ranges::find(released.all(), names.trial(which.trial_id), &store::ReleasedTrial::id);
  return found == released.all().end() ? std::optional<store::ReleasedTrial>()
                                       : std::optional(*found);
}

core::Result<void> post_statement(const StatementCall& call) {
  const auto answer =
      fetch({.url = call.to.endpoint + "/statements",
             .body = call.statement.dump(-1, ' ', false, Json::error_handler_t::replace),
             .headers = {"Content-Type: application/json", "X-Experience-API-Version: 1.0.3"},
             .user = call.to.key,
             .password = call.to.secret,
             .patience = call.patience,
             .networks = call.networks,
             .who = "the learning record store"});
  if (!answer) return Error{Errc::unavailable, answer.error().what};
  if (answer->status >= 200 && answer->status < 300) return {};
  const bool final = std::ranges::count(std::array{400, 409, 413}, answer->status) > 0;
  return Error{final ? Errc::bad_input : Errc::unavailable,
               fmt::format("the learning record store answered a statement with the status {}",
                           answer->status)};
}

}  // namespace api
}  // namespace tractus
