#include "server/api/studies/relapses.hpp"

#include <fmt/format.h>

#include "core/try.hpp"
#include "db/store/operations/audit.hpp"
#include "db/store/operations/notifications.hpp"
#include "db/store/people/accounts.hpp"
#include "server/api/studies/trainees.hpp"

namespace tractus {
namespace api {
namespace {

struct SignalledRelapse {
  std::string trainee;
  std::int64_t at_trial = 0;
};

core::Result<std::vector<SignalledRelapse>> signalled_relapses(Backend& backend) {
  const http::Request request;
  const Caller caller{Role::director, "", store::kServer, ""};
  const Call call{backend, request, caller, {}, Scope::all};
  const auto programme = TRY(programme_of(call));
  std::vector<SignalledRelapse> out;
  const core::Json list = list_json(programme);
  for (const core::Json& one : list["trainees"]) {
    if (one["state"] != "relapsed") continue;
    const auto name = one["trainee"].get<std::string>();
    const auto at = std::ranges::find(programme.cohort.trainees, name);
    const auto place = static_cast<std::size_t>(at - programme.cohort.trainees.begin());
    const core::Json relapses = trainee_json(programme, place)["relapses"];
    if (!relapses.empty()) out.push_back({name, relapses.back()["at_trial"].get<std::int64_t>()});
  }
  return out;
}

}  // namespace

core::Result<void> note_relapses(Backend& backend) {
  const auto relapses = TRY(signalled_relapses(backend));
  if (relapses.empty()) return {};
  const std::int64_t now = backend.now_utc_us();
  return backend.store.write([&](store::Writing& tx) -> core::Result<void> {
    for (const SignalledRelapse& one : relapses) {
      const auto account = TRY(store::account_named(tx, one.trainee));
      if (!account) continue;  // a pseudonym of a study, or a simulated operator
      TRY(store::note_event(tx, {.id = {},
                                 .kind = store::NotificationKind::relapse,
                                 .key = fmt::format("relapse/{}/{}", account->id, one.at_trial),
                                 .subject = account->id,
                                 .at_utc_us = now}));
    }
    return {};
  });
}

}  // namespace api
}  // namespace tractus
