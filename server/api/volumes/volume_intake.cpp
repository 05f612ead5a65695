#include "server/api/volumes/volume_intake.hpp"

#include <mutex>

#include "core/file.hpp"
#include "core/try.hpp"
#include "server/api/backend.hpp"
#include "server/jobs/import_volume.hpp"

namespace tractus {
namespace api {
namespace {

namespace fs = std::filesystem;
using core::Errc;
using core::Error;
using core::Result;

Result<ImportedVolume> kept(const Backend& backend, const fs::path& folder, core::Json answer) {
  const fs::path file = folder / jobs::kTakenVolume;
  auto sha256 = TRY(store::file_sha256(file));
  TRY(backend.objects.copy_in(file, sha256));
  std::error_code failure;
  return ImportedVolume{sha256, fs::file_size(file, failure), std::move(answer["facts"]),
                        std::move(answer["report"])};
}

}  // namespace

Result<ImportedVolume> take_in(const Call& call) {
  static std::mutex one_at_a_time;
  const std::unique_lock held(one_at_a_time, std::try_to_lock);
  if (!held) return Error{Errc::unavailable, "another volume is being read: try again in a minute"};
  // On the data's disk: what a server that dies in the midst leaves there, the next start removes.
  auto scratch = TRY(core::ScratchFolder::make(call.backend.scratch->folder() / "volume"));
  const auto file = TRY(body_in(call, scratch.path(), "upload"));
  const fs::path& upload = file;
  const volume_io::UidKey key = call.backend.secrets.uid_key();
  auto answer =
      TRY(call.backend.import_volume ? call.backend.import_volume(upload, scratch.path(), key)
                                     : jobs::import_volume(upload, scratch.path(), key));
  return kept(call.backend, scratch.path(), std::move(answer));
}

}  // namespace api
}  // namespace tractus
