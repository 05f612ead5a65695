#include "volume/io/dicom_slices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/try.hpp"
#include "volume/io/claims.hpp"
#include "volume/io/dicom_tags.hpp"
#include "volume/volume_file.hpp"

namespace tractus {
namespace volume_io {
namespace fs = std::filesystem;
using volume::Vec3;
namespace {

constexpr double kSamePlace_m = 1e-5;
constexpr double kEven = 0.01;                                    // of a slice spacing
constexpr double kUpright_rad = 0.01 * std::numbers::pi / 180.0;  // below this a tilt is rounding
constexpr double kMaxTilt_rad = 45.0 * std::numbers::pi / 180.0;

}  // namespace

core::Error too_many_slices(const fs::path& path) {
  return {core::Errc::too_large, fmt::format("{}: over {} DICOM slices, at most so many are taken",
                                             path.string(), kMostSlices)};
}

core::Result<Listing> list_series(const fs::path& folder) {
  Listing out;
  std::error_code failure;
  for (fs::directory_iterator it(folder, failure), end; !failure && it != end;
       it.increment(failure)) {
    std::error_code ignored;
    const bool image = it->is_regular_file(ignored) && it->path().filename() != "DICOMDIR" &&
                       is_dicom_file(it->path());
    if (image)
      out.files.push_back(it->path());
    else
      ++out.others;
    if (out.files.size() > kMostSlices) return too_many_slices(folder);
  }
  if (failure)
    return core::Error{core::Errc::io,
                       fmt::format("{}: cannot list: {}", folder.string(), failure.message())};
  if (out.files.empty()) return bad(folder, "no DICOM file in this folder");
  std::ranges::sort(out.files);
  return out;
}

namespace {

core::Error differ(const Slice& a, const Slice& b, const std::string& what) {
  return bad(b.path, fmt::format("{} than {}: the slices of one series are expected", what,
                                 a.path.filename().string()));
}

/// Every slice against the first.
core::Result<void> check_alike(const std::vector<Slice>& slices) {
  const Slice& a = slices.front();
  for (const Slice& b : slices) {
    if (b.series != a.series) return differ(a, b, "belongs to another series");
    if (b.rows != a.rows || b.columns != a.columns)
      return differ(a, b, fmt::format("has {} × {} pixels, others", b.rows, b.columns));
    if (b.bits != a.bits || b.is_signed != a.is_signed) return differ(a, b, "holds other numbers");
    if ((b.along_row - a.along_row).norm() > 1e-4 ||
        (b.along_column - a.along_column).norm() > 1e-4)
      return differ(a, b, "has another orientation");
    if (std::abs(b.row_step_m - a.row_step_m) > 1e-7 ||
        std::abs(b.column_step_m - a.column_step_m) > 1e-7)
      return differ(a, b, "has another pixel spacing");
  }
  return {};
}

/// Sorts along the normal and finds the one step from slice to slice, or the place where it is
/// another.
core::Result<Vec3> even_step(std::vector<Slice>& slices, const Vec3& normal,
                             const fs::path& folder) {
  std::ranges::sort(slices, {}, [&](const Slice& s) { return s.position_m.dot(normal); });
  if (slices.size() < 2)
    return bad(folder, "one slice alone: give the folder that holds the series");
  std::vector<double> gaps;
  for (std::size_t i = 1; i < slices.size(); ++i)
    gaps.push_back((slices[i].position_m - slices[i - 1].position_m).dot(normal));
  std::vector<double> sorted = gaps;
  std::ranges::nth_element(sorted, sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2));
  const double usual = sorted[sorted.size() / 2];
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const std::string pair = fmt::format("{} and {}", slices[i].path.filename().string(),
                                         slices[i + 1].path.filename().string());
    if (gaps[i] < kSamePlace_m) return bad(folder, pair + " lie in the same place");
    if (std::abs(gaps[i] - usual) > std::max(kEven * usual, kSamePlace_m))
      return bad(
          folder,
          fmt::format(
              "{} lie {:.4g} mm apart, the others {:.4g} mm: a slice is missing or the spacing is "
              "uneven",
              pair, gaps[i] * 1e3, usual * 1e3));
  }
  const Vec3 step = (slices.back().position_m - slices.front().position_m) /
                    static_cast<double>(slices.size() - 1);
  for (std::size_t i = 0; i < slices.size(); ++i)
    if ((slices[i].position_m - slices.front().position_m - static_cast<double>(i) * step).norm() >
        kEven * usual + kSamePlace_m)
      return bad(slices[i].path, "lies beside the line on which the other slices are stacked");
  return step;
}

core::Result<void> place(Series& series, const fs::path& folder) {
  const Slice& a = series.slices.front();
  volume::Mat3 columns;
  columns << a.along_row, a.along_column, a.along_row.cross(a.along_column);
  auto axes = TRY(straightened(columns, a.path, "image orientation"));
  const Vec3 normal = axes.col(2);
  const auto step = TRY(even_step(series.slices, normal, folder));
  series.tilt_rad = std::acos(std::clamp(step.normalized().dot(normal), -1.0, 1.0));
  if (series.tilt_rad > kMaxTilt_rad)
    return bad(folder,
               fmt::format("slices are stacked {:.1f}° off their normal, at most 45° are taken",
                           series.tilt_rad * 180.0 / std::numbers::pi));
  if (series.tilt_rad < kUpright_rad) series.tilt_rad = 0.0;
  series.shear_m =
      series.tilt_rad > 0.0 ? Vec3(step - step.dot(normal) * normal) : Vec3(Vec3::Zero());
  volume::Geometry& g = series.geometry;
  const Slice& first = series.slices.front();
  g.dims = {first.columns, first.rows, static_cast<int>(series.slices.size())};
  g.spacing_m = {first.row_step_m, first.column_step_m, step.dot(normal)};
  g.origin_m = first.position_m;
  g.directions = axes;
  TRY(checked_dims({g.dims[0], g.dims[1], g.dims[2]}, folder, "the series"));
  return volume::check_geometry(g, folder.string());
}

void add_notes(Series& series) {
  const Slice& a = series.slices.front();
  for (const Slice& b : series.slices)
    if (b.slope != a.slope || b.intercept != a.intercept) series.same_scaling = false;
  if (!series.same_scaling)
    series.notes.push_back("rescale slope or intercept differ between slices; each got its own");
  if (a.modality != "CT")
    series.notes.push_back(fmt::format("modality is \"{}\", not CT", printable(a.modality)));
  for (const char* lossy : {".4.50", ".4.51", ".4.81", ".4.91"})
    if (a.transfer_syntax.ends_with(lossy))
      series.notes.push_back("compressed by a method that may lose detail (" + a.transfer_syntax +
                             ")");
}

}  // namespace

core::Result<Series> scan_series(const fs::path& folder, const core::Progress& progress) {
  const auto listing = TRY(list_series(folder));
  Series series;
  for (std::size_t i = 0; i < listing.files.size(); ++i) {
    auto slice = TRY(read_slice_tags(listing.files[i]));
    series.slices.push_back(std::move(slice));
    if (progress &&
        !progress(static_cast<double>(i + 1) / static_cast<double>(listing.files.size())))
      return core::Error{core::Errc::cancelled, "reading was stopped"};
  }
  TRY(check_alike(series.slices));
  TRY(place(series, folder));
  add_notes(series);
  return series;
}

}  // namespace volume_io
}  // namespace tractus
