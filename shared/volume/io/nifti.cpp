#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNew.h>

#include "core/try.hpp"
#include "volume/io/claims.hpp"
#include "volume/io/counts.hpp"
#include "volume/io/formats.hpp"
#include "volume/io/nifti_header.hpp"
#include "volume/io/vtk_quiet.hpp"

namespace tractus {
namespace volume_io {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kHeaderBytes = 540;

core::Result<void> check_size(const NiftiHeader& header, const fs::path& path,
                              const core::Progress& progress) {
  const std::uint64_t expected =
      header.data_at +
      header.geometry.voxel_count() * static_cast<std::uint64_t>(header.sample_bytes);
  if (is_gzip(path)) return check_gzip(path, 0, expected, progress);
  const auto size = TRY(size_of_file(path));
  if (size != expected)
    return bad(path, fmt::format("has {} bytes, its header declares {}", size, expected));
  return {};
}

/// VTK turns the order of slices round when the file's axes are left-handed; this turns it back to
/// the file's.
void reverse_slices(Counts& counts, const std::array<int, 3>& dims) {
  const auto slice = static_cast<std::ptrdiff_t>(dims[0]) * dims[1];
  for (std::ptrdiff_t low = 0, high = dims[2] - 1; low < high; ++low, --high)
    std::swap_ranges(counts.counts.begin() + low * slice, counts.counts.begin() + (low + 1) * slice,
                     counts.counts.begin() + high * slice);
}

core::Result<Counts> read_voxels(const NiftiHeader& header, const fs::path& path) {
  vtkNew<vtkNIFTIImageReader> reader;
  const VtkErrors errors(reader);
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  std::array<int, 3> dims{};
  image->GetDimensions(dims.data());
  if (!errors.first().empty() || reader->GetErrorCode() != 0 || dims != header.geometry.dims ||
      image->GetNumberOfScalarComponents() != 1 || image->GetScalarSize() != header.sample_bytes)
    return bad(path,
               fmt::format("cannot be read: {}",
                           errors.first().empty() ? "header and voxels disagree" : errors.first()));
  core::Result<Counts> counts = bad(path, "its kind of number is not known");
  const std::size_t voxels = header.geometry.voxel_count();
  switch (image->GetScalarType()) {
    vtkTemplateMacro(
        counts = counts_of(std::span(static_cast<const VTK_TT*>(image->GetScalarPointer()), voxels),
                           header.scale, header.offset));
  }
  if (!counts) return bad(path, counts.error().what);
  if (reader->GetQFac() < 0) reverse_slices(*counts, header.geometry.dims);
  return counts;
}

}  // namespace

core::Result<Imported> read_nifti(const fs::path& path, const core::Progress& progress) {
  const auto first = TRY(first_bytes(path, kHeaderBytes));
  auto header = TRY(parse_nifti(first, path));
  TRY(check_size(header, path, progress));
  auto voxels = TRY(read_voxels(header, path));
  Imported out{{header.geometry, voxels.slope, voxels.intercept, std::move(voxels.counts)},
               "NIfTI",
               path.filename().string(),
               std::move(header.notes)};
  if (!voxels.note.empty()) out.notes.push_back(voxels.note);
  return out;
}

}  // namespace volume_io
}  // namespace tractus
