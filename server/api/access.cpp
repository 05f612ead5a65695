#include "server/api/access.hpp"

#include <algorithm>

#include "core/require.hpp"
#include "core/try.hpp"
#include "db/store/people/api_tokens.hpp"
#include "db/store/people/invitations.hpp"
#include "db/store/studies/blinding.hpp"
#include "server/api/backend.hpp"

namespace tractus {
namespace api {

namespace {

constexpr const char* kNotYours = "this object does not exist, or you may not access it";

/// The texts at `pointer`, in which a segment * is every element of an array.
void collect_texts(const core::Json& json, std::string_view pointer,
                   std::vector<std::string>& out) {
  if (pointer.empty()) {
    if (json.is_string()) out.push_back(json.get<std::string>());
    return;
  }
  pointer.remove_prefix(1);
  const auto end = std::min(pointer.find('/'), pointer.size());
  const std::string segment(pointer.substr(0, end));
  const std::string_view rest = pointer.substr(end);
  if (segment == "*" && json.is_array())
    for (const core::Json& one : json) collect_texts(one, rest, out);
  if (segment != "*" && json.is_object() && json.contains(segment))
    collect_texts(json[segment], rest, out);
}

bool is_in_body(const End& end) { return end.field.starts_with('/'); }

std::vector<std::string> named(const End& end, const std::map<std::string, std::string>& arguments,
                               const core::Json& body) {
  std::vector<std::string> out;
  if (is_in_body(end)) {
    collect_texts(body, end.field, out);
  } else if (const auto found = arguments.find(end.field); found != arguments.end()) {
    out.push_back(found->second);
  }
  return out;
}

/// Errors: forbidden for a trial that is blind still.
core::Result<void> check_not_blind(store::Reading& tx, Object object, const std::string& id) {
  if (object != Object::trial) return {};
  auto blind = TRY(store::is_blinded(tx, id));
  if (!blind) return {};
  return core::Error{core::Errc::forbidden,
                     "this trial belongs to a study whose participant still has trials to do: it "
                     "is shown after the last of these trials"};
}

/// May the caller name this object as this end?
core::Result<bool> may_name(store::Reading& tx, const Caller& caller, Scope of, const End& end,
                            const std::string& name) {
  if (of == Scope::all || end.by == End::By::id) return relates(tx, caller, of, end.object, name);
  auto account = TRY(store::account_named(tx, name));
  if (!account) return false;
  return relates(tx, caller, of, end.object, account->id);
}

core::Result<void> check_end(store::Reading& tx, const Caller& caller, const End& end,
                             const std::vector<std::string>& names) {
  if (names.empty()) return {};
  const std::string where = is_in_body(end) ? "body: " + end.field : end.field;
  const auto of = granted(end.who, caller.role);
  if (!of)
    return core::Error{core::Errc::forbidden, where + ": this object is not allowed for the role " +
                                                  std::string(name(caller.role))};
  for (const std::string& one : names) {
    auto may = TRY(may_name(tx, caller, *of, end, one));
    if (!may) return core::Error{core::Errc::not_found, where + ": " + kNotYours};
    TRY(check_not_blind(tx, end.object, one));
  }
  return {};
}

}  // namespace

std::optional<Scope> granted(const RouteInfo& route, Role role) { return granted(route.who, role); }

std::optional<Scope> granted(const std::vector<Grant>& who, Role role) {
  std::optional<Scope> widest;
  for (const Grant& grant : who)
    if (grant.role == role && (!widest || grant.of > *widest)) widest = grant.of;
  return widest;
}

core::Result<bool> relates(store::Reading& tx, const Caller& caller, Scope of, Object object,
                           const std::string& id) {
  if (of == Scope::all) return true;
  const bool leads = of == Scope::cohort;
  switch (object) {
    case Object::trial:
      return leads ? store::teaches_trial(tx, caller.id, id)
                   : store::sees_own_trial(tx, caller.id, id);
    case Object::published_case:
      if (leads) return false;
      return store::sees_own_case(tx, caller.id, id);
    case Object::account:
      if (leads) return store::teaches(tx, caller.id, id);
      return caller.id == id;
    case Object::person:
      if (leads) return store::leads_with(tx, caller.id, id);
      return caller.id == id;
    case Object::invitation:
      if (leads) return false;
      return store::is_invited(tx, caller.id, id);
    case Object::study:
      if (!leads) return false;
      return store::is_study_through(tx, id);
    case Object::model:
    case Object::station:
      return false;  // granted to all or to none
    case Object::cohort:
      return leads ? store::leads_cohort(tx, caller.id, id)
                   : store::is_in_cohort(tx, caller.id, id);
    case Object::assignment:
      return leads ? store::leads_assignment(tx, caller.id, id)
                   : store::has_assignment(tx, caller.id, id);
    case Object::api_token:
      if (leads) return false;
      return store::owns_api_token(tx, caller.id, id);
    case Object::none:
      return true;  // the handler answers by Call::of
  }
  return false;
}

namespace {

core::Result<void> check_object(store::Reading& tx, const RouteInfo& route, const Caller& caller,
                                const std::map<std::string, std::string>& arguments) {
  const auto of = granted(route, caller.role);
  if (!of || route.object == Object::none) return {};
  const auto id = arguments.find(route.object_parameter);
  core::require(id != arguments.end(), "a route names its object by one of its arguments");
  auto stands = TRY(relates(tx, caller, *of, route.object, id->second));
  if (!stands) return core::Error{core::Errc::not_found, kNotYours};
  return check_not_blind(tx, route.object, id->second);
}

}  // namespace

core::Result<void> check_access(Backend& backend, const RouteInfo& route, const Caller& caller,
                                const std::map<std::string, std::string>& arguments,
                                const std::string& body) {
  if (route.object == Object::none && route.ends.empty()) return {};
  return backend.store.read([&](store::Reading& tx) -> core::Result<void> {
    TRY(check_object(tx, route, caller, arguments));
    core::Json json;
    if (std::ranges::any_of(route.ends, is_in_body)) {
      auto parsed = TRY(core::parse_json(body, "body"));
      json = std::move(parsed);
    }
    for (const End& end : route.ends) TRY(check_end(tx, caller, end, named(end, arguments, json)));
    return {};
  });
}

}  // namespace api
}  // namespace tractus
