/// What handlers work with. One per process; safe from several threads.
#pragma once

#include <functional>

#include "core/json.hpp"
#include "db/store/store.hpp"
#include "db/store/volumes/objects.hpp"
#include "server/api/operations/backups.hpp"
#include "server/api/operations/telemetry.hpp"
#include "server/api/people/secrets.hpp"
#include "server/api/refusals.hpp"
#include "server/api/trials/trial_views.hpp"
#include "server/http/scratch_space.hpp"

namespace tractus::live {
class Hub;
}

namespace tractus::api {

/// What happened, as fields: never a name, an address, or anything that somebody typed.
using Log = std::function<void(const core::Json& fields)>;

/// jobs::import_volume, wherever it is run.
using TakeVolume = std::function<core::Result<core::Json>(const std::filesystem::path& upload,
                                                          const std::filesystem::path& folder,
                                                          const std::array<std::byte, 32>& key)>;

class Oidc;

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
  TakeVolume import_volume = {};                   ///< in a process of its own; none: in this one
  /// For large bodies and answers.
  std::shared_ptr<http::ScratchSpace> scratch =
      std::make_shared<http::ScratchSpace>(std::filesystem::temp_directory_path());
  const Oidc* oidc = nullptr;  ///< who else may vouch for people; none: nobody
  /// Which pseudonym is whose (export.hpp): kept apart from all else. None: no export.
  std::optional<std::array<std::byte, 32>> pseudonym_key = {};
  RefusalLimit refusals{};
  Telemetry telemetry{};
  TrialViews trial_views{};
};

}  // namespace tractus::api
