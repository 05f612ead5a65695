#include "core/require.hpp"
#include "drilling/drilled.hpp"
#include "fuzz/target.hpp"

namespace tractus::fuzz {

Target drilled_file() {
  return {"drilled_file",
          "tractus-drilled/1, from a station's own folder",
          {},
          [](core::ByteView bytes) {
            const std::array<int, 3> dims{9, 9, 9};  // as the seed's
            const auto read = drilling::read_drilled(placed("a.tdrill", bytes),
                                                     "0123456789abcdef0123456789abcdef",
                                                     std::string(64, 'a'), dims);
            if (!taken(read)) return false;
            volume::Volume volume;
            volume.geometry.dims = dims;
            volume.counts.resize(volume.geometry.voxel_count());
            read->put_into(volume);  // stays within the volume: the sanitizers look
            return true;
          }};
}

}  // namespace tractus::fuzz
