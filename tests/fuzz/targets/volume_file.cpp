#include "volume/volume_file.hpp"

#include "fuzz/target.hpp"

namespace tractus::fuzz {

Target volume_file() {
  return {
      "volume_file", "tractus-volume/1, from a server or a person", {}, [](core::ByteView bytes) {
        const auto file = volume::VolumeFile::open(placed("v.tvol", bytes));
        return taken(file) && taken(file->read_all());
      }};
}

}  // namespace tractus::fuzz
