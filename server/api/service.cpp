#include "server/api/service.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "core/clock.hpp"
#include "core/try.hpp"
#include "core/words.hpp"
#include "server/api/access.hpp"
#include "server/api/audit_entry.hpp"
#include "server/api/people/authentication.hpp"
#include "server/api/people/throttle.hpp"
#include "server/api/people/token_scopes.hpp"
#include "tracing/tracer.hpp"

namespace tractus {
namespace api {
namespace {

constexpr std::string_view kKeepOut =
    "a request with a session cookie that changes data needs the header X-Tractus: 1";

std::vector<std::string_view> segments_of(std::string_view path) {
  std::vector<std::string_view> out;
  while (!path.empty()) {
    path.remove_prefix(1);
    const auto end = std::min(path.find('/'), path.size());
    out.push_back(path.substr(0, end));
    path.remove_prefix(end);
  }
  return out;
}

bool is_placeholder(std::string_view segment) { return segment.starts_with('{'); }

/// Do the fixed segments agree?
bool fits(const std::vector<std::string_view>& pattern, const std::vector<std::string_view>& path) {
  return std::ranges::equal(pattern, path, [](std::string_view want, std::string_view is) {
    return is_placeholder(want) ? !is.empty() : want == is;
  });
}

core::Result<Match> bound(const RouteInfo& route, const std::vector<std::string_view>& pattern,
                          const std::vector<std::string_view>& path) {
  Match out{&route, {}};
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (!is_placeholder(pattern[i])) continue;
    auto value = TRY(http::percent_decoded(path[i]));
    out.segments.emplace(pattern[i].substr(1, pattern[i].size() - 2), std::move(value));
  }
  return out;
}

template <class Number>
bool is_number_within(std::string_view text, double low, double high) {
  Number value{};
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  return failure == std::errc() && end == text.data() + text.size() &&
         static_cast<double>(value) >= low && static_cast<double>(value) <= high;
}

core::Result<void> check(const Parameter& p, const std::string& value) {
  if (p.kind == Parameter::Kind::text) {
    if (p.values.empty() || std::ranges::count(p.values, value) > 0) return {};
    return core::Error{core::Errc::bad_input,
                       fmt::format("{}: {} is expected, not '{}'", p.name,
                                   fmt::join(p.values, ", "), core::one_line(value.substr(0, 64)))};
  }
  const bool whole = p.kind == Parameter::Kind::integer;
  if (whole ? is_number_within<std::int64_t>(value, p.low, p.high)
            : is_number_within<double>(value, p.low, p.high))
    return {};
  return core::Error{
      core::Errc::out_of_range,
      fmt::format("{}: {} from {} to {} is expected, not '{}'", p.name,
                  whole ? "a whole number" : "a number", p.low, p.high, value.substr(0, 64))};
}

std::optional<std::string> given(const Parameter& p, const Match& matched,
                                 const http::RequestHead& head) {
  if (p.in == Parameter::In::path) return matched.segments.at(p.name);
  if (p.in == Parameter::In::query) {
    const auto found = head.query.find(p.name);
    return found == head.query.end() ? std::nullopt : std::optional(found->second);
  }
  std::string lower = p.name;
  std::ranges::transform(lower, lower.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  const std::string_view value = head.header(lower);
  return value.empty() ? std::nullopt : std::optional(std::string(value));
}

core::Result<void> check_query_is_declared(const RouteInfo& route, const http::RequestHead& head) {
  std::vector<std::string> known;
  for (const Parameter& p : route.parameters)
    if (p.in == Parameter::In::query) known.push_back(p.name);
  for (const auto& [key, _] : head.query)
    if (std::ranges::count(known, key) == 0)
      return core::Error{
          core::Errc::bad_input,
          fmt::format("{}: this parameter is unknown; {}", core::one_line(key.substr(0, 64)),
                      known.empty() ? "this address takes none"
                                    : fmt::format("allowed: {}", fmt::join(known, ", ")))};
  return {};
}

/// A page of another site can make a browser send its cookie, but not this header.
core::Result<void> check_not_forged(const RouteInfo& route, const Caller& caller,
                                    const http::RequestHead& head) {
  if (route.method == "GET" || route.takes_foreign_form || !head.header("x-tractus").empty())
    return {};
  const bool signing_in = route.open && head.header("content-type").starts_with("application/json");
  if (signing_in || (!route.open && caller.session_hash.empty())) return {};
  return core::Error{core::Errc::forbidden, std::string(kKeepOut)};
}

/// What was asked of whom: for the notes.
struct Asked {
  const core::Result<Match>& matched;
  std::string_view allowed;
  std::optional<Caller> caller = std::nullopt;
  bool overstepped = false;  ///< asked for what is not theirs
};

/// Errors: forbidden if the call comes by an API token without a scope of the route.
core::Result<void> check_scope(const RouteInfo& route, const Caller& caller) {
  if (!caller.token || allows(caller.token->scopes, route)) return {};
  std::vector<std::string_view> needed;
  for (const TokenScope scope : scopes_of(route)) needed.push_back(name(scope));
  if (needed.empty())
    return core::Error{core::Errc::forbidden, "this route cannot be called with an API token"};
  return core::Error{core::Errc::forbidden,
                     fmt::format("this API token lacks the scope {}", fmt::join(needed, " or "))};
}

/// @param asked  gets who it is, allowed or not
core::Result<Caller> allowed_caller(Backend& backend, const RouteInfo& route,
                                    const http::RequestHead& head, Asked* asked = nullptr,
                                    Presence presence = Presence::shown) {
  Caller caller{Role::station, "", "", ""};
  if (!route.open) {
    auto authenticated = TRY(authenticate(backend, head, presence));
    caller = std::move(authenticated);
    if (asked) asked->caller = caller;
    if (!granted(route, caller.role)) {
      if (asked) asked->overstepped = true;
      return core::Error{
          core::Errc::forbidden,
          fmt::format("this route is not allowed for the role {}", name(caller.role))};
    }
    if (const auto scoped = check_scope(route, caller); !scoped) {
      if (asked) asked->overstepped = true;
      return scoped.error();
    }
    if (caller.must_change && !route.before_password_change)
      return core::Error{core::Errc::forbidden,
                         "choose a new password first: POST /api/v1/session/password"};
  }
  TRY(check_not_forged(route, caller, head));
  return caller;
}

/// Runs the handler; what it changes is noted in the audit trail.
core::Result<http::Response> handled(Backend& backend, const Match& matched, const Caller& caller,
                                     const http::Request& request,
                                     std::map<std::string, std::string> arguments) {
  const RouteInfo& route = *matched.route;
  const Call call{backend, request, caller, std::move(arguments),
                  granted(route, caller.role).value_or(Scope::own)};
  if (route.method == "GET" || !route.audited) return route.handle(call);
  const store::AuditScope acting(audited_action(route, call, matched.segments));
  return route.handle(call);
}

http::Response refusal(const core::Error& error, std::string_view allowed) {
  if (error.code == core::Errc::not_found && !allowed.empty()) {
    const std::string methods(allowed);
    auto response =
        http::error_response(405, "bad_input", "this address accepts only the methods " + methods);
    return response.with("Allow", methods), response;
  }
  if (is_throttled(error)) {
    auto response = http::error_response(429, "too_many", error.what);
    return response.with("Retry-After", std::to_string(kTokenRetry_s)), response;
  }
  auto response = error_response(error);
  if (error.code == core::Errc::unauthorised) response.with("WWW-Authenticate", "Bearer");
  return response;
}

}  // namespace

core::Result<Match> match(const std::vector<RouteInfo>& table, const http::RequestHead& head,
                          std::string* allowed) {
  const auto path = segments_of(head.path);
  for (const RouteInfo& route : table) {
    const auto pattern = segments_of(route.path);
    if (!fits(pattern, path)) continue;
    const bool same =
        route.method == head.method || (head.method == "HEAD" && route.method == "GET");
    if (same) return bound(route, pattern, path);
    if (allowed) *allowed += (allowed->empty() ? "" : ", ") + route.method;
  }
  return core::Error{core::Errc::not_found, "no route of the API has this address"};
}

core::Result<std::map<std::string, std::string>> arguments(const Match& matched,
                                                           const http::RequestHead& head) {
  TRY(check_query_is_declared(*matched.route, head));
  std::map<std::string, std::string> out;
  for (const Parameter& p : matched.route->parameters) {
    auto value = given(p, matched, head);
    if (!value) value = p.fallback;
    if (!value && p.required)
      return core::Error{core::Errc::bad_input,
                         p.name + ": this parameter is missing (" + p.meaning + ")"};
    if (!value) continue;
    TRY(check(p, *value));
    out.emplace(p.name, std::move(*value));
  }
  return out;
}

namespace {

http::Response answer_to_nowhere(Backend& backend, Asked& asked, const http::RequestHead& head) {
  // Who may not come in is not told which addresses there are.
  auto known = authenticate(backend, head);
  if (!known) return refusal(known.error(), "");
  asked.caller = std::move(*known);
  return refusal(asked.matched.error(), asked.allowed);
}

http::Response answer_to(Backend& backend, Asked& asked, const http::Request& request) {
  const auto& matched = asked.matched;
  if (!matched) return answer_to_nowhere(backend, asked, request);
  auto caller = allowed_caller(backend, *matched->route, request, &asked);
  if (!caller) return refusal(caller.error(), "");
  if (request.body.size() > matched->route->body_limit_bytes)
    return error_response({core::Errc::too_large,
                           fmt::format("the body has {} bytes, at most {} are allowed",
                                       request.body.size(), matched->route->body_limit_bytes)});
  auto checked = arguments(*matched, request);
  if (!checked) return error_response(checked.error());
  if (auto may = check_access(backend, *matched->route, *caller, *checked, request.body); !may) {
    asked.overstepped =
        may.error().code == core::Errc::not_found || may.error().code == core::Errc::forbidden;
    return refusal(may.error(), "");
  }
  auto response = handled(backend, *matched, *caller, request, std::move(*checked));
  if (response) return std::move(*response);
  asked.overstepped = response.error().code == core::Errc::forbidden;
  return refusal(response.error(), "");
}

/// Who asked for what is not theirs, and what a station was refused, is in the audit trail.
void note_if_refused(Backend& backend, const Asked& asked, const http::RequestHead& head,
                     const http::Response& response) {
  if (!asked.caller) return;
  const std::string route = asked.matched ? asked.matched->route->id : "nothing";
  const bool noted = asked.caller->role == Role::station
                         ? is_refusal_of_station(route, response.status)
                         : asked.overstepped;
  if (!noted) return;
  note_refusal(backend, *asked.caller, head.peer, route,
               asked.matched ? object_text(asked.matched->segments) : "", words_of(response),
               response.status);
}

/// Counts it, and says what took long or went wrong.
void note(Backend& backend, const std::string& route, const http::Request& request,
          const http::Response& response, double took_s) {
  constexpr double kLong_s = 5.0;
  backend.telemetry.count(route, response.status, took_s, request.body.size());
  if (!backend.log || (response.status < 500 && took_s < kLong_s && !backend.logs_requests)) return;
  core::Json line{{"what", "request"},
                  {"route", route},
                  {"status", response.status},
                  {"took_s", took_s},
                  {"body_bytes", request.body.size()}};
  const auto trace = tracing::parse_traceparent(request.header("traceparent"));
  if (backend.tracer && trace) line["trace_id"] = trace->trace_id;
  backend.log(line);
}

}  // namespace

http::Response answer(Backend& backend, const std::vector<RouteInfo>& table,
                      const http::Request& request) {
  const core::MonotonicClock clock;
  const core::Instant_ns begun = clock.now();
  std::string allowed;
  const auto matched = match(table, request, &allowed);
  Asked asked{matched, allowed};
  http::Response response = answer_to(backend, asked, request);
  note_if_refused(backend, asked, request, response);
  note(backend, matched ? matched->route->id : "", request, response,
       double(clock.now() - begun) * 1e-9);
  return response;
}

std::variant<http::Admitted, http::Response> admit(Backend& backend,
                                                   const std::vector<RouteInfo>& table,
                                                   const http::RequestHead& head) {
  std::string allowed;
  auto matched = match(table, head, &allowed);
  Asked asked{matched, allowed};
  const auto refused = [&](http::Response response) {
    note_if_refused(backend, asked, head, response);
    return response;
  };
  if (!matched) return refused(answer_to_nowhere(backend, asked, head));
  const auto caller = allowed_caller(backend, *matched->route, head, &asked);
  if (!caller) return refused(refusal(caller.error(), ""));
  const std::uint64_t limit = matched->route->body_limit_bytes;
  if (head.body_bytes > limit)
    return refused(error_response(
        {core::Errc::too_large,
         fmt::format("the body has {} bytes, at most {} are allowed", head.body_bytes, limit)}));
  return http::Admitted{limit, matched->route->body_to_file, caller->id};
}

namespace {

/// "https://host:port" is the host that was asked?
bool is_own_origin(const http::RequestHead& head) {
  std::string_view origin = head.header("origin");
  const auto scheme = origin.find("://");
  if (scheme == std::string_view::npos) return false;
  origin.remove_prefix(scheme + 3);
  return std::ranges::equal(
      origin, head.header("host"), {}, [](unsigned char c) { return std::tolower(c); },
      [](unsigned char c) { return std::tolower(c); });
}

core::Result<std::shared_ptr<http::WebSocketHandler>> conversation(Backend& backend, Asked& asked,
                                                                   const http::Request& request) {
  const RouteInfo& route = *asked.matched->route;
  auto caller = TRY(allowed_caller(backend, route, request, &asked));
  if (!caller.session_hash.empty() && !is_own_origin(request))
    return core::Error{
        core::Errc::forbidden,
        "the header Origin does not name this server: only its own pages may open a WebSocket"};
  auto checked = TRY(arguments(*asked.matched, request));
  if (auto may = check_access(backend, route, caller, checked, ""); !may) {
    asked.overstepped = may.error().code == core::Errc::not_found;
    return may.error();
  }
  const Call call{backend, request, caller, std::move(checked),
                  granted(route, caller.role).value_or(Scope::own)};
  return route.converse(call, [&backend, &route, head = http::RequestHead(request)] {
    return bool(allowed_caller(backend, route, head, nullptr, Presence::not_shown));
  });
}

}  // namespace

std::variant<http::Response, std::shared_ptr<http::WebSocketHandler>> converse(
    Backend& backend, const std::vector<RouteInfo>& table, const http::RequestHead& head) {
  std::string allowed;
  const auto matched = match(table, head, &allowed);
  Asked asked{matched, allowed};
  const http::Request request{head, std::string()};
  const auto refused = [&](http::Response response) {
    note_if_refused(backend, asked, head, response);
    note(backend, matched ? matched->route->id : "", request, response, 0.0);
    return response;
  };
  if (!matched) return refused(answer_to_nowhere(backend, asked, head));
  if (!matched->route->converse) {
    const core::Error none{core::Errc::bad_input, "this address is not a WebSocket"};
    auto caller = allowed_caller(backend, *matched->route, head, &asked);
    return refused(refusal(caller ? none : caller.error(), ""));
  }
  auto opened = conversation(backend, asked, request);
  if (!opened) return refused(refusal(opened.error(), ""));
  note(backend, matched->route->id, request,
       http::Response{.status = 101, .headers = {}, .body = {}}, 0.0);
  return std::move(*opened);
}

bool still_allowed(Backend& backend, const std::vector<RouteInfo>& table,
                   const http::RequestHead& head) {
  const auto matched = match(table, head);
  return matched && allowed_caller(backend, *matched->route, head, nullptr, Presence::not_shown);
}

http::Lane lane_of(const std::vector<RouteInfo>& table, const http::RequestHead& head) {
  const auto matched = match(table, head);
  return matched ? matched->route->lane : http::Lane::quick;
}

namespace {

/// Of an open route, where nobody's credentials are known yet.
std::variant<http::Standing, http::Response> standing_of_origin(Backend& backend,
                                                                const RouteInfo& route,
                                                                const std::string& origin) {
  constexpr auto kSecret = store::Secret::account_password;
  auto known = backend.store.read(
      [&](store::Reading& tx) { return store::is_known_origin(tx, kSecret, origin); });
  if (!known) return refusal(known.error(), "");
  if (*known) return http::Standing::familiar;
  if (route.lane != http::Lane::hashing) return http::Standing::stranger;
  auto early = too_early_from(backend, kSecret, origin);
  if (!early) return refusal(early.error(), "");
  if (*early) return std::move(**early);
  return http::Standing::stranger;
}

}  // namespace

std::variant<http::Standing, http::Response> standing(Backend& backend,
                                                      const std::vector<RouteInfo>& table,
                                                      const http::RequestHead& head) {
  const auto matched = match(table, head);
  if (!matched) return refusal(matched.error(), "");
  if (matched->route->open)
    return standing_of_origin(backend, *matched->route, network_of(head.peer));
  Asked asked{matched, ""};
  auto caller = allowed_caller(backend, *matched->route, head, &asked);
  if (caller) return http::Standing::familiar;
  auto refused = refusal(caller.error(), "");
  note_if_refused(backend, asked, head, refused);
  return refused;
}

}  // namespace api
}  // namespace tractus
