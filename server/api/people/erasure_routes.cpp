/// People who leave: what erasing or anonymising would do, and doing it.
#include "core/try.hpp"
#include "db/store/people/erasure.hpp"
#include "server/api/backend.hpp"
#include "server/api/people/authentication.hpp"
#include "server/api/people/people_json.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;
using store::ErasureMode;
using store::Fate;

constexpr std::uint64_t kMaxErasure_bytes = 4096;

Json erasure_json(const store::Erasure& erasure) {
  return {{"number", erasure.number},           {"alias", erasure.alias()},
          {"mode", core::name(erasure.mode)},   {"cause", core::name(erasure.cause)},
          {"state", core::name(erasure.state)}, {"begun_utc_us", erasure.begun_utc_us}};
}

/// The tables whose rows are about people, with what becomes of them.
Json tables_json(const store::Departure& departure) {
  Json out = Json::array();
  for (const store::TableDecision& one : store::table_decisions()) {
    const Fate fate = departure.erasure.mode == ErasureMode::erase ? one.erase : one.anonymise;
    if (fate == Fate::none) continue;
    auto rows = departure.rows.contains(one.table) ? departure.rows.at(one.table) : 0;
    if (one.table == "audit") rows = departure.trail_rows;
    if (rows == 0 && fate != Fate::kept) continue;
    out.push_back({{"table", one.table},
                   {"what", one.what},
                   {"fate", core::name(fate)},
                   {"rows", rows},
                   {"reason", one.reason}});
  }
  return out;
}

Json departure_json(const store::Departure& departure, const std::string& person) {
  return {{"name", person},
          {"mode", core::name(departure.erasure.mode)},
          {"alias", departure.erasure.alias()},
          {"tables", tables_json(departure)},
          {"files", departure.files},
          {"file_bytes", departure.file_bytes},
          {"open_uploads", departure.open_uploads}};
}

store::Erasure wish_of(const Call& call, const std::string& account_id, ErasureMode mode) {
  return {.account_id = account_id, .mode = mode, .begun_utc_us = call.backend.now_utc_us()};
}

Result<store::Account> leaving(store::Reading& tx, const Call& call) {
  auto account = TRY(account_of_call(tx, call));
  if (account.role == Role::admin && account.state == store::AccountState::active)
    TRY(check_an_admin_stays(tx, account));
  return account;
}

Result<http::Response> preview(const Call& call) {
  const auto mode = core::from_name<ErasureMode>(call.text("mode"));
  core::require(mode.has_value(), "a declared parameter has one of its words");
  const auto account =
      TRY(call.backend.store.read([&](store::Reading& tx) { return leaving(tx, call); }));
  const auto departure =
      TRY(store::preview_erasure(call.backend.store, wish_of(call, account.id, *mode)));
  return json_response(departure_json(departure, account.name));
}

Result<http::Response> erase(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const auto mode = fields.word<ErasureMode>("mode");
  const std::string typed = fields.text("name", 256);
  TRY(fields.done());
  const auto erasure =
      TRY(call.backend.store.write([&](store::Writing& tx) -> Result<store::Erasure> {
        const auto account = TRY(leaving(tx, call));
        if (typed != account.name)
          return Error{Errc::bad_input,
                       "body: /name: it is not the name of this account; type the name to confirm"};
        const auto departure = TRY(store::begin_erasure(tx, wish_of(call, account.id, mode)));
        return departure.erasure;
      }));
  close_conversations(call.backend, erasure.account_id);
  call.backend.work_waits();
  return json_response(erasure_json(erasure), 202);
}

Result<http::Response> list_erasures(const Call& call) {
  const auto all =
      TRY(call.backend.store.read([](store::Reading& tx) { return store::all_erasures(tx); }));
  Json list = Json::array();
  for (auto one = all.rbegin(); one != all.rend(); ++one) list.push_back(erasure_json(*one));
  return json_response({{"erasures", list}});
}

