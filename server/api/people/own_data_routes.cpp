/// A person's own data as a download: for the person, and by an administrator for a person who asks for it.
#include "core/try.hpp"
#include "db/store/operations/audit.hpp"
#include "server/api/people/own_data.hpp"
#include "server/api/people/people_json.hpp"

namespace tractus {
namespace api {
namespace {

using core::Result;

/// Every download is written into the audit trail.
Result<http::Response> download(const Call& call, const char* what, const store::Account& person) {
  auto zip = TRY(own_data_zip(call.backend, call.caller.id, person, call.integer("part")));
  const store::AuditedAction act{.who = call.caller.name,
                                 .role = std::string(name(call.caller.role)),
                                 .peer = call.request.peer,
                                 .what = what,
                                 .object = "id=" + person.id,
                                 .at_utc_us = call.backend.now_utc_us()};
  TRY(call.backend.store.write(
      [&](store::Writing& tx) { return store::add_act(tx, call.backend.store.audit_key(), act); }));
  return scratch_response(std::move(zip), "application/zip", "my-data.zip");
}

Result<http::Response> own_data(const Call& call) {
  const auto person = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return store::account_of(tx, call.caller.id); }));
  core::require(person.has_value(), "who is signed in has an account");
  return download(call, "ownData", *person);
}

Result<http::Response> data_of_account(const Call& call) {
  const auto person =
      TRY(call.backend.store.read([&](store::Reading& tx) { return account_of_call(tx, call); }));
  return download(call, "dataOfAccount", person);
}

}  // namespace

std::vector<RouteInfo> own_data_routes() {
  const Parameter part{.in = Parameter::In::query,
                       .name = "part",
                       .kind = Parameter::Kind::integer,
                       .unit = "1",
                       .meaning =
                           "Part of the download, from 1; the README.txt in the first part "
                           "says how many there are, each with at most 1 GiB of recordings",
                       .required = false,
                       .low = 1,
                       .high = 1'000'000,
                       .fallback = "1"};
  RouteInfo own{.method = "GET",
                .path = "/api/v1/session/data",
                .id = "ownData",
                .summary =
                    "Download the caller's own data as a zip: account, consents, assignments, "
                    "trials whose results are released, certificates, sign-ins; every "
                    "download is written into the audit trail",
                .who = people(),
                .parameters = {part},
                .body = "",
                .answer = kBytes,
                .schemas = {},
                .handle = own_data};
  RouteInfo other = own;
  other.path = "/api/v1/accounts/{id}/data";
  other.id = "dataOfAccount";
  other.summary =
      "Download the data of a person who asks for them: what the person could download, "
      "and no more; every download is written into the audit trail";
  other.who = {Role::admin};
  other.object = Object::account;
  other.parameters = {path_text("id", "Id of the account"), part};
  other.handle = data_of_account;
  return {own, other};
}

}  // namespace api
}  // namespace tractus
