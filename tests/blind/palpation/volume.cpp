#include "palpation/volume.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "support/angle.hpp"

namespace blind {
namespace {

constexpr double kVoxel_m = 5e-4;
constexpr int kSide = 96;

Volume empty_cube() {
  Volume v;
  v.size = {kSide, kSide, kSide};
  v.spacing_m = Vec3::Constant(kVoxel_m);
  v.hu.assign(static_cast<std::size_t>(kSide) * kSide * kSide, 0.0);
  return v;
}

/// Smooth noise of unit variance: a few dozen plane waves.
class Texture {
 public:
  Texture(Random& random, double shortest_m, double longest_m) {
    for (Wave& w : waves_) {
      const Vec3 way(random.normal(), random.normal(), random.normal());
      w.number = kTwoPi / random.log_uniform(shortest_m, longest_m) * way.normalized();
      w.phase = random.uniform(0, kTwoPi);
    }
  }
  double at(const Vec3& p) const {
    double sum = 0;
    for (const Wave& w : waves_) sum += std::cos(w.number.dot(p) + w.phase);
    return sum * std::sqrt(2.0 / kWaves);
  }

 private:
  static constexpr int kWaves = 24;
  struct Wave {
    Vec3 number;
    double phase;
  };
  std::array<Wave, kWaves> waves_;
};

void for_each_voxel(Volume& v, const auto& visit) {
  for (int z = 0; z < v.size[2]; ++z)
    for (int y = 0; y < v.size[1]; ++y)
      for (int x = 0; x < v.size[0]; ++x) {
        const Vec3 p = v.origin_m + Vec3(x, y, z).cwiseProduct(v.spacing_m);
        visit(v.hu[v.index(x, y, z)], p);
      }
}

/// 0 well below zero, 1 well above, linear over a voxel: the share of a voxel on the positive side.
double share(double distance_m) { return std::clamp(0.5 + distance_m / kVoxel_m, 0.0, 1.0); }

}  // namespace

Vec3 Volume::centre_m() const {
  return origin_m + 0.5 * Vec3(size[0] - 1, size[1] - 1, size[2] - 1).cwiseProduct(spacing_m);
}

double Tract::radius_at(double depth, double angle) const {
  const double bulge = wall[0] * std::cos(2 * angle + wall[1]) +
                       wall[2] * std::cos(3 * angle + wall[3]) +
                       wall[4] * std::sin(kTwoPi * depth / 0.007 + wall[5]);
  return radius_m * (1.0 + bulge);
}

Volume bone_block(Random& random) {
  Volume v = empty_cube();
  v.origin_m =
      Vec3(random.uniform(-0.05, 0.02), random.uniform(-0.05, 0.02), random.uniform(-0.3, 0.3));
  const Vec3 centre = v.centre_m();
  const Vec3 half(random.uniform(0.019, 0.022), random.uniform(0.019, 0.022),
                  random.uniform(0.019, 0.022));
  const double shell_m = random.uniform(1.0e-3, 2.2e-3), cortex = random.uniform(850, 1300);
  const double spongy = random.uniform(350, 600), rough = random.uniform(40, 110);
  const Texture coarse(random, 2.5e-3, 1e-2), fine(random, 1.2e-3, 3e-3);
  for_each_voxel(v, [&](double& hu, const Vec3& p) {
    const Vec3 q = (p - centre).cwiseQuotient(half);
    const double norm = std::pow(
        std::pow(std::abs(q[0]), 6) + std::pow(std::abs(q[1]), 6) + std::pow(std::abs(q[2]), 6),
        1.0 / 6);
    const double inward = (1.0 - norm) * half.minCoeff();
    const double inner = spongy + rough * (0.7 * coarse.at(p) + 0.5 * fine.at(p));
    const double bone =
        share(shell_m - inward) * (cortex + 60 * coarse.at(p)) + share(inward - shell_m) * inner;
    hu = 40 + share(inward) * (bone - 40);
  });
  return v;
}

Tract draw_tract(Random& random, const Volume& volume) {
  Tract t;
  t.along = Vec3(random.normal(), random.normal(), 0.5 * random.normal()).normalized();
  t.across = t.along.unitOrthogonal();
  t.up = t.along.cross(t.across);
  t.depth_m = random.uniform(0.026, 0.034);
  t.radius_m = random.uniform(1.7e-3, 2.4e-3);
  t.entry_m = volume.centre_m() - (0.55 * t.depth_m) * t.along;
  t.wall = {random.uniform(0.02, 0.1), random.uniform(0, kTwoPi),  random.uniform(0.01, 0.06),
            random.uniform(0, kTwoPi), random.uniform(0.01, 0.07), random.uniform(0, kTwoPi)};
  return t;
}

void carve(Volume& volume, const Tract& tract, double inside_hu, double rim_hu) {
  constexpr double kRim_m = 8e-4;
  for_each_voxel(volume, [&](double& hu, const Vec3& p) {
    const Vec3 d = p - tract.entry_m;
    const double depth = d.dot(tract.along);
    const double a = d.dot(tract.across), b = d.dot(tract.up);
    const double free = std::max(std::hypot(a, b) - tract.radius_at(depth, std::atan2(b, a)),
                                 depth - tract.depth_m);
    const double bone = std::clamp((hu - 40) / 200.0, 0.0, 1.0);  // a rim only where there was bone
    if (rim_hu > 0) hu += bone * rim_hu * std::exp(-0.5 * free * free / (kRim_m * kRim_m));
    hu = inside_hu + share(free) * (hu - inside_hu);
  });
}

bool write_nrrd(const Volume& v, const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::binary);
  const Vec3 mm = 1e3 * v.spacing_m, origin = 1e3 * v.origin_m;
  out.precision(17);
  out << "NRRD0004\n# simulated tract\ntype: short\ndimension: 3\nspace: "
         "left-posterior-superior\nsizes: "
      << v.size[0] << ' ' << v.size[1] << ' ' << v.size[2] << "\nspace directions: (" << mm[0]
      << ",0,0) (0," << mm[1] << ",0) (0,0," << mm[2]
      << ")\nkinds: domain domain domain\nendian: little\nencoding: raw\nspace origin: ("
      << origin[0] << ',' << origin[1] << ',' << origin[2] << ")\n\n";
  for (const double hu : v.hu) {
    const auto value = static_cast<std::int16_t>(std::lround(hu));
    const char bytes[2] = {static_cast<char>(value & 0xFF), static_cast<char>((value >> 8) & 0xFF)};
    out.write(bytes, 2);
  }
  return static_cast<bool>(out.flush());
}

}  // namespace blind
