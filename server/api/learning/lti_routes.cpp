/// Launches by learning platforms (1EdTech LTI 1.3 Core and Security Framework 1.0, section 5.1): this
/// server is the tool. Whom a platform vouches for gets no account and no role by that.
#include <algorithm>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/learning/line_items.hpp"
#include "db/store/operations/audit.hpp"
#include "db/store/people/subjects.hpp"
#include "db/store/studies/assignments.hpp"
#include "server/api/backend.hpp"
#include "server/api/learning/launch.hpp"
#include "server/api/learning/tool.hpp"
#include "server/api/learning/tool_key.hpp"
#include "server/api/people/authentication.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr const char* kBrowserCookie = "tractus_lti";
constexpr std::int64_t kLaunch_us = 10ll * 60 * 1'000'000;
constexpr std::uint64_t kMaxLogin_bytes = 8192, kMaxLaunch_bytes = 64 * 1024;

/// Why a launch was refused, as the pages' address says it: /?sign_in=WORD.
enum class LaunchRefusal {
  launch_failed,      ///< anything that the person cannot mend
  launch_window,      ///< the browser sent no cookie: blocked within a frame of another site
  launch_unknown,     ///< no account is linked with the person
  launch_here,        ///< the account signs in here: an administrator, or with one-time codes
  launch_assignment,  ///< the link names an assignment that does not exist
};
constexpr auto words(LaunchRefusal) {
  using enum LaunchRefusal;
  return std::to_array<core::Word<LaunchRefusal>>({{launch_failed, "launch_failed"},
                                                   {launch_window, "launch_window"},
                                                   {launch_unknown, "launch_unknown"},
                                                   {launch_here, "launch_here"},
                                                   {launch_assignment, "launch_assignment"}});
}

http::Response refused_launch(const Call& call, LaunchRefusal why, const std::string& what) {
  if (call.backend.log) call.backend.log({{"what", "lti"}, {"refused", what}});
  return redirection("/?sign_in=" + std::string(core::name(why)), 303);
}

using Form = std::map<std::string, std::string>;
Result<Form> form_in(const Call& call) {
  if (call.request.method == "GET") return call.request.query;
  http::RequestHead head;
  TRY(http::read_target("/?" + call.request.body, head));
  return head.query;
}
std::string field_of(const Form& form, const std::string& key) {
  const auto found = form.find(key);
  return found == form.end() ? std::string() : found->second;
}

/// SameSite=None, because the platform's form comes from another site; the cookie is only good for
/// telling that the launch comes to the browser in which it began.
std::string browser_cookie(const std::string& value) {
  return std::string(kBrowserCookie) + "=" + value +
         "; Path=/api/v1/lti; HttpOnly; SameSite=None; Secure; Max-Age=" +
         std::to_string(kLaunch_us / 1'000'000);
}

/// The platform that begins a launch.
Result<store::Platform> platform_in(const Call& call, const Form& form) {
  const std::string issuer = field_of(form, "iss"), client = field_of(form, "client_id");
  auto all =
      TRY(call.backend.store.read([](store::Reading& tx) { return store::all_platforms(tx); }));
  std::erase_if(all, [&](const store::Platform& one) {
    return one.issuer != issuer || (!client.empty() && one.client_id != client);
  });
  if (all.size() == 1) return all.front();
  return Error{Errc::unauthorised, all.empty()
                                       ? "no platform with this issuer and client is registered"
                                       : "the issuer has several clients: client_id is needed"};
}

/// One launch, from its beginning to the platform's answer, encrypted in `state`.
struct LaunchAttempt {
  std::string nonce, platform_id, browser_hash;
};

std::string state_of(const Call& call, const LaunchAttempt& attempt) {
  return call.backend.secrets.sealed(Json{
      {"lti", 1},
      {"nonce", attempt.nonce},
      {"platform", attempt.platform_id},
      {"browser", attempt.browser_hash},
      {"until_utc_us", call.backend.now_utc_us() +
                           kLaunch_us}}.dump());
}

