#include <fmt/format.h>
#include <vtkDICOMReader.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkStringArray.h>

#include <numbers>

#include "volume/io/claims.hpp"
#include "volume/io/counts.hpp"
#include "volume/io/dicom_slices.hpp"
#include "volume/io/formats.hpp"
#include "volume/io/isolated.hpp"
#include "volume/io/upright.hpp"
#include "volume/io/vtk_quiet.hpp"

namespace volume_io {
namespace fs = std::filesystem;
namespace {

/// Decodes the slices in our order; stored numbers, or CT values where slices are scaled
/// differently.
core::Result<Counts> read_voxels(const Series& series, const fs::path& folder) {
  vtkNew<vtkStringArray> names;
  for (const Slice& slice : series.slices) names->InsertNextValue(slice.path.c_str());
  vtkNew<vtkDICOMReader> reader;
  const VtkErrors errors(reader);
  reader->SetFileNames(names);
  reader->SortingOff();
  reader->SetMemoryRowOrderToFileNative();
  reader->SetAutoRescale(series.same_scaling ? 0 : 1);
  try {
    reader->Update();
  } catch (const std::exception& failure) {
    return bad(folder, fmt::format("cannot be decoded: {}", printable(failure.what())));
  }
  vtkImageData* image = reader->GetOutput();
  std::array<int, 3> dims{};
  image->GetDimensions(dims.data());
  if (!errors.first().empty() || reader->GetErrorCode() != 0 || dims != series.geometry.dims ||
      image->GetNumberOfScalarComponents() != 1)
    return bad(folder,
               fmt::format("cannot be decoded: {}",
                           errors.first().empty() ? "slices and pixels disagree" : errors.first()));
  const Slice& a = series.slices.front();
  const double scale = series.same_scaling ? a.slope : 1.0,
               offset = series.same_scaling ? a.intercept : 0.0;
  core::Result<Counts> counts = bad(folder, "its kind of number is not known");
  const std::size_t voxels = series.geometry.voxel_count();
  switch (image->GetScalarType()) {
    vtkTemplateMacro(
        counts = counts_of(std::span(static_cast<const VTK_TT*>(image->GetScalarPointer()), voxels),
                           scale, offset));
  }
  if (!counts) return bad(folder, counts.error().what);
  return counts;
}

core::Result<Imported> read_series(const fs::path& folder, const core::Progress& progress) {
  auto series = scan_series(folder, progress);
  if (!series) return series.error();
  auto voxels = read_voxels(*series, folder);
  if (!voxels) return voxels.error();
  Imported out{{series->geometry, voxels->slope, voxels->intercept, std::move(voxels->counts)},
               "DICOM",
               fmt::format("DICOM series of {} {} slices", series->slices.size(),
                           printable(series->slices.front().modality)),
               std::move(series->notes)};
  if (!voxels->note.empty()) out.notes.push_back(voxels->note);
  if (series->tilt_rad == 0.0) return out;
  auto straight = upright(out.volume, series->shear_m, folder.string());
  if (!straight) return straight.error();
  out.volume = std::move(*straight);
  out.notes.push_back(
      fmt::format("the gantry was tilted by {:.2f}°: slices were shifted back within their planes",
                  series->tilt_rad * 180.0 / std::numbers::pi));
  return out;
}

}  // namespace

core::Result<Imported> read_dicom(const fs::path& folder, const core::Progress& progress) {
  return isolated(
      folder, [&](const core::Progress& passed_on) { return read_series(folder, passed_on); },
      progress);
}

}  // namespace volume_io
