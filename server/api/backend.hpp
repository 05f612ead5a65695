/// The parts of the server that handlers use. One per process; thread-safe.
#pragma once

#include <functional>

#include "core/json.hpp"
#include "db/store/store.hpp"
#include "db/store/volumes/objects.hpp"
#include "server/api/cohort/held_cohorts.hpp"
#include "server/api/learning/platform_keys.hpp"
#include "server/api/operations/backups.hpp"
#include "server/api/operations/telemetry.hpp"
#include "server/api/people/secrets.hpp"
#include "server/api/refusals.hpp"
#include "server/api/trials/trial_views.hpp"
#include "server/api/trials/upload_owners.hpp"
#include "server/http/scratch_space.hpp"

namespace tractus::live {
class Hub;
}

namespace tractus::tracing {
class Tracer;
}

namespace tractus::api {

/// Writes an event to the log as fields, which must not contain names, addresses or text that a
/// person typed.
using Log = std::function<void(const core::Json& fields)>;

/// Runs jobs::import_volume, in this process or in another one.
using TakeVolume = std::function<core::Result<core::Json>(
    const std::filesystem::path& upload, const std::filesystem::path& folder,
    const std::array<std::byte, 32>& key, const std::string& series_uid)>;

class Oidc;
class Notifier;
class PacsImports;

struct Backend {
  store::Store& store;
  const store::Objects& objects;
  const store::PartialFiles& partials;
  std::function<std::int64_t()> now_utc_us;
  std::function<void()> work_waits;     ///< wakes the job runner
  Secrets secrets = Secrets::random();  ///< random keys are for tests; a server passes its own
  bool secure_cookies = false;  ///< browsers use TLS, so that cookies have the attribute Secure
  std::function<std::uint64_t()> free_bytes = {};  ///< none: asks the operating system
  Log log = {};                                    ///< writes a line to the server's log
  bool logs_requests = false;                      ///< log every request, not only failed ones
  live::Hub* live = nullptr;                       ///< null: no live connections to stations
  Backups* backups = nullptr;                      ///< null: this process makes no backups
  TakeVolume import_volume = {};  ///< runs in another process; none: in this process
  /// For large bodies and answers.
  std::shared_ptr<http::ScratchSpace> scratch =
      std::make_shared<http::ScratchSpace>(std::filesystem::temp_directory_path());
  const Oidc* oidc = nullptr;  ///< OpenID Connect provider; null: none
  /// Key of the pseudonyms (export.hpp), stored separately from all other keys. None: no exports.
  std::optional<std::array<std::byte, 32>> pseudonym_key = {};
  RefusalLimit refusals{};
  Telemetry telemetry{};
  TrialViews trial_views{};
  UploadOwners upload_owners{};
  HeldCohorts held_cohorts{};
  PlatformKeys platform_keys{};
  Notifier* notifier = nullptr;       ///< null: nobody is told of events by e-mail or webhook
  PacsImports* pacs = nullptr;        ///< null: no PACS is stated
  tracing::Tracer* tracer = nullptr;  ///< null: uploads are not traced
};

}  // namespace tractus::api
