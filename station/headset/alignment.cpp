#include "station/headset/alignment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/clock.hpp"
#include "core/json.hpp"
#include "core/try.hpp"
#include "core/words.hpp"
#include "math/rigid_fit.hpp"

namespace tractus {
namespace headset {
namespace {
constexpr std::size_t kFewest = 3, kMost = 8;
constexpr double kThin_m = 0.01;   // spread across the longest direction: less is a line
constexpr double kAlike_m = 0.01;  // distances that differ by less can be taken for each other
constexpr double kRoom_m = 50.0;

core::Error bad(const std::string& what) { return {core::Errc::bad_input, what}; }

using Points = std::vector<math::Vec3>;  // m

/// Root mean square distance from the straight line that fits best.
double off_a_line_m(const Points& points) {
  const math::Vec3 extents_m = math::extents(points);
  return std::hypot(extents_m[1], extents_m[2]) / std::sqrt(double(points.size()));
}

/// Are there two orders of the points whose distances agree?
bool could_be_confused(const Points& points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto distance = [&](std::size_t a, std::size_t b) {
    return (points[a] - points[b]).norm();
  };
  while (std::next_permutation(order.begin(), order.end())) {
    double worst_m = 0.0;
    for (std::size_t a = 0; a < order.size(); ++a)
      for (std::size_t b = a + 1; b < order.size(); ++b)
        worst_m = std::max(worst_m, std::abs(distance(a, b) - distance(order[a], order[b])));
    if (worst_m < kAlike_m) return true;
  }
  return false;
}

math::Vec3 point_of(core::Fields& fields, const char* key) {
  const auto numbers = fields.numbers(key, 3);
  if (numbers.size() != 3) return math::Vec3::Zero();
  const math::Vec3 p(numbers[0], numbers[1], numbers[2]);
  if (p.cwiseAbs().maxCoeff() > kRoom_m)
    fields.wrong(key, fmt::format("further than {} m; metres are expected", kRoom_m));
  return p;
}

core::Json array_of(const math::Vec3& v) { return core::Json::array({v.x(), v.y(), v.z()}); }

Points room_of(std::span<const FixturePoint> points) {
  Points out;
  for (const FixturePoint& point : points) out.push_back(point.p_S_m);
  return out;
}

core::Result<void> check_fixture(const std::string& where, std::span<const FixturePoint> points) {
  const Points room = room_of(points);
  if (off_a_line_m(room) < kThin_m)
    return bad(where + ": the points lie on a line; a turn about it would go unseen");
  if (could_be_confused(room))
    return bad(where +
               ": the points could be taken for each other (distances between them are "
               "equal to 10 mm); no two sides of the triangle may be equally long");
  return {};
}
}  // namespace

core::Result<std::vector<FixturePoint>> read_fixture(const std::filesystem::path& path) {
  auto json = TRY(core::read_json(path));
  core::Fields fields(json, path.string() + ": ");
  if (fields.text("format") != "tractus-fixture/1")
    fields.wrong("format", "\"tractus-fixture/1\" is expected");
  fields.text_or("name", "");
  const core::Json* list = fields.member("points");
  const bool fits = list && list->is_array() && list->size() >= kFewest && list->size() <= kMost;
  if (!fits) fields.wrong("points", "a list of 3 … 8 points is expected");
  std::vector<FixturePoint> points;
  for (std::size_t i = 0; fits && i < list->size(); ++i) {
    core::Fields one((*list)[i], fmt::format("{}: /points/{}", path.string(), i));
    points.push_back({one.text("name", 64), point_of(one, "stage_m")});
    if (std::ranges::count(points, points.back().name, &FixturePoint::name) > 1)
      one.wrong("name", fmt::format("'{}' is there twice", core::one_line(points.back().name)));
    TRY(one.done());
  }
  TRY(fields.done());
  TRY(check_fixture(path.string(), points));
  return points;
}

core::Result<Alignment> align(std::span<const Touched> touched, double limit_m) {
  if (touched.size() < kFewest)
    return bad(fmt::format("alignment: {} points were touched, three are needed", touched.size()));
  Points room, device;
  for (const Touched& one : touched) {
    room.push_back(one.point.p_S_m);
    device.push_back(one.p_D_m);
  }
  if (std::min(off_a_line_m(room), off_a_line_m(device)) < kThin_m)
    return bad("alignment: the points lie on a line; a turn about it would go unseen");
  Alignment out;
  out.X_SD = math::rigid_fit(room, device);
  double squares = 0.0;
  for (const Touched& one : touched) {
    const double off_m = (one.point.p_S_m - out.X_SD * one.p_D_m).norm();
    squares += off_m * off_m;
    if (off_m < out.worst_m) continue;
    out.worst_m = off_m;
    out.worst = one.point.name;
  }
  out.rms_m = std::sqrt(squares / double(touched.size()));
  if (out.worst_m > limit_m)
    return bad(
        fmt::format("alignment: point {} is {:.1f} mm off, {:.1f} mm are allowed; touch the "
                    "points in their order, and see that neither fixture nor device moved",
                    out.worst, 1e3 * out.worst_m, 1e3 * limit_m));
  return out;
}

core::Result<void> keep_alignment(const std::filesystem::path& folder, const KeptAlignment& kept,
                                  std::span<const Touched> touched) {
  const math::Quat& q = kept.alignment.X_SD.q;
  core::Json points = core::Json::array();
  for (const Touched& one : touched)
    points.push_back({{"name", one.point.name},
                      {"stage_m", array_of(one.point.p_S_m)},
                      {"device_m", array_of(one.p_D_m)}});
  return core::write_json(folder / "alignment.json",
                          {{"format", "tractus-alignment/1"},
                           {"made_utc_us", kept.made_utc_us},
                           {"made_utc", core::utc_text(kept.made_utc_us)},
                           {"device", kept.device},
                           {"simulated", kept.simulated},
                           {"p_SD_m", array_of(kept.alignment.X_SD.p)},
                           {"q_SD", {q.w(), q.x(), q.y(), q.z()}},
                           {"residual_rms_m", kept.alignment.rms_m},
                           {"residual_worst_m", kept.alignment.worst_m},
                           {"worst", kept.alignment.worst},
                           {"points", points}});
}

core::Result<std::optional<KeptAlignment>> kept_alignment(const std::filesystem::path& folder) {
  const auto path = folder / "alignment.json";
  if (!std::filesystem::exists(path)) return std::optional<KeptAlignment>{};
  auto json = TRY(core::read_json(path));
  core::Fields fields(json, path.string() + ": ");
  KeptAlignment out;
  if (fields.text("format") != "tractus-alignment/1")
    fields.wrong("format", "\"tractus-alignment/1\" is expected");
  out.made_utc_us = fields.integer("made_utc_us", 0, 4'102'444'800'000'000);
  fields.skip("made_utc");
  out.device = fields.text("device", 64);
  const core::Json* simulated = fields.member("simulated");
  if (simulated && !simulated->is_boolean()) fields.wrong("simulated", "true or false is expected");
  out.simulated = simulated && simulated->is_boolean() && simulated->get<bool>();
  out.alignment.X_SD.p = point_of(fields, "p_SD_m");
  const auto q = fields.numbers("q_SD", 4);
  if (q.size() == 4) out.alignment.X_SD.q = math::Quat(q[0], q[1], q[2], q[3]);
  if (std::abs(out.alignment.X_SD.q.norm() - 1.0) > 1e-6)
    fields.wrong("q_SD", "a unit quaternion w, x, y, z is expected");
  out.alignment.rms_m = fields.number("residual_rms_m", 0.0, 1.0);
  out.alignment.worst_m = fields.number("residual_worst_m", 0.0, 1.0);
  out.alignment.worst = fields.text_or("worst", "");
  fields.skip("points");
  TRY(fields.done());
  return std::optional(out);
}

}  // namespace headset
}  // namespace tractus
