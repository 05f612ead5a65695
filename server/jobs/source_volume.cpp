#include "server/jobs/source_volume.hpp"

#include "cases/carving.hpp"
#include "core/try.hpp"
#include "db/store/volumes/volumes.hpp"

namespace tractus::jobs {

core::Result<SourceVolume> released_volume(store::Store& store, const store::Objects& objects,
                                           const std::string& id) {
  const auto found = TRY(store.read([&](store::Reading& tx) { return store::volume_of(tx, id); }));
  if (!found) return core::Error{core::Errc::not_found, "no volume " + id.substr(0, 64)};
  const store::VolumeRecord& volume = *found;
  if (volume.state != store::VolumeState::released)
    return core::Error{
        core::Errc::conflict,
        "this volume is not released: a person must look at its pictures and release it first"};
  auto file = TRY(volume::VolumeFile::open(TRY(objects.file(volume.sha256))));
  return SourceVolume{volume.name, volume.source, std::move(file)};
}

core::Result<volume::Volume> read_about(const volume::VolumeFile& file, const math::Vec3& entry_m,
                                        const math::Vec3& target_m,
                                        const core::Progress& progress) {
  const auto box = TRY(cases::box_that_matters(file.geometry(), entry_m, target_m));
  return file.read_box(box, progress);
}

}  // namespace tractus::jobs
