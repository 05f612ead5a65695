#include "server/api/access.hpp"

#include <algorithm>

#include "core/require.hpp"
#include "server/api/backend.hpp"

namespace api {

std::optional<Of> granted(const RouteInfo& route, Role role) {
  std::optional<Of> widest;
  for (const Grant& grant : route.who)
    if (grant.role == role && (!widest || grant.of > *widest)) widest = grant.of;
  return widest;
}

core::Result<bool> relates(store::Reading& tx, const Caller& caller, Of of, Object object,
                           const std::string& id) {
  if (of == Of::all) return true;
  const bool leads = of == Of::cohort;
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
    case Object::cohort:
      return leads ? store::leads_cohort(tx, caller.id, id)
                   : store::is_in_cohort(tx, caller.id, id);
    case Object::assignment:
      return leads ? store::leads_assignment(tx, caller.id, id)
                   : store::has_assignment(tx, caller.id, id);
    case Object::none:
      return true;  // the handler answers by Call::of
  }
  return false;
}

core::Result<void> check_object(Backend& backend, const RouteInfo& route, const Caller& caller,
                                const std::map<std::string, std::string>& arguments) {
  const auto of = granted(route, caller.role);
  if (!of || *of == Of::all || route.object == Object::none) return {};
  const auto id = arguments.find(route.object_parameter);
  core::require(id != arguments.end(), "a route names its object by one of its arguments");
  auto stands = backend.store.read(
      [&](store::Reading& tx) { return relates(tx, caller, *of, route.object, id->second); });
  if (!stands) return stands.error();
  if (*stands) return {};
  return core::Error{core::Errc::not_found, "there is nothing of yours by this name"};
}

}  // namespace api
