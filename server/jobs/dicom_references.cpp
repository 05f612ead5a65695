#include "server/jobs/dicom_references.hpp"

#include <algorithm>

#include "core/try.hpp"
#include "volume/io/dicom_files.hpp"
#include "volume/io/dicom_layout.hpp"

namespace tractus {
namespace jobs {
namespace {

constexpr std::uint32_t kClassUid = 0x00080016, kInstanceUid = 0x00080018;

/// Digits and dots, without the padding.
std::string uid_of(std::string_view value) {
  while (!value.empty() && (value.back() == '\0' || value.back() == ' ')) value.remove_suffix(1);
  const bool is_uid =
      value.size() <= 64 && value.find_first_not_of("0123456789.") == std::string_view::npos;
  return is_uid ? std::string(value) : "";
}

core::Result<InstanceReference> instance_in(volume_io::DicomFiles& files,
                                            const std::filesystem::path& path) {
  const std::filesystem::path shown = path.filename();  // where it lies is nobody's business
  const auto file = TRY(files.read(path));
  const std::string_view bytes = core::text_of(file);
  InstanceReference out;
  TRY(volume_io::parse_dicom_layout(file, shown, [&](const volume_io::DicomElement& element) {
    if (element.depth != 0) return;
    const std::string_view value = bytes.substr(element.value_at, element.end - element.value_at);
    if (element.tag == kClassUid) out.class_uid = uid_of(value);
    if (element.tag == kInstanceUid) out.instance_uid = uid_of(value);
  }));
  if (!out.class_uid.empty() && !out.instance_uid.empty()) return out;
  return core::bad_input(shown.string() + ": does not say which instance it is");
}

}  // namespace

core::Result<std::vector<InstanceReference>> instances_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> paths;
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failure))
    paths.push_back(entry.path());
  if (failure) return core::Error{core::Errc::io, "the series: " + failure.message()};
  std::ranges::sort(paths);
  std::vector<InstanceReference> out;
  volume_io::DicomFiles files;
  for (const auto& path : paths) out.push_back(TRY(instance_in(files, path)));
  return out;
}

}  // namespace jobs
}  // namespace tractus
