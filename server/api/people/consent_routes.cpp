/// What people agree that research may have of their trials.
#include "core/try.hpp"
#include "db/store/people/consent.hpp"
#include "db/store/studies/assignments.hpp"
#include "server/api/backend.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;
using store::Tier;

constexpr std::uint64_t kMaxConsent_bytes = 4096;
constexpr std::size_t kMaxBasis = 500;

Result<Json> own_answer(store::Reading& tx, const std::string& account) {
  const auto book = TRY(store::ConsentBook::read(tx));
  auto assigned = TRY(store::assignments_of(tx, {.done_by = account}));
  Json studies = Json::array();
  for (const auto& a : assigned)
    studies.push_back({{"study", a.study.id},
                       {"title", a.study.title},
                       {"tier", store::name(book.tier_of(account, a.study.id))}});
  return Json{{"everywhere", store::name(book.tier_of(account, ""))}, {"studies", studies}};
}

Result<http::Response> own_consent(const Call& call) {
  auto answer = TRY(
      call.backend.store.read([&](store::Reading& tx) { return own_answer(tx, call.caller.id); }));
  return json_response(answer);
}

Result<http::Response> say_own(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  store::Consent said{.account_id = call.caller.id,
                      .study_id = fields.text_or("study", "", 64),
                      .participant = "",
                      .tier = fields.word<Tier>("tier"),
                      .basis = "own word",
                      .noted_utc_us = call.backend.now_utc_us(),
                      .noted_by = call.caller.name};
  TRY(fields.done());
  auto answer = TRY(call.backend.store.write([&](store::Writing& tx) -> Result<Json> {
    TRY(store::set_consent(tx, said));
    return own_answer(tx, call.caller.id);
  }));
  return json_response(answer);
}

Result<http::Response> list_consents(const Call& call) {
  using Names = std::map<std::string, std::string>;
  Names names;
  auto all =
      TRY(call.backend.store.read([&](store::Reading& tx) -> Result<std::vector<store::Consent>> {
        auto accounts = TRY(store::all_accounts(tx));
        for (const auto& account : accounts) names[account.id] = account.name;
        return store::all_consents(tx);
      }));
  Json list = Json::array();
  for (const auto& c : all)
    list.push_back({{"account", c.account_id.empty() ? Json() : Json(names[c.account_id])},
                    {"study", c.study_id.empty() ? Json() : Json(c.study_id)},
                    {"participant", c.participant.empty() ? Json() : Json(c.participant)},
                    {"tier", store::name(c.tier)},
                    {"basis", c.basis},
                    {"noted_utc_us", c.noted_utc_us},
                    {"noted_by", c.noted_by}});
  return json_response({{"consents", list}});
}

/// Finds the person that the body names: an account, or a participant without an account.
Result<void> resolve(store::Reading& tx, const std::string& account, store::Consent& said) {
  if (!account.empty()) {
    auto known = TRY(store::account_named(tx, account));
    if (!known) return Error{Errc::not_found, "account: there is no account with this name"};
    said.account_id = known->id;
    return {};
  }
  auto study = TRY(store::find_study(tx, said.study_id));
  auto participant = TRY(store::participant_of(tx, study, said.participant));
  if (!participant)
    return Error{Errc::not_found, "participant: the study has no participant with this name"};
  return {};
}

Result<http::Response> note_consent(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const std::string account = fields.text_or("account", "", 128);
  store::Consent said{.account_id = "",
                      .study_id = fields.text_or("study", "", 64),
                      .participant = fields.text_or("participant", "", 128),
                      .tier = fields.word<Tier>("tier"),
                      .basis = fields.text("basis", kMaxBasis),
                      .noted_utc_us = call.backend.now_utc_us(),
                      .noted_by = call.caller.name};
  if (account.empty() == said.participant.empty())
    fields.wrong("participant", "either a participant of a study or an account is expected");
  TRY(fields.done());
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    TRY(resolve(tx, account, said));
    return store::set_consent(tx, said);
  }));
  return http::Response{.status = 204, .headers = {}, .body = std::string()};
}

