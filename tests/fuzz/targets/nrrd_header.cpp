#include "volume/io/nrrd_header.hpp"

#include "fuzz/target.hpp"

namespace tractus::fuzz {

Target nrrd_header() {
  return {"nrrd_header", "the head of an NRRD file, from a person", {}, [](core::ByteView bytes) {
            return taken(volume_io::parse_nrrd(core::text_of(bytes), "it.nrrd"));
          }};
}

}  // namespace tractus::fuzz
