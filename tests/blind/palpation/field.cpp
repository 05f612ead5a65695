#include "palpation/field.hpp"

#include <algorithm>
#include <cmath>

namespace blind {
namespace {

double opacity_of(double hu, const Transfer& transfer) {
  if (hu <= transfer.front().first) return transfer.front().second;
  for (std::size_t i = 1; i < transfer.size(); ++i) {
    const auto& [x1, y1] = transfer[i];
    const auto& [x0, y0] = transfer[i - 1];
    if (hu <= x1) return y0 + (y1 - y0) * (hu - x0) / (x1 - x0);
  }
  return transfer.back().second;
}

int repeated(int i, int count) { return std::min(std::max(i, 0), count - 1); }

/// Cubic through four neighbours with tangents of half their differences; and its derivative.
void catmull_rom(double f, std::array<double, 4>& w, std::array<double, 4>& d) {
  w = {0.5 * f * (-1 + f * (2 - f)), 0.5 * (2 + f * f * (-5 + 3 * f)),
       0.5 * f * (1 + f * (4 - 3 * f)), 0.5 * f * f * (f - 1)};
  d = {0.5 * (-1 + f * (4 - 3 * f)), 0.5 * f * (-10 + 9 * f), 0.5 * (1 + f * (8 - 9 * f)),
       0.5 * f * (3 * f - 2)};
}

}  // namespace

Field::Field(const Volume& volume, const Transfer& transfer, FieldKind kind)
    : volume_(volume), kind_(kind) {
  for (double& hu : volume_.hu)
    hu = static_cast<double>(std::lround(hu));  // as the file will hold it
  for (const double hu : volume_.hu) opacity_.push_back(opacity_of(hu, transfer));
  for (int axis = 0; axis < 3; ++axis) blur(axis);
  differentiate();
}

void Field::blur(int axis) {
  constexpr int kReach = 7;
  std::array<double, 2 * kReach + 1> kernel{};
  double sum = 0;
  for (int k = -kReach; k <= kReach; ++k)
    sum += kernel[static_cast<std::size_t>(k + kReach)] = std::exp(-0.5 * k * k);
  std::vector<double> out(opacity_.size());
  std::array<int, 3> at{};
  for (at[2] = 0; at[2] < volume_.size[2]; ++at[2])
    for (at[1] = 0; at[1] < volume_.size[1]; ++at[1])
      for (at[0] = 0; at[0] < volume_.size[0]; ++at[0]) {
        double value = 0;
        for (int k = -kReach; k <= kReach; ++k) {
          auto from = at;
          auto& moved = from[static_cast<std::size_t>(axis)];
          moved = repeated(moved + k, volume_.size[static_cast<std::size_t>(axis)]);
          value += kernel[static_cast<std::size_t>(k + kReach)] *
                   opacity_[volume_.index(from[0], from[1], from[2])];
        }
        out[volume_.index(at[0], at[1], at[2])] = value / sum;
      }
  opacity_ = std::move(out);
}

void Field::differentiate() {
  for (auto& f : force_) f.resize(opacity_.size());
  const auto value = [&](int x, int y, int z) {
    return opacity_[volume_.index(repeated(x, volume_.size[0]), repeated(y, volume_.size[1]),
                                  repeated(z, volume_.size[2]))];
  };
  for (int z = 0; z < volume_.size[2]; ++z)
    for (int y = 0; y < volume_.size[1]; ++y)
      for (int x = 0; x < volume_.size[0]; ++x) {
        const std::size_t i = volume_.index(x, y, z);
        force_[0][i] = (value(x - 1, y, z) - value(x + 1, y, z)) / (2 * volume_.spacing_m[0]);
        force_[1][i] = (value(x, y - 1, z) - value(x, y + 1, z)) / (2 * volume_.spacing_m[1]);
        force_[2][i] = (value(x, y, z - 1) - value(x, y, z + 1)) / (2 * volume_.spacing_m[2]);
      }
}

Field::Taps Field::taps(const Vec3& p_m) const {
  Taps out;
  const Vec3 v = (p_m - volume_.origin_m).cwiseQuotient(volume_.spacing_m);
  std::array<std::array<std::size_t, 4>, 3> index{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double place = std::clamp(v[static_cast<Eigen::Index>(a)], -8.0, volume_.size[a] + 8.0);
    const double floor = std::floor(place);
    catmull_rom(place - floor, out.weight[a], out.slope[a]);
    for (int k = 0; k < 4; ++k)
      index[a][static_cast<std::size_t>(k)] =
          static_cast<std::size_t>(repeated(static_cast<int>(floor) - 1 + k, volume_.size[a]));
  }
  const auto nx = static_cast<std::size_t>(volume_.size[0]),
             ny = static_cast<std::size_t>(volume_.size[1]);
  out.x = index[0];
  for (std::size_t k = 0; k < 4; ++k) {
    out.y[k] = index[1][k] * nx;
    out.z[k] = index[2][k] * nx * ny;
  }
  return out;
}

Vec3 Field::at(const Vec3& p_m) const {
  const Taps t = taps(p_m);
  Vec3 sum(0, 0, 0);
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t at = t.z[k] + t.y[j] + t.x[i];
        if (kind_ == FieldKind::kPaper) {
          const double w = t.weight[0][i] * t.weight[1][j] * t.weight[2][k];
          sum += w * Vec3(force_[0][at], force_[1][at], force_[2][at]);
        } else {
          const double o = opacity_[at];
          sum -= o * Vec3(t.slope[0][i] * t.weight[1][j] * t.weight[2][k],
                          t.weight[0][i] * t.slope[1][j] * t.weight[2][k],
                          t.weight[0][i] * t.weight[1][j] * t.slope[2][k]);
        }
      }
  return kind_ == FieldKind::kPaper ? sum : Vec3(sum.cwiseQuotient(volume_.spacing_m));
}

double Field::opacity(const Vec3& p_m) const {
  const Taps t = taps(p_m);
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t i = 0; i < 4; ++i)
        sum +=
            t.weight[0][i] * t.weight[1][j] * t.weight[2][k] * opacity_[t.z[k] + t.y[j] + t.x[i]];
  return sum;
}

double Field::density(const Vec3& p_m) const {
  const Vec3 v = (p_m - volume_.origin_m).cwiseQuotient(volume_.spacing_m);
  double sum = 0;
  for (int k = 0; k < 8; ++k) {
    std::array<int, 3> at{};
    double weight = 1;
    for (int a = 0; a < 3; ++a) {
      const double floor = std::floor(v[a]), f = v[a] - floor;
      const int up = (k >> a) & 1;
      weight *= up ? f : 1 - f;
      at[static_cast<std::size_t>(a)] =
          repeated(static_cast<int>(floor) + up, volume_.size[static_cast<std::size_t>(a)]);
    }
    sum += weight * volume_.hu[volume_.index(at[0], at[1], at[2])];
  }
  return sum;
}

}  // namespace blind
