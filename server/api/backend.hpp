/// What handlers work with. One per process; safe from several threads.
#pragma once

#include <functional>

#include "core/json.hpp"
#include "db/store/objects.hpp"
#include "db/store/store.hpp"
#include "server/api/backups.hpp"
#include "server/api/refusals.hpp"
#include "server/api/secrets.hpp"
#include "server/api/telemetry.hpp"
#include "server/api/trial_views.hpp"

namespace live {
class Hub;
}

namespace api {

/// What happened, as fields: never a name, an address, or anything that somebody typed.
using Log = std::function<void(const core::Json& fields)>;

struct Backend {
  store::Store& store;
  const store::Objects& objects;
  const store::PartialFiles& partials;
  std::function<std::int64_t()> now_utc_us;
  std::function<void()> work_waits;                ///< tells the job runner
  Secrets secrets = Secrets::random();             ///< a server that lasts brings its own
  bool secure_cookies = false;                     ///< browsers reach it by TLS
  std::function<std::uint64_t()> free_bytes = {};  ///< on the disk; none: the system is asked
  Log log = {};                                    ///< a line for whoever runs the server
  bool logs_requests = false;                      ///< every one, not only those that fail
  live::Hub* live = nullptr;                       ///< none: stations have no lines
  Backups* backups = nullptr;                      ///< none: this process makes none
  Telemetry telemetry{};
  Refusals refusals{};
  TrialViews trial_views{};
};

}  // namespace api