Result<LaunchAttempt> opened_state(const Call& call, const std::string& state) {
  const Error none{Errc::unauthorised, "the launch did not begin here, or began too long ago"};
  const auto opened = call.backend.secrets.opened(state);
  if (!opened) return none;
  const Json json = core::stored_json(*opened);
  if (!json.is_object() || !json.contains("lti") ||
      call.backend.now_utc_us() > json.value("until_utc_us", std::int64_t{0}))
    return none;
  return LaunchAttempt{json.value("nonce", ""), json.value("platform", ""),
                       json.value("browser", "")};
}

/// The value by which this browser is known again: a launch beside another one keeps it.
std::string browser_of(const Call& call) {
  const std::string held(call.request.cookie(kBrowserCookie));
  const bool good =
      held.size() == 64 && held.find_first_not_of("0123456789abcdef") == std::string::npos;
  return good ? held : new_token();
}

/// Sends the browser to the platform, which then posts the launch.
Result<http::Response> begin_launch(const Call& call) {
  const auto form = form_in(call);
  if (!form) return refused_launch(call, LaunchRefusal::launch_failed, form.error().what);
  const auto platform = platform_in(call, *form);
  if (!platform) return refused_launch(call, LaunchRefusal::launch_failed, platform.error().what);
  const std::string browser = browser_of(call);
  const std::string nonce = core::base64url(core::random_bytes(32));
  std::vector<std::pair<std::string, std::string>> asked{
      {"scope", "openid"},
      {"response_type", "id_token"},
      {"response_mode", "form_post"},
      {"prompt", "none"},
      {"client_id", platform->client_id},
      {"redirect_uri", tool_addresses(call.backend).launch},
      {"login_hint", field_of(*form, "login_hint")},
      {"state", state_of(call, {nonce, platform->id, token_hash(browser)})},
      {"nonce", nonce}};
  if (form->contains("lti_message_hint"))
    asked.emplace_back("lti_message_hint", field_of(*form, "lti_message_hint"));
  auto out = redirection(with_query(platform->authorization_url, asked), 303);
  return out.with("Set-Cookie", browser_cookie(browser)), out;
}

/// A launch whose token was checked.
struct CheckedLaunch {
  store::Platform platform;
  std::string nonce;
  Launch launch;
};

Result<CheckedLaunch> checked_launch(const Call& call, const LaunchAttempt& attempt,
                                     const std::string& token) {
  const auto platform = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return store::platform_of(tx, attempt.platform_id); }));
  if (!platform) return Error{Errc::unauthorised, "the platform is not registered any more"};
  const Expected expected{platform->issuer, platform->client_id, attempt.nonce,
                          call.backend.now_utc_us() / 1'000'000};
  const auto claims = TRY(call.backend.platform_keys.claims(*platform, token, expected,
                                                            outside_networks(call.backend)));
  auto launch = TRY(launch_in(claims, *platform));
  return CheckedLaunch{*platform, attempt.nonce, std::move(launch)};
}

/// The account that the person is linked with; a verified e-mail address makes the link, if the
/// platform's registration allows that and a trainee has the address.
Result<std::optional<store::Account>> linked_account(store::Writing& tx, const CheckedLaunch& of,
                                                     std::int64_t now_utc_us) {
  auto found = TRY(store::account_of_subject(tx, of.platform.issuer, of.launch.subject));
  if (found || !of.platform.match_email || of.launch.email.empty()) return found;
  const auto id = TRY(store::trainee_with_address(tx, of.launch.email));
  if (id.empty()) return std::optional<store::Account>();
  const auto before = TRY(store::subject_of(tx, of.platform.issuer, id));
  if (!before.empty()) return std::optional<store::Account>();  // linked with somebody else
  TRY(store::link_subject(
      tx, {of.platform.issuer, of.launch.subject, id, now_utc_us, "verified e-mail address"}));
  return store::account_of(tx, id);
}