std::vector<NamedSchema> preview_schemas() {
  using namespace schema;
  return {
      {"ErasedTable",
       object({{"table", text("Name of the table")},
               {"what", text("What its rows are")},
               {"fate", one_of<Fate>("What becomes of the rows that are about the person")},
               {"rows", integer("1", "Number of rows that are removed or changed")},
               {"reason", text("Why rows are changed or kept; empty for rows that are removed")}})},
      {"ErasurePreview",
       object({{"name", text("Name of the account")},
               {"mode", one_of<ErasureMode>("Whether the person's trials are erased or stay")},
               {"alias", text("What stands in place of the name afterwards")},
               {"tables", array(ref("ErasedTable"), "Tables with rows about the person")},
               {"files", integer("1", "Number of recordings that are deleted")},
               {"file_bytes", integer("B", "Their announced size, in bytes")},
               {"open_uploads",
                integer("1", "Number of these recordings that stations are still uploading")}})}};
}

std::vector<NamedSchema> erasure_schemas() {
  using namespace schema;
  return {
      {"ErasureWish",
       object(
           {{"mode", one_of<ErasureMode>("erase: the person's trials too; anonymise: the trials "
                                         "stay, by a pseudonym that nothing links to the person")},
            {"name", text("Name of the account, typed to confirm")}})},
      {"Erasure",
       object(
           {{"number", integer("1", "Number of the erasure, which never changes")},
            {"alias", text("What stands in place of the name")},
            {"mode", one_of<ErasureMode>("Whether the person's trials were erased or stayed")},
            {"cause", one_of<store::ErasureCause>("Why: asked for, by a retention rule, or again "
                                                  "after a backup was restored")},
            {"state", one_of<store::ErasureState>("begun: files and old rows of the audit trail "
                                                  "are still to be done")},
            {"begun_utc_us",
             integer("us", "Time of the erasure, in microseconds since 1970-01-01 UTC")}})}};
}

RouteInfo erasure_route(std::string method, std::string path, std::string id, std::string summary,
                        std::string answer, Result<http::Response> (*handle)(const Call&)) {
  return {.method = std::move(method),
          .path = "/api/v1/" + path,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = {Role::admin},
          .parameters = {},
          .body = "",
          .answer = std::move(answer),
          .schemas = {},
          .handle = handle};
}

}  // namespace

std::vector<RouteInfo> erasure_routes() {
  RouteInfo look =
      erasure_route("GET", "accounts/{id}/erasure", "previewErasure",
                    "Show what erasing or anonymising a person would remove, change and "
                    "keep; changes nothing",
                    "ErasurePreview", preview);
  look.object = Object::account;
  look.parameters = {path_text("id", "Id of the account"),
                     {.in = Parameter::In::query,
                      .name = "mode",
                      .kind = Parameter::Kind::text,
                      .unit = "",
                      .meaning = "Whether the person's trials would be erased or stay",
                      .required = false,
                      .fallback = "erase",
                      .values = core::names<ErasureMode>()}};
  look.schemas = preview_schemas();
  RouteInfo act = erasure_route("POST", "accounts/{id}/erasure", "eraseAccount",
                                "Erase or anonymise a person; this ends the person's sessions and "
                                "badge at once and cannot be undone",
                                "Erasure", erase);
  act.object = Object::account;
  act.parameters = {path_text("id", "Id of the account")};
  act.body = "ErasureWish";
  act.body_limit_bytes = kMaxErasure_bytes;
  act.schemas = erasure_schemas();
  RouteInfo list =
      erasure_route("GET", "erasures", "erasures", "List the erasures, newest first, without names",
                    "Erasures", list_erasures);
  list.who.push_back(Role::director);
  list.schemas = {
      {"Erasures", schema::object({{"erasures", schema::array(schema::ref("Erasure"),
                                                              "Erasures, newest first")}})}};
  return {look, act, list};
}

}  // namespace api
}  // namespace tractus