RouteInfo consent_route(std::string method, std::string path, std::string id, std::string summary,
                        std::vector<Grant> who, Result<http::Response> (*handle)(const Call&)) {
  return {.method = std::move(method),
          .path = "/api/v1/" + path,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = std::move(who),
          .parameters = {},
          .body = "",
          .answer = "",
          .schemas = {},
          .handle = handle};
}

}  // namespace

std::vector<RouteInfo> consent_routes() {
  using namespace schema;
  const Json tier = one_of<Tier>(
      "Consent tier, the most data that research may use: none = nothing, summary = counts, "
      "metrics = scores, reduced = samples at 100 Hz, full = every sample");
  RouteInfo own = consent_route("GET", "session/consent", "ownConsent",
                                "Show which data of the caller's trials research may use", people(),
                                own_consent);
  own.answer = "OwnConsent";
  own.schemas = {
      {"OwnConsent",
       object({{"everywhere", tier},
               {"studies", array(object({{"study", text("Id of an assignment of the caller")},
                                         {"title", text("Title of the assignment")},
                                         {"tier", tier}}),
                                 "Consent tier that applies in each assignment of the caller")}})}};
  RouteInfo say =
      consent_route("POST", "session/consent", "sayConsent",
                    "Set or withdraw (tier none) the caller's consent for one study or for all "
                    "studies; a consent for all studies replaces those for single studies, and "
                    "it applies to exports immediately",
                    people(), say_own);
  say.ends = {{"/study", Object::assignment, {}}};
  for (const Grant& grant : people()) say.ends.front().who.push_back({grant.role, Scope::own});
  say.body = "ConsentWord";
  say.body_limit_bytes = kMaxConsent_bytes;
  say.answer = "OwnConsent";
  say.schemas = {{"ConsentWord",
                  object({{"study", optional(text("Id of the study or assignment; if it is "
                                                  "missing, the consent applies to all studies"))},
                          {"tier", tier}})}};
  RouteInfo list = consent_route("GET", "consents", "consents", "List all recorded consents",
                                 {Role::admin}, list_consents);
  list.answer = "ConsentList";
  list.schemas = {
      {"ConsentList",
       object(
           {{"consents",
             array(
                 object(
                     {{"account",
                       nullable(
                           text("Name of the account; null for a participant without an account"))},
                      {"study",
                       nullable(
                           text("Id of the study; null if the consent applies to all studies"))},
                      {"participant",
                       nullable(text(
                           "Pseudonym of a participant without an account; null for an account"))},
                      {"tier", tier},
                      {"basis",
                       text("Evidence of the consent: \"own word\" if the person gave it on the "
                            "website, else the place where the signed form is kept")},
                      {"noted_utc_us", integer("us",
                                               "Time when the consent was recorded, in "
                                               "microseconds since 1970-01-01 UTC")},
                      {"noted_by", text("Name of the account that recorded the consent")}}),
                 "All recorded consents, sorted by account, then by study")}})}};
  RouteInfo note =
      consent_route("POST", "consents", "noteConsent",
                    "Record a signed consent form of a study participant without an account "
                    "or, for administrators only, of an account",
                    {Role::admin, Role::researcher}, note_consent);
  note.ends = {{"/account", Object::account, {Role::admin}, End::By::account_name},
               {"/study", Object::study, note.who}};
  note.body = "ConsentForm";
  note.body_limit_bytes = kMaxConsent_bytes;
  note.schemas = {
      {"ConsentForm",
       object({{"account",
                optional(text("Name of the account; give either an account or a participant"))},
               {"study", optional(text("Id of the study; required for a participant"))},
               {"participant",
                optional(text("Pseudonym of a participant of the study who has no account"))},
               {"tier", tier},
               {"basis", text("Place where the signed form is kept, at most 500 characters")}})}};
  return {own, say, list, note};
}

}  // namespace api
}  // namespace tractus
