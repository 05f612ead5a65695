#include <fmt/format.h>
#include <vtkDICOMReader.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkStringArray.h>

#include <fstream>
#include <numbers>

#include "core/file.hpp"
#include "core/try.hpp"
#include "volume/io/claims.hpp"
#include "volume/io/counts.hpp"
#include "volume/io/deidentify.hpp"
#include "volume/io/dicom_files.hpp"
#include "volume/io/dicom_series.hpp"
#include "volume/io/dicom_tags.hpp"
#include "volume/io/formats.hpp"
#include "volume/io/gantry_tilt.hpp"
#include "volume/io/isolated.hpp"
#include "volume/io/vtk_quiet.hpp"

namespace tractus {
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

core::Result<void> write_copy(const fs::path& path, core::ByteView bytes) {
  std::ofstream copy(path, std::ios::binary);
  copy.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  copy.close();
  if (!copy) return core::system_error(path, "cannot write");
  return {};
}

/// Copies without the patient, by the same names, one for each slice.
core::Result<void> clean(const Listing& listing, const fs::path& into, Deidentifier& deidentifier,
                         const core::Progress& progress) {
  DicomFiles files;
  std::size_t slices = 0;
  for (std::size_t i = 0; i < listing.files.size(); ++i) {
    const std::string name = listing.files[i].filename().string();
    const auto file = TRY(files.read(listing.files[i]));
    TRY(deidentifier.cleaned(
        file, listing.files[i], [&](std::size_t frame, core::ByteView slice) -> core::Result<void> {
          if (++slices > kMostSlices) return too_many_slices(listing.files[i]);
          return write_copy(into / (frame ? fmt::format("{} frame {:04}", name, frame) : name),
                            slice);
        }));
    if (progress &&
        !progress(0.5 * static_cast<double>(i + 1) / static_cast<double>(listing.files.size())))
      return core::Error{core::Errc::cancelled, "reading was stopped"};
  }
  return {};
}

/// Who gave us a folder knows nothing of our copies: errors name the files that he has.
core::Error with_path_of(const fs::path& folder, const fs::path& copies, core::Error error) {
  const std::string ours = copies.string();
  for (std::size_t at; (at = error.what.find(ours)) != std::string::npos;)
    error.what.replace(at, ours.size(), folder.string());
  return error;
}

core::Result<Imported> read_series(const fs::path& folder, const core::Progress& progress) {
  auto series = TRY(
      scan_series(folder, [&](double share) { return !progress || progress(0.5 + 0.5 * share); }));
  auto voxels = TRY(read_voxels(series, folder));
  Imported out{{series.geometry, voxels.slope, voxels.intercept, std::move(voxels.counts)},
               "DICOM",
               fmt::format("DICOM series of {} {} slices", series.slices.size(),
                           printable(series.slices.front().modality)),
               std::move(series.notes)};
  out.modality = series.slices.front().modality;
  if (!voxels.note.empty()) out.notes.push_back(voxels.note);
  if (series.tilt_rad == 0.0) return out;
  auto straight = TRY(correct_gantry_tilt(out.volume, series.shear_m, folder.string()));
  out.volume = std::move(straight);
  out.notes.push_back(
      fmt::format("the gantry was tilted by {:.2f}°: slices were shifted back within their planes",
                  series.tilt_rad * 180.0 / std::numbers::pi));
  return out;
}

core::Result<Imported> read_cleaned(const fs::path& path, const fs::path& copies,
                                    const ReadOptions& options, const core::Progress& progress) {
  const bool one_file = !fs::is_directory(path);
  const fs::path folder = !one_file ? path : path.has_parent_path() ? path.parent_path() : ".";
  const auto found = one_file ? Listing{.files = {path}} : TRY(list_series(path));
  const auto listing = TRY(chosen_series(found, options.series_uid, path));
  Deidentifier deidentifier(options.uid_key);
  TRY(clean(listing, copies, deidentifier, progress));
  auto out = read_series(copies, progress);
  if (!out) return with_path_of(folder, copies, out.error());
  if (listing.others > 0)
    out->notes.push_back(fmt::format("{} other files in the folder were left out", listing.others));
  if (listing.other_series > 0)
    out->notes.push_back(
        fmt::format("{} files of other series were left out", listing.other_series));
  out->suspicions = deidentifier.suspicions();
  out->report = deidentifier.report();
  return out;
}

}  // namespace

core::Result<Imported> read_dicom(const fs::path& path, const ReadOptions& options) {
  std::error_code failure;
  const fs::path temporary = fs::temp_directory_path(failure);
  if (failure) return core::Error{core::Errc::io, "there is no folder for temporary files"};
  auto copies = TRY(core::ScratchFolder::make(temporary / "tractus-dicom"));
  return isolated(
      path,
      [&](const core::Progress& passed_on) {
        return read_cleaned(path, copies.path(), options, passed_on);
      },
      options.progress);
}

}  // namespace volume_io
}  // namespace tractus
