#include "fuzz/target.hpp"
#include "lab/io/unpacked.hpp"

namespace tractus::fuzz {

Target measurement_zip() {
  return {"measurement_zip",
          "a zip of a measurement set, uploaded to the lab",
          {},
          [](core::ByteView bytes) {
            const lab_io::UnpackLimits limits{.max_bytes = 1 << 20, .max_files = 50};
            return taken(lab_io::Unpacked::open(placed("set.zip", bytes), limits));
          },
          300};
}

}  // namespace tractus::fuzz
