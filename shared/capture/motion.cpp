#include "capture/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "math/rigid_fit.hpp"

namespace tractus {
namespace capture {
namespace {
using core::Errc;
using core::Error;
using math::Vec3;

constexpr double kOnALine_m = 1e-3;  // second extent of a shape that tells a turn

/// What a frame shows of a body's markers, one to one.
struct Seen {
  std::vector<Vec3> p_B_m, p_C_m;
};

bool spans_a_plane(std::span<const Vec3> points_m) {
  return math::extents(points_m)[1] > kOnALine_m;
}

double rms_m(const math::Pose& X_CB, const Seen& seen) {
  double sum_m2 = 0.0;
  for (std::size_t i = 0; i < seen.p_B_m.size(); ++i)
    sum_m2 += (X_CB * seen.p_B_m[i] - seen.p_C_m[i]).squaredNorm();
  return std::sqrt(sum_m2 / double(seen.p_B_m.size()));
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
  std::map<double, Seen> frames;
  for (const auto& [name, at] : shape) {
    const auto track = motion.markers.find(name);
    if (track == motion.markers.end())
      return Error{Errc::bad_input, fmt::format("marker '{}' is not in the motion", name)};
    points.push_back(at);
    for (std::size_t k = 0; k < track->second.t_s.size(); ++k) {
      Seen& frame = frames[track->second.t_s[k]];
      frame.p_B_m.push_back(at);
      frame.p_C_m.push_back(track->second.p_C_m[k]);
    }
  }
  if (points.size() < 3 || !spans_a_plane(points))
    return Error{Errc::bad_input, "a body needs three markers that are not on a line"};
  BodyTrack out;
  for (const auto& [t_s, seen] : frames) {
    if (seen.p_B_m.size() < 3 || !spans_a_plane(seen.p_B_m)) continue;
    const math::Pose X_CB = math::rigid_fit(seen.p_C_m, seen.p_B_m);
    if (rms_m(X_CB, seen) > worst_m) continue;
    out.t_s.push_back(t_s);
    out.X_CB.push_back(X_CB);
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
