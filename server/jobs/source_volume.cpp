#include "server/jobs/source_volume.hpp"

#include "cases/carving.hpp"

namespace jobs {

core::Result<SourceVolume> released_volume(store::Store& store, const store::Objects& objects,
                                           const std::string& id) {
  const auto rows = store.read([&](store::Reading& tx) {
    return tx.query("select name, source, state, coalesce(sha256, '') from volumes where id = ?",
                    {id});
  });
  if (!rows) return rows.error();
  if (rows->empty()) return core::Error{core::Errc::not_found, "no volume " + id.substr(0, 64)};
  const store::Row& row = rows->front();
  if (row.text(2) != "released")
    return core::Error{core::Errc::conflict,
                       "this volume is not released: somebody must look at it first"};
  auto file = volume::VolumeFile::open(objects.path_of(row.text(3)));
  if (!file) return file.error();
  return SourceVolume{row.text(0), row.text(1), std::move(*file)};
}

core::Result<volume::Volume> read_about(const volume::VolumeFile& file, const math::Vec3& entry_m,
                                        const math::Vec3& target_m,
                                        const core::Progress& progress) {
  const auto box = cases::box_that_matters(file.geometry(), entry_m, target_m);
  if (!box) return box.error();
  return file.read_box(*box, progress);
}

}  // namespace jobs
