#include "volume/io/dicom_layout.hpp"

#include "fuzz/target.hpp"

namespace tractus::fuzz {

Target dicom_layout() {
  return {"dicom_layout", "a DICOM file, from a person", {}, [](core::ByteView bytes) {
            volume_io::codestream_extent(bytes);
            return taken(volume_io::parse_dicom_layout(bytes, "it.dcm"));
          }};
}

}  // namespace tractus::fuzz