Result<void> keep_line_item(store::Writing& tx, const Call& call, const CheckedLaunch& of,
                            const store::AssignmentId& assignment, const store::Account& account) {
  if (!is_callable(of.launch.line_item, outside_networks(call.backend))) return {};
  const auto participant = TRY(store::participant_for(tx, assignment, account.id));
  if (participant.empty()) return {};
  return store::set_line_item(tx, {.platform_id = of.platform.id,
                                   .study_id = assignment.text(),
                                   .account_id = account.id,
                                   .subject = of.launch.subject,
                                   .url = of.launch.line_item});
}

/// The assignment that the launch opens; none if it names none. Errors: bad_input if there is none of
/// this id.
Result<std::optional<store::AssignmentId>> launched_assignment(store::Reading& tx,
                                                               const CheckedLaunch& of) {
  if (of.launch.assignment.empty()) return std::optional<store::AssignmentId>();
  const auto found = store::find_assignment(tx, of.launch.assignment);
  if (found) return std::optional(*found);
  if (found.error().code != Errc::not_found) return found.error();
  return Error{Errc::bad_input, "the launch names an assignment that does not exist"};
}

/// A new session's token. Errors: not_found, forbidden, bad_input as refusal_of reads them;
/// unauthorised for a launch that was used before.
Result<std::string> opened_launch(store::Writing& tx, const Call& call, const CheckedLaunch& of) {
  const std::int64_t now = call.backend.now_utc_us();
  TRY(store::use_nonce(tx, of.nonce, now + kLaunch_us, now));
  const auto account = TRY(linked_account(tx, of, now));
  if (!account || account->state != store::AccountState::active)
    return Error{Errc::not_found, "no account is linked with this person"};
  if (account->role == Role::admin || account->role == Role::station || account->totp_confirmed)
    return Error{Errc::forbidden, "this account is not opened by a launch"};
  const auto assignment = TRY(launched_assignment(tx, of));
  if (assignment) TRY(keep_line_item(tx, call, of, *assignment, *account));
  store::AuditScope::is_by(account->name, name(account->role));
  const std::string token = new_token();
  TRY(store::add_session(tx, token_hash(token), account->id, now));
  return token;
}

Result<std::string> session_of_launch(const Call& call, const CheckedLaunch& of) {
  const store::AuditScope acting(
      {.peer = call.request.peer,
       .what = "ltiLaunch",
       .detail = Json{{"issuer", of.platform.issuer},
                      {"subject", of.launch.subject},
                      {"assignment", of.launch.assignment}}
                     .dump(-1, ' ', false, Json::error_handler_t::replace),
       .at_utc_us = call.backend.now_utc_us()});
  return call.backend.store.write([&](store::Writing& tx) { return opened_launch(tx, call, of); });
}

LaunchRefusal refusal_of(const Error& error) {
  switch (error.code) {
    case Errc::not_found:
      return LaunchRefusal::launch_unknown;
    case Errc::forbidden:
      return LaunchRefusal::launch_here;
    case Errc::bad_input:
      return LaunchRefusal::launch_assignment;
    default:
      return LaunchRefusal::launch_failed;
  }
}

/// The platform's form. The browser is sent on to a page in any case: a page loads without the
/// session's cookie, which a browser does not send on a way that began at another site.
Result<http::Response> take_launch(const Call& call) {
  using enum LaunchRefusal;
  const auto form = form_in(call);
  if (!form) return refused_launch(call, launch_failed, form.error().what);
  const auto attempt = opened_state(call, field_of(*form, "state"));
  if (!attempt) return refused_launch(call, launch_failed, attempt.error().what);
  const std::string_view browser = call.request.cookie(kBrowserCookie);
  if (browser.empty()) return refused_launch(call, launch_window, "the browser sent no cookie");
  if (token_hash(browser) != attempt->browser_hash)
    return refused_launch(call, launch_failed, "another browser began this launch");
  const auto checked = checked_launch(call, *attempt, field_of(*form, "id_token"));
  if (!checked) return refused_launch(call, launch_failed, checked.error().what);
  const auto token = session_of_launch(call, *checked);
  if (!token) {
    const LaunchRefusal why = refusal_of(token.error());
    if (why == launch_unknown)
      note_stranger(call.backend, call.request.peer, "ltiLaunch",
                    {{"why", token.error().what},
                     {"issuer", checked->platform.issuer},
                     {"subject", checked->launch.subject}});
    return refused_launch(call, why, token.error().what);
  }
  const std::string& assignment = checked->launch.assignment;
  auto out =
      redirection(assignment.empty() ? "/" : "/assignments/" + percent_encoded(assignment), 303);
  return out.with("Set-Cookie", session_cookie(call.backend, *token)), out;
}

