#include "capture/motion.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <fstream>
#include <set>

namespace tractus {
namespace capture {
namespace {
using core::Errc;
using core::Error;
using math::Vec3;

constexpr double kOnALine_m = 1e-3;  // second extent of a shape that tells a turn

struct Pair {
  Vec3 in_body, seen;
};

/// The pose that carries the body's points to the seen ones, and how far off it is, m.
std::pair<math::Pose, double> best_fit(const std::vector<Pair>& pairs) {
  Vec3 centre_b = Vec3::Zero(), centre_c = Vec3::Zero();
  for (const Pair& p : pairs) centre_b += p.in_body, centre_c += p.seen;
  centre_b /= double(pairs.size()), centre_c /= double(pairs.size());
  math::Mat3 covariance = math::Mat3::Zero();
  for (const Pair& p : pairs)
    covariance += (p.seen - centre_c) * (p.in_body - centre_b).transpose();
  const Eigen::JacobiSVD<math::Mat3> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  math::Mat3 keep = math::Mat3::Identity();
  keep(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  const math::Mat3 turn = svd.matrixU() * keep * svd.matrixV().transpose();
  const math::Pose pose{centre_c - turn * centre_b, math::Quat(turn)};
  double sum = 0.0;
  for (const Pair& p : pairs) sum += (pose * p.in_body - p.seen).squaredNorm();
  return {pose, std::sqrt(sum / double(pairs.size()))};
}

/// Do the points span more than a line?
bool spans_a_plane(const std::vector<Vec3>& points) {
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : points) centre += p / double(points.size());
  math::Mat3 spread = math::Mat3::Zero();
  for (const Vec3& p : points) spread += (p - centre) * (p - centre).transpose();
  const Eigen::SelfAdjointEigenSolver<math::Mat3> axes(spread);
  return std::sqrt(axes.eigenvalues()[1]) > kOnALine_m;
}
}  // namespace

core::Result<Motion> read_motion(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return Error{Errc::not_found, fmt::format("{}: cannot be read", path.string())};
  std::string head(256, '\0');
  file.read(head.data(), std::streamsize(head.size()));
  head.resize(std::size_t(file.gcount()));
  if (head.size() > 1 && head[1] == '\x50') return detail::read_c3d(path);
  if (head.starts_with("NO_OF_FRAMES")) return detail::read_qtm(path);
  if (head.find("Format Version") < 4) return detail::read_motive(path);
  if (head.starts_with("t_s") || head.starts_with("\xef\xbb\xbft_s"))
    return detail::read_plain(path);
  return Error{Errc::bad_input,
               fmt::format("{}: not a motion file that is known: a QTM export (.tsv), a Motive "
                           "export (.csv), a C3D file or a CSV with t_s is expected",
                           path.string())};
}

core::Result<BodyTrack> fit_body(const Motion& motion, const BodyShape& shape, double worst_m) {
  std::vector<Vec3> points;
  std::map<double, std::vector<Pair>> frames;
  for (const auto& [name, at] : shape) {
    const auto track = motion.markers.find(name);
    if (track == motion.markers.end())
      return Error{Errc::bad_input, fmt::format("marker '{}' is not in the motion", name)};
    points.push_back(at);
    for (std::size_t k = 0; k < track->second.t_s.size(); ++k)
      frames[track->second.t_s[k]].push_back({at, track->second.p_C_m[k]});
  }
  if (points.size() < 3 || !spans_a_plane(points))
    return Error{Errc::bad_input, "a body needs three markers that are not on a line"};
  BodyTrack out;
  for (const auto& [t_s, pairs] : frames) {
    if (pairs.size() < 3) continue;
    std::vector<Vec3> seen;
    for (const Pair& p : pairs) seen.push_back(p.in_body);
    if (!spans_a_plane(seen)) continue;
    const auto [pose, off_m] = best_fit(pairs);
    if (off_m > worst_m) continue;
    out.t_s.push_back(t_s);
    out.X_CB.push_back(pose);
  }
  if (out.t_s.empty())
    return Error{Errc::bad_input,
                 fmt::format("no frame shows three markers of the body where its shape says they "
                             "are (within {:.1f} mm)",
                             1e3 * worst_m)};
  return out;
}

}  // namespace capture
}  // namespace tractus
