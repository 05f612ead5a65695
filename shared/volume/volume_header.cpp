#include "volume/volume_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/json.hpp"
#include "core/try.hpp"

namespace tractus {
namespace volume {
namespace {

constexpr int kMaxDim = 4096;
constexpr std::size_t kMaxVoxels = std::size_t{1} << 31;
constexpr std::size_t kMaxBins = 256;

core::Error bad(const std::string& where, const std::string& why) {
  return {core::Errc::bad_input, where + ": " + why};
}

core::Result<void> check_histogram(const VolumeHeader& header, const std::string& where) {
  const auto& bins = header.histogram.voxels;
  if (bins.empty() || bins.size() > kMaxBins)
    return bad(where,
               fmt::format("histogram of {} bins, 1 to {} are expected", bins.size(), kMaxBins));
  const auto total = std::accumulate(bins.begin(), bins.end(), std::uint64_t{0});
  if (total != header.geometry.voxel_count())
    return bad(where, fmt::format("histogram counts {} voxels, the volume has {}", total,
                                  header.geometry.voxel_count()));
  if (!std::isfinite(header.histogram.low) || !(header.histogram.width >= 0.0))
    return bad(where, "histogram edges must be finite numbers");
  return {};
}

std::vector<double> numbers_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Vec3 vec3_of(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

Histogram parse_histogram(const core::Json& json, const std::string& where,
                          std::string& first_error) {
  Histogram out;
  core::Fields fields(json, where);
  out.low = fields.number("low", -1e12, 1e12);
  out.width = fields.number("width", 0.0, 1e12);
  if (const auto* bins = fields.member("voxels")) {
    const bool shaped =
        bins->is_array() && bins->size() <= kMaxBins &&
        std::ranges::all_of(*bins, [](const auto& b) {
          return b.is_number_unsigned() && b.template get<std::uint64_t>() <= kMaxVoxels;
        });
    if (shaped)
      out.voxels = bins->get<std::vector<std::uint64_t>>();
    else
      fields.wrong("voxels", fmt::format("at most {} counts are expected", kMaxBins));
  }
  if (const auto done = fields.done(); !done) first_error = done.error().what;
  return out;
}

/// Columns of the directions, each an array of three numbers.
Mat3 parse_directions(core::Fields& fields) {
  Mat3 out = Mat3::Zero();
  const auto* columns = fields.member("directions");
  const bool shaped = columns && columns->is_array() && columns->size() == 3;
  if (!shaped) fields.wrong("directions", "three unit vectors are expected");
  for (std::size_t a = 0; shaped && a < 3; ++a) {
    const core::Json one{{"column", (*columns)[a]}};
    core::Fields column(one, fields.where());
    out.col(static_cast<Eigen::Index>(a)) = vec3_of(column.numbers("column", 3));
    if (const auto done = column.done(); !done)
      fields.wrong("directions", "three unit vectors are expected");
  }
  return out;
}

Geometry parse_geometry(core::Fields& fields) {
  Geometry out;
  const auto dims = fields.numbers("dims", 3);
  for (std::size_t a = 0; a < 3; ++a) {
    out.dims[a] = static_cast<int>(std::clamp(dims[a], -1.0, 1e6));
    if (out.dims[a] != dims[a]) fields.wrong("dims", "three whole numbers are expected");
  }
  out.spacing_m = vec3_of(fields.numbers("spacing_m", 3));
  out.origin_m = vec3_of(fields.numbers("origin_m", 3));
  out.directions = parse_directions(fields);
  return out;
}

}  // namespace

core::Result<void> check_geometry(const Geometry& geometry, const std::string& where) {
  std::size_t voxels = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    if (geometry.dims[a] < 1 || geometry.dims[a] > kMaxDim)
      return bad(where, fmt::format("axis {} has {} voxels, 1 to {} are taken", a + 1,
                                    geometry.dims[a], kMaxDim));
    voxels *= static_cast<std::size_t>(geometry.dims[a]);
    const double spacing = geometry.spacing_m[static_cast<Eigen::Index>(a)];
    if (!(spacing >= 1e-6 && spacing <= 0.1))
      return bad(where, fmt::format("axis {} has a spacing of {} mm, 0.001 to 100 mm are taken",
                                    a + 1, spacing * 1e3));
    const double origin = geometry.origin_m[static_cast<Eigen::Index>(a)];
    if (!(std::abs(origin) <= 100.0))
      return bad(where,
                 fmt::format("origin at {} mm, at most 100 m from zero is taken", origin * 1e3));
  }
  if (voxels > kMaxVoxels)
    return bad(where, fmt::format("{} voxels, at most {} are taken", voxels, kMaxVoxels));
  const Mat3 gram = geometry.directions.transpose() * geometry.directions;
  if (!((gram - Mat3::Identity()).cwiseAbs().maxCoeff() <= 1e-4))
    return bad(where, "the axes are not at right angles to one another");
  return {};
}

core::Result<void> check_header(const VolumeHeader& header, const std::string& where) {
  TRY(check_geometry(header.geometry, where));
  if (!(header.slope > 0.0 && header.slope <= 1e9) || !(std::abs(header.intercept) <= 1e12))
    return bad(where,
               fmt::format("slope {} and intercept {} must be finite, the slope greater than 0",
                           header.slope, header.intercept));
  if (!(header.value_range[0] <= header.value_range[1]))
    return bad(where, fmt::format("value range {} … {} runs backwards", header.value_range[0],
                                  header.value_range[1]));
  if (header.meta.source.size() > 1024 || header.meta.note.size() > 16384)
    return bad(where, "source is at most 1024 bytes long, note 16384");
  return check_histogram(header, where);
}

std::string header_text(const VolumeHeader& header) {
  const Geometry& g = header.geometry;
  core::Json json;
  json["format"] = "tractus-volume/1";
  json["dims"] = g.dims;
  json["spacing_m"] = numbers_of(g.spacing_m);
  json["origin_m"] = numbers_of(g.origin_m);
  json["directions"] = {numbers_of(g.directions.col(0)), numbers_of(g.directions.col(1)),
                        numbers_of(g.directions.col(2))};
  json["slope"] = header.slope;
  json["intercept"] = header.intercept;
  json["value_range"] = header.value_range;
  json["histogram"] = {{"low", header.histogram.low},
                       {"width", header.histogram.width},
                       {"voxels", header.histogram.voxels}};
  json["brick_edge"] = kBrickEdge;
  json["codec"] = "zstd of byte planes";
  json["source"] = header.meta.source;
  json["note"] = header.meta.note;
  return json.dump(-1, ' ', false, core::Json::error_handler_t::replace);
}

core::Result<VolumeHeader> parse_header(std::string_view text, const std::string& where) {
  auto json = core::parse_json(text, where);
  if (!json) return core::Error{core::Errc::corrupt, json.error().what};
  core::Fields fields(*json, where);
  if (const auto format = fields.text("format"); format != "tractus-volume/1")
    fields.wrong("format",
                 fmt::format("\"{}\" is not known, \"tractus-volume/1\" is expected", format));
  VolumeHeader out;
  out.geometry = parse_geometry(fields);
  out.slope = fields.number("slope", 0.0, 1e9);
  out.intercept = fields.number("intercept", -1e12, 1e12);
  const auto range = fields.numbers("value_range", 2);
  out.value_range = {range[0], range[1]};
  std::string histogram_error;
  if (const auto* histogram = fields.member("histogram"))
    out.histogram = parse_histogram(*histogram, where + "/histogram", histogram_error);
  if (fields.integer("brick_edge", 1, 4096) != kBrickEdge)
    fields.wrong("brick_edge", fmt::format("{} is expected", kBrickEdge));
  if (fields.text("codec") != "zstd of byte planes") fields.wrong("codec", "is not known");
  out.meta = {fields.text("source", 1024), fields.text("note", 16384)};
  TRY(fields.done());
  if (!histogram_error.empty()) return core::Error{core::Errc::bad_input, histogram_error};
  TRY(check_header(out, where));
  return out;
}

}  // namespace volume
}  // namespace tractus
