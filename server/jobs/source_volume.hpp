/// The volumes that cases may be made of.
#pragma once

#include "db/store/store.hpp"
#include "db/store/volumes/objects.hpp"
#include "volume/volume_file.hpp"

namespace tractus::jobs {

/// A volume and what people call it.
struct SourceVolume {
  std::string name, source;
  volume::VolumeFile file;
};

/// Errors: not_found (no such volume), conflict (it is not released), those of reading.
core::Result<SourceVolume> released_volume(store::Store& store, const store::Objects& objects,
                                           const std::string& id);

/// The voxels that matter to a carving from `entry_m` to `target_m`: what lies farther
/// changes nothing. Errors: those of cases::box_that_matters and of reading.
core::Result<volume::Volume> read_about(const volume::VolumeFile& file, const math::Vec3& entry_m,
                                        const math::Vec3& target_m,
                                        const core::Progress& progress = {});

}  // namespace tractus::jobs
