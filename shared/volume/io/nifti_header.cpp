#include "volume/io/nifti_header.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <optional>

#include "core/try.hpp"
#include "volume/io/claims.hpp"
#include "volume/io/formats.hpp"
#include "volume/volume_file.hpp"

namespace tractus {
namespace volume_io {
namespace fs = std::filesystem;
using volume::Mat3;
using volume::Vec3;
namespace {

constexpr std::size_t kSizeV1 = 348, kSizeV2 = 540;

/// Reads numbers of either byte order.
class Field {
 public:
  Field(core::ByteView bytes, bool swapped) : bytes_(bytes), swapped_(swapped) {}
  template <class T>
  double at(std::size_t offset) const {
    return static_cast<double>(raw<T>(offset));
  }
  template <class T>
  T raw(std::size_t offset) const {
    std::array<std::byte, sizeof(T)> part{};
    for (std::size_t b = 0; b < sizeof(T); ++b)
      part[b] = bytes_[offset + (swapped_ ? sizeof(T) - 1 - b : b)];
    T value{};
    std::memcpy(&value, part.data(), sizeof(T));
    return value;
  }

 private:
  core::ByteView bytes_;
  bool swapped_;
};

/// The fields of both versions in one shape.
struct Raw {
  std::array<std::int64_t, 8> dim{};
  std::array<double, 8> pixdim{};
  int datatype = 0, units = 0, qform = 0, sform = 0;
  double vox_offset = 0, slope = 0, inter = 0;
  std::array<double, 3> quat{}, qoffset{};
  std::array<std::array<double, 4>, 3> srow{};
  bool single_file = false;
  int version = 1;
};

Raw raw_v1(core::ByteView b, const Field& f) {
  Raw r;
  for (std::size_t i = 0; i < 8; ++i) {
    r.dim[i] = f.raw<std::int16_t>(40 + 2 * i);
    r.pixdim[i] = f.at<float>(76 + 4 * i);
  }
  r.datatype = f.raw<std::int16_t>(70);
  r.vox_offset = f.at<float>(108);
  r.slope = f.at<float>(112);
  r.inter = f.at<float>(116);
  r.units = std::to_integer<int>(b[123]);
  r.qform = f.raw<std::int16_t>(252);
  r.sform = f.raw<std::int16_t>(254);
  for (std::size_t i = 0; i < 3; ++i) {
    r.quat[i] = f.at<float>(256 + 4 * i);
    r.qoffset[i] = f.at<float>(268 + 4 * i);
    for (std::size_t j = 0; j < 4; ++j) r.srow[i][j] = f.at<float>(280 + 16 * i + 4 * j);
  }
  r.single_file = core::text_of(b.subspan(344, 3)) == "n+1";
  return r;
}

Raw raw_v2(core::ByteView b, const Field& f) {
  Raw r;
  for (std::size_t i = 0; i < 8; ++i) {
    r.dim[i] = f.raw<std::int64_t>(16 + 8 * i);
    r.pixdim[i] = f.at<double>(104 + 8 * i);
  }
  r.datatype = f.raw<std::int16_t>(12);
  r.vox_offset = f.at<std::int64_t>(168);
  r.slope = f.at<double>(176);
  r.inter = f.at<double>(184);
  r.units = f.raw<std::int32_t>(500);
  r.qform = f.raw<std::int32_t>(344);
  r.sform = f.raw<std::int32_t>(348);
  for (std::size_t i = 0; i < 3; ++i) {
    r.quat[i] = f.at<double>(352 + 8 * i);
    r.qoffset[i] = f.at<double>(376 + 8 * i);
    for (std::size_t j = 0; j < 4; ++j) r.srow[i][j] = f.at<double>(400 + 32 * i + 8 * j);
  }
  r.single_file = core::text_of(b.subspan(4, 3)) == "n+2";
  r.version = 2;
  return r;
}

struct Opening {
  int version;
  bool swapped;
};

std::optional<Opening> opening(core::ByteView first) {
  for (const bool swapped : {false, true}) {
    if (first.size() < 4) return {};
    const auto size = Field(first, swapped).raw<std::int32_t>(0);
    if (size == std::int32_t{kSizeV1} && first.size() >= kSizeV1) {
      const auto magic = core::text_of(first.subspan(344, 3));
      if (magic == "n+1" || magic == "ni1") return Opening{1, swapped};
    }
    if (size == std::int32_t{kSizeV2} && first.size() >= kSizeV2) {
      const auto magic = core::text_of(first.subspan(4, 3));
      if (magic == "n+2" || magic == "ni2") return Opening{2, swapped};
    }
  }
  return {};
}

/// Bytes of a sample, 0 for kinds that are no CT (colours, complex numbers, bits).
int bytes_of_type(int datatype) {
  switch (datatype) {
    case 2:
    case 256:
      return 1;
    case 4:
    case 512:
      return 2;
    case 8:
    case 768:
    case 16:
      return 4;
    case 64:
    case 1024:
    case 1280:
      return 8;
    default:
      return 0;
  }
}

/// Columns: step of i, j, k in RAS, in the file's unit; method 2 of nifti1.h.
Mat3 qform_steps(const Raw& r) {
  Vec3 v(r.quat[0], r.quat[1], r.quat[2]);
  double a = 1.0 - v.squaredNorm();
  if (a < 1e-7) {
    v.normalize();
    a = 0.0;
  } else {
    a = std::sqrt(a);
  }
  const double qfac = r.pixdim[0] < 0.0 ? -1.0 : 1.0;
  return Eigen::Quaterniond(a, v.x(), v.y(), v.z()).toRotationMatrix() *
         Vec3(r.pixdim[1], r.pixdim[2], qfac * r.pixdim[3]).asDiagonal();
}

/// The same; method 3 of nifti1.h.
Mat3 sform_steps(const Raw& r) {
  Mat3 m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      m(i, j) = r.srow[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  return m;
}

double unit_m(const Raw& r, std::vector<std::string>& notes) {
  switch (r.units & 7) {
    case 1:
      return 1.0;
    case 2:
      return 1e-3;
    case 3:
      return 1e-6;
    default:
      notes.push_back("the header names no unit of length; millimetres were assumed");
      return 1e-3;
  }
}

core::Result<void> place(NiftiHeader& out, const Raw& r, const fs::path& path) {
  const double unit = unit_m(r, out.notes);
  if (r.sform <= 0 && r.qform <= 0)
    return bad(path,
               "sform_code and qform_code are 0: nothing says how the volume lies in the patient");
  const bool by_sform = r.sform > 0;
  const Mat3 steps = by_sform ? sform_steps(r) : qform_steps(r);
  const Vec3 origin = by_sform ? Vec3(r.srow[0][3], r.srow[1][3], r.srow[2][3])
                               : Vec3(r.qoffset[0], r.qoffset[1], r.qoffset[2]);
  const char* name = by_sform ? "sform" : "qform and pixdim";
  const Vec3 spacing = steps.colwise().norm();
  if (!steps.allFinite() || !origin.allFinite() || !(spacing.minCoeff() > 0.0))
    return bad(
        path, fmt::format(
                  "{}: spacing {} × {} × {}, origin {}, {}, {}; finite numbers and spacings "
                  "greater than 0 are expected",
                  name, spacing.x(), spacing.y(), spacing.z(), origin.x(), origin.y(), origin.z()));
  if (by_sform && r.qform > 0 && !((qform_steps(r) - steps).norm() < 1e-2 * spacing.norm()))
    out.notes.push_back("sform and qform disagree; the sform was taken");
  const Vec3 lps(-1, -1, 1);  // NIfTI is RAS
  out.geometry.spacing_m = spacing * unit;
  out.geometry.origin_m = lps.cwiseProduct(origin) * unit;
  const Mat3 directions = lps.asDiagonal() * steps * spacing.cwiseInverse().asDiagonal();
  auto axes = TRY(straightened(directions, path, name));
  out.geometry.directions = axes;
  return volume::check_geometry(out.geometry, path.string() + ": " + name);
}

core::Result<void> scaling(NiftiHeader& out, const Raw& r, const fs::path& path) {
  if (!std::isfinite(r.slope) || !std::isfinite(r.inter))
    return bad(path, fmt::format("scl_slope {} and scl_inter {}: finite numbers are expected",
                                 r.slope, r.inter));
  if (r.slope != 0.0) {  // 0: the values stand as they are, says nifti1.h
    out.scale = r.slope;
    out.offset = r.inter;
  }
  return {};
}

}  // namespace

bool looks_like_nifti(core::ByteView first) { return opening(first).has_value(); }

core::Result<NiftiHeader> parse_nifti(core::ByteView first, const fs::path& path) {
  const auto open = opening(first);
  if (!open) return bad(path, "no NIfTI header at its start");
  const Field field(first, open->swapped);
  const Raw r = open->version == 1 ? raw_v1(first, field) : raw_v2(first, field);
  const std::size_t header_bytes = open->version == 1 ? kSizeV1 : kSizeV2;
  if (!r.single_file)
    return bad(path, "a header with its voxels in another file (.hdr/.img); give a single .nii");
  if (r.dim[0] < 3 || r.dim[0] > 7)
    return bad(path, fmt::format("dim[0]: {} dimensions, 3 are expected", r.dim[0]));
  for (std::size_t i = 4; i <= static_cast<std::size_t>(r.dim[0]); ++i)
    if (r.dim[i] != 1)
      return bad(path, fmt::format("dim[{}] is {}: one volume is expected, not a series of them", i,
                                   r.dim[i]));
  auto dims = TRY(checked_dims({r.dim[1], r.dim[2], r.dim[3]}, path, "dim"));
  NiftiHeader out;
  out.geometry.dims = dims;
  out.sample_bytes = bytes_of_type(r.datatype);
  if (out.sample_bytes == 0)
    return bad(path, fmt::format("datatype {}: not one number per voxel, as a CT has", r.datatype));
  if (!(r.vox_offset >= static_cast<double>(header_bytes) && r.vox_offset <= 1e8 &&
        r.vox_offset == std::trunc(r.vox_offset)))
    return bad(path, fmt::format("vox_offset {}: a whole number of at least {} is expected",
                                 r.vox_offset, header_bytes));
  out.data_at = static_cast<std::uint64_t>(r.vox_offset);
  TRY(scaling(out, r, path));
  TRY(place(out, r, path));
  return out;
}

}  // namespace volume_io
}  // namespace tractus
