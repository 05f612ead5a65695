#include "volume/io/nifti_header.hpp"

#include "fuzz/target.hpp"

namespace tractus::fuzz {

Target nifti_header() {
  return {"nifti_header", "the head of a NIfTI file, from a person", {}, [](core::ByteView bytes) {
            return taken(volume_io::parse_nifti(bytes, "it.nii"));
          }};
}

}  // namespace tractus::fuzz
