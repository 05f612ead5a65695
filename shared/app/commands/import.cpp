/// `tractus import`: somebody's CT becomes ours.
#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "app/command.hpp"
#include "core/progress.hpp"
#include "core/try.hpp"
#include "volume/io/burnt_text.hpp"
#include "volume/io/read_volume.hpp"
#include "volume/volume_file.hpp"

namespace tractus {
namespace commands {
namespace {

struct ImportOptions {
  std::string source, target, report, series_uid;
  bool json = false;
};

std::string joined_lines(const std::vector<std::string>& lines) {
  std::string out;
  for (const auto& line : lines) out += (out.empty() ? "" : "; ") + line;
  return out;
}

void print_json(const ImportOptions& o, const volume_io::Imported& in, const std::string& id) {
  const auto& g = in.volume.geometry;
  const core::Json out = {{"file", o.target},
                          {"id", id},
                          {"format", in.format},
                          {"dims", g.dims},
                          {"spacing_m", {g.spacing_m.x(), g.spacing_m.y(), g.spacing_m.z()}},
                          {"value_range", volume::value_range_of(in.volume)},
                          {"notes", in.notes},
                          {"suspicions", in.suspicions}};
  std::puts(out.dump(2).c_str());
}

void print_text(const ImportOptions& o, const volume_io::Imported& in, const std::string& id) {
  const auto& g = in.volume.geometry;
  const auto range = volume::value_range_of(in.volume);
  fmt::print("{}: {} x {} x {} voxels of {:.4g} x {:.4g} x {:.4g} mm, CT values {:.6g} to {:.6g}\n",
             in.format, g.dims[0], g.dims[1], g.dims[2], g.spacing_m.x() * 1e3,
             g.spacing_m.y() * 1e3, g.spacing_m.z() * 1e3, range[0], range[1]);
  for (const auto& note : in.notes) fmt::print("note: {}\n", note);
  for (const auto& suspicion : in.suspicions)
    fmt::print("check the pictures before you pass the file on: {}\n", suspicion);
  fmt::print("{}  {}\n", id, o.target);
}

Outcome run_import(const ImportOptions& o) {
  auto in = TRY(volume_io::read_volume(
      o.source, {.progress = core::terminal_progress("reading"), .series_uid = o.series_uid}));
  for (auto& found : volume_io::text_suspicions(in.volume))
    in.suspicions.push_back(std::move(found));
  if (!o.report.empty()) TRY(core::write_json(o.report, in.report));
  const auto id = TRY(volume::write_volume(o.target, in.volume, {in.source, joined_lines(in.notes)},
                                           core::terminal_progress("writing")));
  o.json ? print_json(o, in, id) : print_text(o, in, id);
  return 0;
}

}  // namespace

Command import_command() {
  return {"import",
          "Convert a CT volume (NIfTI, NRRD, or a folder of DICOM slices) to a .tvol file",
          "tractus import spine.nii.gz spine.tvol", [](CLI::App& app) {
            auto options = std::make_shared<ImportOptions>();
            app.add_option("SRC", options->source,
                           "NIfTI, NRRD or .tvol file, or folder of DICOM files")
                ->required();
            app.add_option("OUT", options->target, "file to write; an existing file is replaced")
                ->required();
            app.add_option("--series", options->series_uid,
                           "Series Instance UID of the series to read, for a folder of several; "
                           "without it such a folder is refused with a list of them");
            app.add_option("--report", options->report,
                           "file for the de-identification report: the action for each DICOM "
                           "attribute, without values");
            app.add_flag("--json", options->json, "print the result as JSON");
            return [options] { return run_import(*options); };
          }};
}

}  // namespace commands
}  // namespace tractus
