/// DICOM files without the patient.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/bytes.hpp"
#include "core/json.hpp"
#include "core/result.hpp"
#include "volume/io/dicom_frames.hpp"
#include "volume/io/uid_key.hpp"

namespace tractus::volume_io {

/// Cleans the files of one import and keeps account of what it did, by attribute, never with a
/// value. What is kept is `kept_row`; faces and text in the pixels are not touched (see
/// text_suspicions): a person looks before anybody else does.
class Deidentifier {
 public:
  explicit Deidentifier(const UidKey& key) : key_(key) {}

  /// Takes a slice; `frame` counts from 1 in a file of several, and is 0 in a file of one.
  using Keep = std::function<core::Result<void>(std::size_t frame, core::ByteView slice)>;

  /// The file written anew in its own transfer syntax: an empty preamble, the meta information a
  /// reader needs, what is kept of the data set, and that it was de-identified (0012,0062 and
  /// 0012,0063). A file whose functional groups state slices becomes a file for each of them, with
  /// the frame's place and scaling as its own. Errors: those of parse_dicom_layout and `keep`;
  /// bad_input for a kept attribute whose value is not of its form, and for frames whose places or
  /// pixels cannot be told apart. No message holds a value.
  core::Result<void> cleaned(core::ByteView file, const std::filesystem::path& path,
                             const Keep& keep);

  /// "tractus-deidentification/1": {"format","profile","codes" (of PS3.16 CID 7050),"files",
  /// "attributes":[{"tag","name","vr","profile" (the table's action, "" when not listed),"done"
  /// ("removed","replaced","kept","new identifier"),"count","nested"}],"text_in_pixels","faces"}.
  /// Private attributes are counted by group.
  core::Json report() const;
  /// What in the attributes speaks for text in the pixels or for a face, one line each.
  std::vector<std::string> suspicions() const { return {suspicions_.begin(), suspicions_.end()}; }

 private:
  struct Count {
    std::uint64_t whole = 0, nested = 0;
  };
  struct Writing;
  core::Result<void> take(const DicomElement& element, Writing& out);
  core::Result<void> cleaned_frames(const FunctionalGroups& groups, Writing& out, const Keep& keep);
  void suspect(const DicomElement& element, std::string_view value);
  void note(const DicomElement& element, const char* done);

  UidKey key_;
  std::uint64_t files_ = 0;
  /// By tag (of a private one its group) and by what was done.
  std::map<std::pair<std::uint32_t, std::string>, Count> counts_;
  std::map<std::uint32_t, std::string> vrs_;
  std::set<std::string> suspicions_;
};

/// "2.25." and a keyed 128-bit hash as a decimal number: a valid identifier (PS3.5 B.2) that only
/// the key's owner can tie to the old one.
std::string replaced_uid(std::string_view uid, const UidKey& key);

}  // namespace tractus::volume_io
