#include "server/api/volumes/volume_intake.hpp"

#include <mutex>

#include "core/file.hpp"
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
  auto sha256 = store::file_sha256(file);
  if (!sha256) return sha256.error();
  if (auto copied = backend.objects.copy_in(file, *sha256); !copied) return copied.error();
  std::error_code failure;
  return ImportedVolume{*sha256, fs::file_size(file, failure), std::move(answer["facts"]),
                        std::move(answer["report"])};
}

}  // namespace

Result<ImportedVolume> take_in(const Call& call) {
  static std::mutex one_at_a_time;
  const std::unique_lock held(one_at_a_time, std::try_to_lock);
  if (!held) return Error{Errc::unavailable, "another volume is being read: try again in a minute"};
  // On the data's disk: what a server that dies in the midst leaves there, the next start removes.
  auto scratch = core::ScratchFolder::make(call.backend.scratch->folder() / "volume");
  if (!scratch) return scratch.error();
  const auto file = body_in(call, scratch->path(), "upload");
  if (!file) return file.error();
  const fs::path& upload = *file;
  const volume_io::UidKey key = call.backend.secrets.uid_key();
  auto answer = call.backend.import_volume
                    ? call.backend.import_volume(upload, scratch->path(), key)
                    : jobs::import_volume(upload, scratch->path(), key);
  if (!answer) return answer.error();
  return kept(call.backend, scratch->path(), std::move(*answer));
}

}  // namespace api
}  // namespace tractus
