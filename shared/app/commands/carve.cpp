/// `tractus carve`: a CT, an entry and a target become a case.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>

#include "app/case_picture.hpp"
#include "app/command.hpp"
#include "app/lengths.hpp"
#include "cases/making.hpp"
#include "cases/markups.hpp"
#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "volume/io/read_volume.hpp"

namespace tractus {
namespace commands {
namespace {

using core::Errc;
using core::Error;
using core::Json;

constexpr const char* kEvery = "every";  // of --breach

struct CarveOptions {
  std::string volume, out, title, source, model, key, png;
  std::string entry, target, drawn, length, radius = "1.5", midline;
  std::string breach, breach_depth, breach_at, spacing = "0.35", margin = "20";
  std::string preparation = "published", envelope, observer, may_move;
  std::vector<std::string> bone_at, no_bone_at;
  bool calibrated = false;
  int envelope_label = 1;
  bool no_channel = false, certified = false;
  bool json = false;
};

/// The options that hold one length, where it goes, and its name.
template <class Plan>
core::Result<void> read_length(const std::string& text, const char* option, Plan& into) {
  if (text.empty()) return {};
  const auto length = TRY(length_m(text, option));
  into = length;
  return {};
}

core::Result<void> read_breach(const CarveOptions& o, cases::CarvingPlan& plan) {
  if (o.breach.empty()) {
    for (const auto& [text, option] :
         {std::pair(&o.breach_depth, "--breach-depth"), std::pair(&o.breach_at, "--breach-at")})
      if (!text->empty())
        return Error{Errc::bad_input, fmt::format("{}: needs --breach WALL", option)};
    return {};
  }
  if (o.breach == kEvery) {
    if (!o.breach_at.empty() || !o.breach_depth.empty() || !o.png.empty())
      return Error{Errc::bad_input,
                   "--breach every: --breach-at, --breach-depth and --png are of one case"};
    return {};
  }
  const auto wall = core::from_name<volume::Wall>(o.breach);
  if (!wall)
    return Error{Errc::bad_input,
                 fmt::format("--breach: '{}': medial, lateral, superior, inferior, anterior or "
                             "every is expected",
                             o.breach)};
  plan.breach = volume::BreachPlan{.wall = *wall};
  TRY(read_length(o.breach_depth, "--breach-depth", plan.breach->depth_m));
  return read_length(o.breach_at, "--breach-at", plan.breach->at_m);
}

core::Result<void> read_marks(const CarveOptions& o, cases::CarvingPlan& plan) {
  if (o.bone_at.empty() && o.no_bone_at.empty()) return {};
  if (plan.preparation == volume::Preparation::published || !o.envelope.empty())
    return Error{Errc::bad_input,
                 "--bone-at and --no-bone-at: need --preparation filled, without --envelope"};
  for (const auto& [points, option, bone] : {std::tuple(&o.bone_at, "--bone-at", true),
                                             std::tuple(&o.no_bone_at, "--no-bone-at", false)})
    for (const std::string& text : *points) {
      const auto at_m = TRY(point_m(text, option));
      plan.envelope_marks.push_back({.at_m = at_m, .bone = bone});
    }
  return {};
}

core::Result<void> read_preparation(const CarveOptions& o, cases::CarvingPlan& plan) {
  const auto preparation = core::from_name<volume::Preparation>(o.preparation);
  if (!preparation)
    return Error{Errc::bad_input,
                 fmt::format("--preparation: '{}': one of {} is expected", o.preparation,
                             core::names_listed<volume::Preparation>())};
  plan.preparation = *preparation;
  TRY(read_marks(o, plan));
  if (o.envelope.empty()) return {};
  if (plan.preparation == volume::Preparation::published)
    return Error{Errc::bad_input, "--envelope: needs --preparation filled"};
  const auto labels = TRY(volume_io::read_volume(o.envelope));
  auto envelope = volume::envelope_of_labels(labels.volume, o.envelope_label);
  if (!envelope) return Error{envelope.error().code, o.envelope + ": " + envelope.error().what};
  plan.envelope = std::move(*envelope);
  return {};
}

/// From the two points, or from a line that was drawn in 3D Slicer.
core::Result<cases::PlannedLine> read_line(const CarveOptions& o) {
  if (!o.drawn.empty()) return cases::read_line_markup(o.drawn);
  if (o.entry.empty() || o.target.empty())
    return Error{Errc::bad_input, "give --entry and --target, or --plan FILE.mrk.json"};
  const auto entry_m = TRY(point_m(o.entry, "--entry"));
  const auto target_m = TRY(point_m(o.target, "--target"));
  return cases::PlannedLine{entry_m, target_m};
}

core::Result<cases::CarvingPlan> plan_of(const CarveOptions& o) {
  cases::CarvingPlan plan;
  const auto line = TRY(read_line(o));
  plan.entry_m = line.entry_m;
  plan.target_m = line.target_m;
  TRY(read_length(o.length, "--length", plan.length_m));
  TRY(read_length(o.radius, "--radius", plan.radius_m));
  TRY(read_length(o.midline, "--midline-x", plan.midline_x_m));
  TRY(read_length(o.spacing, "--spacing", plan.spacing_m));
  TRY(read_length(o.margin, "--margin", plan.margin_m));
  TRY(read_length(o.may_move, "--may-move", plan.may_move_m));
  TRY(read_breach(o, plan));
  TRY(read_preparation(o, plan));
  plan.drilled = !o.no_channel;
  if (o.certified && o.no_channel)
    return Error{Errc::bad_input, "--certified: a planned channel has no walls to feel"};
  return plan;
}

core::Result<cases::Perception> perception_of(const CarveOptions& o) {
  if (o.observer.empty()) return cases::Perception{};
  return cases::read_perception(o.observer);
}

core::Result<models::PalpationModel> model_of(const CarveOptions& o) {
  if (!o.model.empty()) return models::PalpationModel::read(o.model);
  models::PalpationModel model;
  model.name = "uniform cantilever";
  return model;
}

core::Result<core::KeyPair> key_of(const CarveOptions& o) {
  if (!o.key.empty()) return core::KeyPair::open_or_make(o.key);
  const char *config = std::getenv("XDG_CONFIG_HOME"), *home = std::getenv("HOME");
  if (!(config && *config) && !(home && *home))
    return Error{Errc::not_found, "there is no home folder for the signing key: give --key FILE"};
  const auto base =
      config && *config ? std::filesystem::path(config) : std::filesystem::path(home) / ".config";
  return core::KeyPair::open_or_make(base / "tractus" / "signing.key");
}

Json json_of(const math::Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }

Json wall_json(volume::Wall wall, const core::Result<volume::WallFound>& found) {
  if (!found) return {{"wall", volume::name(wall)}, {"why_not", found.error().what}};
  return {{"wall", volume::name(wall)},
          {"thickness_m", found->thickness_m()},
          {"inner_m", found->inner_m},
          {"at_m", found->at_m}};
}

Json report_of(const cases::OpenedCase& made, const cases::Made& carved) {
  const auto& grid = carved.volume.geometry;
  Json out = {
      {"case", made.id},
      {"folder", made.folder.string()},
      {"title", made.definition.title},
      {"signer", made.signer_public_hex},
      {"side", carved.left_side() ? "left" : "right"},
      {"tract", made.definition.to_json()["tract"]},
      {"channel", carved.drilled ? "drilled" : "planned"},
      {"mouth_m", carved.mouth_m},
      {"midline", {{"x_m", carved.midline.at_m.x()}, {"turn_rad", carved.midline.turn_rad}}},
      {"volume", {{"dims", grid.dims}, {"spacing_m", json_of(grid.spacing_m)}}},
      {"empty_value", carved.empty_value},
      {"walls", Json::array()},
      {"breach", Json()},
      {"preparation", volume::name(made.definition.preparation)},
      {"warnings", carved.calibration.warnings},
      {"moved_m", Json::array({carved.moved_m.x(), carved.moved_m.y()})},
      {"certificate", carved.certificate ? carved.certificate->to_json() : Json()}};
  out["midline"]["symmetry"] = carved.midline.symmetry ? Json(*carved.midline.symmetry) : Json();
  for (std::size_t k = 0; k < carved.walls.size(); ++k)
    out["walls"].push_back(wall_json(volume::kWalls[k], carved.walls[k]));
  if (const auto& breach = carved.breach)
    out["breach"] = {{"wall", volume::name(breach->wall.wall)},
                     {"at_m", breach->wall.at_m},
                     {"centre_m", json_of(breach->centre_m)},
                     {"tip_m", json_of(breach->tip_m)},
                     {"depth_m", breach->depth_m},
                     {"wall_thickness_m", breach->wall.thickness_m()}};
  return out;
}

void print_certificate(const cases::Certificate& certificate) {
  for (const auto& wall : certificate.walls) {
    const auto d = wall.d_prime();
    if (!d) {
      fmt::print("{:>9} breach: {}\n", volume::name(wall.wall), wall.why_not);
      continue;
    }
    fmt::print("{:>9} breach at depth {:.1f} mm: d′ {:.1f}{}, {}\n", volume::name(wall.wall),
               *wall.at_m * 1e3, *d,
               wall.told.fa ? fmt::format(", worst whole place {:.1f}", *wall.told.fa) : "",
               wall.passes() ? "can be told" : "CANNOT be told by feel");
  }
}

void print_text(const cases::OpenedCase& made, const cases::Made& carved) {
  const auto& grid = carved.volume.geometry;
  const auto& midline = carved.midline;
  fmt::print(
      "{} pedicle, tract of {:.1f} mm; midline at x = {:.1f} mm, turned {:.0f} degrees ({})\n",
      carved.left_side() ? "left" : "right", carved.tract.length_m * 1e3, midline.at_m.x() * 1e3,
      midline.turn_rad * 180 / std::numbers::pi,
      midline.symmetry ? fmt::format("estimated, symmetry {:.2f}", *midline.symmetry)
                       : "as stated");
  for (std::size_t k = 0; k < carved.walls.size(); ++k) {
    const auto& wall = carved.walls[k];
    if (wall)
      fmt::print(
          "{:>9} wall: {:.1f} mm thick where thinnest, {:.1f} mm from the axis, at depth {:.1f} "
          "mm\n",
          volume::name(volume::kWalls[k]), wall->thickness_m() * 1e3, wall->inner_m * 1e3,
          wall->at_m * 1e3);
    else
      fmt::print("          {}\n", wall.error().what);
  }
  if (const auto& breach = carved.breach)
    fmt::print("{} breach at depth {:.1f} mm, through {:.1f} mm of bone and {:.1f} mm beyond\n",
               volume::name(breach->wall.wall), breach->wall.at_m * 1e3,
               breach->wall.thickness_m() * 1e3, breach->depth_m * 1e3);
  if (carved.moved_m.norm() > 0.0)
    fmt::print("moved by {:.1f} mm to medial and {:.1f} mm to superior, so that all can be told\n",
               carved.moved_m.x() * 1e3, carved.moved_m.y() * 1e3);
  if (carved.certificate) print_certificate(*carved.certificate);
  for (const auto& warning : carved.calibration.warnings) fmt::print("warning: {}\n", warning);
  if (!carved.drilled) fmt::print("the bone is whole: the tract is planned and not drilled\n");
  fmt::print(
      "{} x {} x {} voxels of {:.3g} x {:.3g} x {:.3g} mm; removed bone has the CT value {:g}\n",
      grid.dims[0], grid.dims[1], grid.dims[2], grid.spacing_m.x() * 1e3, grid.spacing_m.y() * 1e3,
      grid.spacing_m.z() * 1e3, carved.empty_value);
  fmt::print("{}  {}\n", made.id, made.folder.string());
}

cases::NewCase case_of(const CarveOptions& o, const cases::Made& carved,
                       const models::PalpationModel& model, const std::string& source,
                       volume::Volume surroundings) {
  cases::NewCase made{
      .definition = {}, .truth = carved.truth(), .volume = carved.volume, .meta = {}, .draw = {}};
  made.definition.title =
      o.title.empty()
          ? fmt::format("{} pedicle of {}", carved.left_side() ? "left" : "right", source)
          : o.title;
  made.definition.source = o.source.empty() ? source : o.source;
  made.definition.made_utc_us = core::utc_us();
  made.definition.tract = carved.tract;
  made.definition.planned = !carved.drilled;
  made.definition.preparation =
      carved.envelope ? volume::Preparation::filled : volume::Preparation::published;
  made.certificate = carved.certificate;
  made.definition.model = model;
  made.definition.model.volume.clear();
  made.meta = {source, carved.drilled ? "part about a tract, drilled"
                                      : "part about a planned tract, not drilled"};
  made.draw = [&carved, surroundings = std::move(surroundings)](const std::filesystem::path& path) {
    return draw_case(path, surroundings, carved);
  };
  return made;
}

/// The message, led by the file it is about.
Error about(const std::string& file, const Error& error) {
  return {error.code, file + ": " + error.what};
}

/// The picture of its own goes away again if the case cannot be written.
Outcome write(const CarveOptions& o, cases::NewCase definition, const core::KeyPair& key,
              const cases::Made& carved) {
  if (!o.png.empty()) TRY(definition.draw(o.png));
  const auto made =
      cases::write_case(o.out, std::move(definition), key, core::terminal_progress("writing"));
  if (!made) {
    std::error_code ignored;
    if (!o.png.empty()) std::filesystem::remove(o.png, ignored);
    return made.error();
  }
  o.json ? void(std::puts(report_of(*made, carved).dump(2).c_str())) : print_text(*made, carved);
  return 0;
}

/// Five cases in folders of the wall's name; all, or none.
Outcome write_five(const CarveOptions& o, const models::PalpationModel& model,
                   const volume_io::Imported& ct, const std::vector<cases::Made>& five) {
  const auto key = TRY(key_of(o));
  Json reports = Json::array();
  for (const cases::Made& made : five) {
    auto surroundings = cases::drilled_surroundings(ct.volume, made);
    if (!surroundings) return about(o.volume, surroundings.error());
    auto definition = case_of(o, made, model, ct.source, std::move(*surroundings));
    const auto wall = volume::name(made.breach->wall.wall);
    definition.definition.title += fmt::format(", {} breach", wall);
    const auto folder = std::filesystem::path(o.out) / wall;
    auto written = cases::write_case(folder, std::move(definition), key,
                                     core::terminal_progress(std::string(wall)));
    std::error_code ignored;
    if (!written) std::filesystem::remove_all(o.out, ignored);
    if (!written) return written.error();
    o.json ? reports.push_back(report_of(*written, made)) : print_text(*written, made);
  }
  if (o.json) std::puts(reports.dump(2).c_str());
  return 0;
}

Outcome run_five(const CarveOptions& o, const models::PalpationModel& model,
                 const volume_io::Imported& ct, const cases::CarvingPlan& plan,
                 const cases::Perception& perception) {
  const auto five =
      cases::make_five(ct.volume, model, plan, core::terminal_progress("carving"), perception);
  if (!five) return about(o.volume, five.error());
  std::error_code failure;
  if (!std::filesystem::create_directory(o.out, failure))
    return Error{Errc::io, fmt::format("{}: {}", o.out, failure.message())};
  return write_five(o, model, ct, *five);
}

core::Result<volume::TransferFunction> calibrated_transfer(const CarveOptions& o,
                                                           const models::PalpationModel& model,
                                                           const volume::Volume& ct) {
  const auto found = volume::calibrate(volume::histogram_of(ct), ct.geometry);
  auto transfer = volume::calibrated(model.transfer, found);
  if (!transfer) return about(o.volume, transfer.error());
  return transfer;
}

Outcome run_carve(const CarveOptions& o) {
  const auto plan = TRY(plan_of(o));
  auto model = TRY(model_of(o));
  const auto perception = TRY(perception_of(o));
  if (std::error_code ignored; std::filesystem::exists(o.out, ignored))
    return Error{Errc::conflict,
                 fmt::format("{}: exists already; remove it or choose another name", o.out)};
  const auto ct = TRY(volume_io::read_volume(o.volume, core::terminal_progress("reading")));
  if (o.calibrated) model.transfer = TRY(calibrated_transfer(o, model, ct.volume));
  if (o.breach == kEvery) return run_five(o, model, ct, plan, perception);
  const auto carved =
      cases::make(ct.volume, model, plan, core::terminal_progress("carving"), perception);
  if (!carved) return about(o.volume, carved.error());
  if (o.certified && !carved->certificate->passes())
    return about(o.volume,
                 {Errc::out_of_range, carved->certificate->warning() +
                                          "; move entry or target, fill the bone "
                                          "(--preparation filled), or leave out --certified"});
  auto surroundings = cases::drilled_surroundings(ct.volume, *carved);
  if (!surroundings) return about(o.volume, surroundings.error());
  const auto key = TRY(key_of(o));
  return write(o, case_of(o, *carved, model, ct.source, std::move(*surroundings)), key, *carved);
}

void add_options(CLI::App& app, CarveOptions& o) {
  app.add_option("--volume", o.volume,
                 "CT volume: a NIfTI, NRRD or .tvol file, or a folder of DICOM slices")
      ->required();
  auto* entry = app.add_option(
      "--entry", o.entry,
      "centre of the tract's entry as x,y,z in patient coordinates LPS (x to the left, y to "
      "posterior, z to superior), in mm; a unit may follow: 45,199,-61mm or 0.045,0.199,-0.061m");
  auto* target =
      app.add_option("--target", o.target,
                     "a point on the tract's axis beyond the entry, in the same form as --entry");
  app.add_option("--plan", o.drawn,
                 "line from entry to target, drawn in 3D Slicer (.mrk.json), in place of --entry "
                 "and --target")
      ->excludes(entry)
      ->excludes(target);
  app.add_option("--length", o.length,
                 "length of the tract, in mm (default: distance from entry to target)");
  app.add_option("--radius", o.radius, "radius of the drill, in mm (default 1.5)");
  app.add_option(
      "--breach", o.breach,
      "wall with a breach: medial, lateral, superior, inferior or anterior (default: no breach); "
      "every: five cases of equal difficulty, one a wall, in folders of DIR named by the wall");
  app.add_option("--breach-depth", o.breach_depth,
                 "depth of the breach beyond the bone, in mm (default 3)");
  app.add_option("--breach-at", o.breach_at,
                 "depth of the breach along the tract, in mm (default: where this wall is thinnest "
                 "in the pedicle)");
  app.add_flag("--no-channel", o.no_channel,
               "leave the bone whole: the tract is only planned, and a trainee drills it "
               "(tractus-station --tool burr)");
  app.add_option(
      "--midline-x", o.midline,
      "x coordinate of the midline, in mm (default: estimated from the symmetry of the bone)");
  app.add_option("--spacing", o.spacing,
                 "voxel size of the drilled volume if the CT is coarser, in mm (default 0.35)");
  app.add_option("--margin", o.margin, "margin of the volume around the tract, in mm (default 20)");
  app.add_option("--model", o.model,
                 "model file with probe and transfer function (default: the published model)");
  app.add_flag("--calibrated", o.calibrated,
               "move the model's transfer function with the peaks of air, fat and soft tissue that "
               "this CT shows (tractus calibrate)");
  app.add_option("--preparation", o.preparation,
                 "how the bone is prepared before it is drilled: published (as in the paper: "
                 "marrow is not felt) or filled (all bone within the vertebra's envelope is felt); "
                 "default published");
  app.add_option("--envelope", o.envelope,
                 "label map of the vertebra from another program, with --preparation filled "
                 "(default: the envelope is found in the CT)");
  app.add_option(
      "--bone-at", o.bone_at,
      "with --preparation filled, where the envelope is found wrong: a point, in the form "
      "of --entry, with bone of this vertebra within 3 mm; may be given more than once");
  app.add_option(
      "--no-bone-at", o.no_bone_at,
      "the same, where nothing within 3 mm is bone of this vertebra (a rib, a neighbour)");
  app.add_option("--envelope-label", o.envelope_label, "label of the vertebra in it (default 1)");
  app.add_option("--observer", o.observer,
                 "whom the case must be felt by: a file of tractus-station threshold, whose "
                 "thresholds of force take the place of the assumed ones");
  app.add_option("--may-move", o.may_move,
                 "if a breach of some wall could not be told by feel: how far entry and target may "
                 "be moved together across the axis to where all can, in mm (default 0)");
  app.add_flag("--certified", o.certified,
               "refuse a case in which a breach of some wall could not be told by feel");
  app.add_option("--out", o.out, "folder of the case; it must not exist")->required();
  app.add_option("--title", o.title, "title of the case");
  app.add_option("--source", o.source,
                 "origin of the CT and its licence (default: name of the CT file)");
  app.add_option("--key", o.key,
                 "file of the signing key; it is created if it does not exist (default "
                 "~/.config/tractus/signing.key)");
  app.add_option("--png", o.png, "file for the case's picture, which shows the breach");
  app.add_flag("--json", o.json, "print the result as JSON, in SI units");
}

}  // namespace

Command carve_command() {
  return {"carve",
          "Drill a tract, with or without a breach, into a CT volume and write a signed case",
          "tractus carve --volume l3.nii.gz --entry 46,200,-61 --target 39,158,-61 --breach medial "
          "--out l3-left-medial",
          [](CLI::App& app) {
            auto options = std::make_shared<CarveOptions>();
            add_options(app, *options);
            return [options] { return run_carve(*options); };
          }};
}

}  // namespace commands
}  // namespace tractus
