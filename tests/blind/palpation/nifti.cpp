/// A real scan from a NIfTI-1 file, read by hand: header, 16-bit voxels, then a cube about the
/// bone.
#include <zlib.h>

#include <cmath>
#include <cstring>

#include "palpation/volume.hpp"

namespace blind {
namespace {

struct Scan {
  std::array<int, 3> size{};
  Vec3 spacing_m{0, 0, 0};
  std::vector<std::int16_t> hu;
  double at(int x, int y, int z) const {
    x = std::min(std::max(x, 0), size[0] - 1);
    y = std::min(std::max(y, 0), size[1] - 1);
    z = std::min(std::max(z, 0), size[2] - 1);
    return hu[(static_cast<std::size_t>(z) * static_cast<std::size_t>(size[1]) +
               static_cast<std::size_t>(y)) *
                  static_cast<std::size_t>(size[0]) +
              static_cast<std::size_t>(x)];
  }
};

template <class T>
T field(const std::array<char, 352>& header, std::size_t at) {
  T value;
  std::memcpy(&value, header.data() + at, sizeof value);
  return value;
}

std::optional<Scan> read(gzFile file) {
  std::array<char, 352> header{};
  if (gzread(file, header.data(), 352) != 352) return std::nullopt;
  constexpr std::int16_t kInt16 = 4;
  if (field<std::int32_t>(header, 0) != 348 || field<std::int16_t>(header, 70) != kInt16)
    return std::nullopt;
  Scan scan;
  for (std::size_t a = 0; a < 3; ++a) {
    scan.size[a] = field<std::int16_t>(header, 42 + 2 * a);
    scan.spacing_m[static_cast<Eigen::Index>(a)] = 1e-3 * field<float>(header, 80 + 4 * a);
    if (scan.size[a] < 8 || scan.size[a] > 1024) return std::nullopt;
  }
  scan.hu.resize(static_cast<std::size_t>(scan.size[0]) * static_cast<std::size_t>(scan.size[1]) *
                 static_cast<std::size_t>(scan.size[2]));
  const auto bytes = static_cast<unsigned>(scan.hu.size() * sizeof(std::int16_t));
  if (gzread(file, scan.hu.data(), bytes) != static_cast<int>(bytes)) return std::nullopt;
  return scan;
}

/// Mean place, in voxels, of what is as dense as spongy bone.
Vec3 bone_centre(const Scan& scan) {
  Vec3 sum(0, 0, 0);
  double count = 0;
  for (int z = 0; z < scan.size[2]; ++z)
    for (int y = 0; y < scan.size[1]; ++y)
      for (int x = 0; x < scan.size[0]; ++x)
        if (scan.at(x, y, z) > 150) sum += Vec3(x, y, z), count += 1;
  return count > 0 ? Vec3(sum / count) : Vec3(Vec3(scan.size[0], scan.size[1], scan.size[2]) / 2);
}

double interpolated(const Scan& scan, const Vec3& at) {
  const Vec3 floor = at.array().floor();
  const Vec3 f = at - floor;
  double sum = 0;
  for (int k = 0; k < 8; ++k) {
    const int dx = k & 1, dy = (k >> 1) & 1, dz = k >> 2;
    const double weight = (dx ? f[0] : 1 - f[0]) * (dy ? f[1] : 1 - f[1]) * (dz ? f[2] : 1 - f[2]);
    sum += weight * scan.at(static_cast<int>(floor[0]) + dx, static_cast<int>(floor[1]) + dy,
                            static_cast<int>(floor[2]) + dz);
  }
  return sum;
}

}  // namespace

std::optional<Volume> real_bone(const std::filesystem::path& nifti_gz) {
  gzFile file = gzopen(nifti_gz.c_str(), "rb");
  if (file == nullptr) return std::nullopt;
  const auto scan = read(file);
  gzclose(file);
  if (!scan) return std::nullopt;
  Volume v;
  v.size = {96, 96, 96};
  v.spacing_m = Vec3::Constant(5e-4);
  v.hu.resize(96 * 96 * 96);
  const Vec3 middle = bone_centre(*scan).cwiseProduct(scan->spacing_m);
  v.origin_m = middle - 0.5 * 95 * v.spacing_m;
  for (int z = 0; z < 96; ++z)
    for (int y = 0; y < 96; ++y)
      for (int x = 0; x < 96; ++x) {
        const Vec3 p = v.origin_m + Vec3(x, y, z).cwiseProduct(v.spacing_m);
        v.hu[v.index(x, y, z)] = interpolated(*scan, p.cwiseQuotient(scan->spacing_m));
      }
  return v;
}

}  // namespace blind