Result<http::Response> show_keys(const Call& call) {
  const auto key = TRY(tool_key(call.backend));
  return json_response({{"keys", {key.jwk}}});
}

Parameter stated(std::string name, std::string meaning) {
  return {.in = Parameter::In::query,
          .name = std::move(name),
          .kind = Parameter::Kind::text,
          .unit = "",
          .meaning = std::move(meaning),
          .required = false,
          .fallback = std::nullopt};
}

RouteInfo lti_route(std::string method, std::string tail, std::string id, std::string summary,
                    http::Lane lane, Result<http::Response> (*handle)(const Call&)) {
  const bool form = method == "POST";
  return {.method = std::move(method),
          .path = "/api/v1/lti" + tail,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = {},
          .open = true,
          .takes_foreign_form = form,
          .audited = false,  // the handler notes what happened itself
          .lane = lane,
          .parameters = {},
          .body = form ? kForm : "",
          .answer = kBytes,
          .schemas = {},
          .handle = handle};
}

}  // namespace

std::vector<RouteInfo> lti_routes() {
  using namespace schema;
  RouteInfo begin = lti_route("GET", "/login", "ltiLogin",
                              "Begin a launch: redirect the browser to the learning platform",
                              http::Lane::quick, begin_launch);
  begin.parameters = {
      stated("iss", "Issuer of the platform"),
      stated("login_hint", "What the platform wants back unchanged: the person"),
      stated("target_link_uri", "Address that is launched; the server does not use it"),
      stated("lti_message_hint", "What the platform wants back unchanged: the message"),
      stated("client_id", "Client id of this server at the platform"),
      stated("lti_deployment_id", "Id of the deployment; the server reads it in the launch"),
      stated("lti_storage_target", "Frame for the platform's storage; the server does not use it"),
      stated("canvas_region", "Region of Canvas; the server does not use it"),
      stated("canvas_environment", "Environment of Canvas; the server does not use it")};
  RouteInfo posted =
      lti_route("POST", "/login", "ltiLoginForm", "Begin a launch by a form with the same fields",
                http::Lane::quick, begin_launch);
  posted.body_limit_bytes = kMaxLogin_bytes;
  RouteInfo launch =
      lti_route("POST", "/launch", "ltiLaunch",
                "Take the launch of a learning platform: a form with id_token and state; start a "
                "session and redirect the browser to the page",
                http::Lane::remote, take_launch);
  launch.body_limit_bytes = kMaxLaunch_bytes;
  RouteInfo keys = lti_route("GET", "/keys", "ltiKeys",
                             "Show the public keys by which platforms check this server's requests",
                             http::Lane::quick, show_keys);
  keys.answer = "JsonWebKeys";
  keys.schemas = {
      {"JsonWebKeys", object({{"keys", array(object({{"kty", text("Kind of key: RSA")},
                                                     {"use", text("What the key is for: sig")},
                                                     {"alg", text("Algorithm: RS256")},
                                                     {"kid", text("Name of the key")},
                                                     {"n", text("Modulus, base64url")},
                                                     {"e", text("Exponent, base64url")}}),
                                             "JSON Web Keys (RFC 7517)")}})}};
  return {begin, posted, launch, keys};
}

}  // namespace api
}  // namespace tractus
