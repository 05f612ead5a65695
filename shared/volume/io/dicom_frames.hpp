/// The slices of a file that holds several: an enhanced multi-frame CT.
#pragma once

#include <map>
#include <vector>

#include "volume/io/dicom_layout.hpp"

namespace tractus::volume_io {

/// What functional groups (PS3.3 C.7.6.16) say of each frame: its position, orientation, pixel
/// spacing, rescale slope and intercept. Other macros are passed over.
class FunctionalGroups {
 public:
  using Values = std::map<std::uint32_t, DicomElement>;  ///< by tag

  /// Every element of the file, in the order of the walk.
  void see(const DicomElement& element);

  /// Are the file's slices stated by frame, and not once for the file?
  bool state_slices() const { return !frames_.empty() && !file_states_place_; }
  /// In the order of the pixels; what is shared by all frames is each one's.
  std::vector<Values> frames() const;
  /// Is it one of the values of a frame, told by where it lies?
  bool is_value(const DicomElement& element) const;

 private:
  std::vector<DicomElement> pending_;      ///< of the sequence under way
  std::map<std::size_t, Values> by_item_;  ///< of the groups under way
  std::map<std::size_t, Values> frames_;   ///< by the offset of the frame's item
  Values shared_;
  bool file_states_place_ = false;
};

/// Each frame's pixels in the element that holds them all: equal parts, or one fragment each.
/// Errors: bad_input if they cannot be told apart.
core::Result<std::vector<core::ByteView>> frame_pixels(core::ByteView file,
                                                       const DicomElement& pixels,
                                                       const DicomLayout& layout,
                                                       std::size_t frames,
                                                       const std::filesystem::path& path);

/// What a person can do about a file whose frames cannot be read.
inline constexpr const char* kExportClassic =
    "export it from the scanner or PACS as a classic CT series, one file a slice";

}  // namespace tractus::volume_io
