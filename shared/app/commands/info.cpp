/// `tractus info`: what a volume is, for people and machines, and a picture of it.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "app/command.hpp"
#include "core/progress.hpp"
#include "core/try.hpp"
#include "volume/io/picture.hpp"
#include "volume/io/read_volume.hpp"
#include "volume/volume_file.hpp"

namespace tractus {
namespace commands {
namespace {

using volume::Vec3;

struct InfoOptions {
  std::string file, png;
  std::vector<double> at_mm, window{400.0, 1800.0};
  bool json = false;
};

/// What is shown, of a stored volume (read from its header alone) or of a foreign one.
struct Facts {
  std::string format, id, source, note;
  volume::Geometry geometry;
  double slope = 1.0, intercept = 0.0;
  std::array<double, 2> range{};
  volume::Histogram histogram;
};

Facts facts_of(const volume::VolumeFile& file) {
  return {"tractus-volume/1", file.id(),          file.meta().source,
          file.meta().note,   file.geometry(),    file.slope(),
          file.intercept(),   file.value_range(), file.histogram()};
}

Facts facts_of(const volume_io::Imported& in) {
  std::string notes;
  for (const auto& note : in.notes) notes += (notes.empty() ? "" : "; ") + note;
  return {in.format,
          "",
          in.source,
          notes,
          in.volume.geometry,
          in.volume.slope,
          in.volume.intercept,
          volume::value_range_of(in.volume),
          volume::histogram_of(in.volume)};
}

std::vector<double> numbers_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// Which way an axis runs in the patient, by its largest part: "R", "P", "S" …
char letter_of(const Vec3& direction) {
  Eigen::Index axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return (direction[axis] > 0 ? "LPS" : "RAI")[axis];
}

std::string axes_of(const volume::Geometry& g) {
  return {letter_of(g.directions.col(0)), letter_of(g.directions.col(1)),
          letter_of(g.directions.col(2))};
}

void print_json(const Facts& f) {
  const auto& g = f.geometry;
  core::Json out = {
      {"format", f.format},
      {"id", f.id},
      {"source", f.source},
      {"note", f.note},
      {"dims", g.dims},
      {"spacing_m", numbers_of(g.spacing_m)},
      {"origin_m", numbers_of(g.origin_m)},
      {"directions",
       {numbers_of(g.directions.col(0)), numbers_of(g.directions.col(1)),
        numbers_of(g.directions.col(2))}},
      {"axes", axes_of(g)},
      {"slope", f.slope},
      {"intercept", f.intercept},
      {"value_range", f.range},
      {"histogram",
       {{"low", f.histogram.low}, {"width", f.histogram.width}, {"voxels", f.histogram.voxels}}}};
  if (f.id.empty()) out.erase("id");
  std::puts(out.dump(2).c_str());
}

/// Twenty rows, bars on a scale of square roots so that bone shows beside air.
void print_histogram(const volume::Histogram& h) {
  const std::size_t per_row = (h.voxels.size() + 19) / 20;
  std::vector<std::uint64_t> rows((h.voxels.size() + per_row - 1) / per_row, 0);
  for (std::size_t bin = 0; bin < h.voxels.size(); ++bin) rows[bin / per_row] += h.voxels[bin];
  const double most = std::sqrt(static_cast<double>(*std::ranges::max_element(rows)));
  fmt::print("CT value from … to, voxels (bar: square root)\n");
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const double low = h.low + h.width * static_cast<double>(r * per_row);
    const auto bar = static_cast<std::size_t>(
        std::lround(50.0 * std::sqrt(static_cast<double>(rows[r])) / most));
    fmt::print("{:>8.0f} … {:<8.0f} {:>11}  {}\n", low,
               low + h.width * static_cast<double>(per_row), rows[r], std::string(bar, '#'));
  }
}

void print_text(const Facts& f) {
  const auto& g = f.geometry;
  const Vec3 extent = Vec3(g.dims[0], g.dims[1], g.dims[2]).cwiseProduct(g.spacing_m) * 1e3;
  const Vec3 centre = volume_io::centre_of(g) * 1e3;
  fmt::print("format   {}\n", f.format);
  if (!f.id.empty()) fmt::print("id       {}\n", f.id);
  fmt::print("source   {}\n", f.source);
  if (!f.note.empty()) fmt::print("note     {}\n", f.note);
  fmt::print("voxels   {} x {} x {}, axes run to {}\n", g.dims[0], g.dims[1], g.dims[2],
             axes_of(g));
  fmt::print("spacing  {:.4g} x {:.4g} x {:.4g} mm\n", g.spacing_m.x() * 1e3, g.spacing_m.y() * 1e3,
             g.spacing_m.z() * 1e3);
  fmt::print("extent   {:.1f} x {:.1f} x {:.1f} mm\n", extent.x(), extent.y(), extent.z());
  fmt::print("centre   {:.1f}, {:.1f}, {:.1f} mm (LPS)\n", centre.x(), centre.y(), centre.z());
  fmt::print("values   {:.6g} to {:.6g}, in steps of {:.6g}\n", f.range[0], f.range[1], f.slope);
  print_histogram(f.histogram);
}

core::Result<void> write_picture(const InfoOptions& o, const volume::Volume& v) {
  const Vec3 at = o.at_mm.empty() ? volume_io::centre_of(v.geometry)
                                  : Vec3(Vec3(o.at_mm[0], o.at_mm[1], o.at_mm[2]) * 1e-3);
  return volume_io::write_slices_png(o.png, v, at, {.window = {o.window[0], o.window[1]}});
}

Outcome run_info(const InfoOptions& o) {
  const auto progress = core::terminal_progress("reading");
  std::error_code failure;
  auto stored = volume::VolumeFile::open(o.file);
  if (!stored && stored.error().code != core::Errc::bad_input) return stored.error();
  Facts facts;
  if (stored) {
    facts = facts_of(*stored);
    if (!o.png.empty()) {
      const auto whole = TRY(stored->read_all(progress));
      TRY(write_picture(o, whole));
    }
  } else {
    const auto in = TRY(volume_io::read_volume(o.file, progress));
    facts = facts_of(in);
    if (!o.png.empty()) TRY(write_picture(o, in.volume));
  }
  o.json ? print_json(facts) : print_text(facts);
  return 0;
}

}  // namespace

Command info_command() {
  return {"info", "Show size, position, values and histogram of a volume, and draw three slices",
          "tractus info spine.tvol --png spine.png --at 0,-35,120", [](CLI::App& app) {
            auto options = std::make_shared<InfoOptions>();
            app.add_option("FILE", options->file,
                           "a .tvol file, or any file or folder that tractus import reads")
                ->required();
            app.add_option("--png", options->png,
                           "file for a picture of an axial, a coronal and a sagittal slice");
            app.add_option("--at", options->at_mm,
                           "point x,y,z through which the slices go, in mm, LPS (default: centre "
                           "of the volume)")
                ->delimiter(',')
                ->expected(3);
            app.add_option("--window", options->window,
                           "centre,width of the grey scale, in CT values (default 400,1800)")
                ->delimiter(',')
                ->expected(2);
            app.add_flag("--json", options->json, "print the result as JSON, in SI units");
            return [options] { return run_info(*options); };
          }};
}

}  // namespace commands
}  // namespace tractus
