/// `tractus fmu`: a model for other simulation tools.
#include <fmt/format.h>

#include <memory>

#include "app/command.hpp"
#include "app/fmu_field.hpp"
#include "app/lengths.hpp"
#include "core/try.hpp"
#include "fmu/package.hpp"

namespace tractus {
namespace commands {
namespace {

namespace fs = std::filesystem;
using core::Errc;
using core::Error;
using core::Result;

struct FmuOptions {
  fs::path model, out, measurements;
  std::vector<std::string> box;
  std::string margin;
};

Result<FieldOptions> field_options(const FmuOptions& options) {
  FieldOptions out;
  out.measurements = options.measurements;
  for (const std::string& corner : options.box) {
    const auto at = TRY(point_m(corner, "--box"));
    out.box_m.push_back(at);
  }
  if (!options.box.empty() && !options.margin.empty())
    return Error{Errc::bad_input, "--margin goes with --measurements; a --box is taken as it is"};
  if (!options.margin.empty()) out.margin_m = TRY(length_m(options.margin, "--margin"));
  if (!(out.margin_m >= 0.0))
    return Error{Errc::out_of_range, "--margin: below 0, a length is expected"};
  return out;
}

Result<void> write(const models::ProbingModel& model, const FmuOptions& options) {
  if (!options.measurements.empty() || !options.box.empty() || !options.margin.empty())
    return Error{Errc::bad_input,
                 "a model of the probing rig has no volume; --measurements, --box and --margin are "
                 "for the palpation rig"};
  const auto runtime = TRY(fmu::runtime_path(model.effects));
  return fmu::write_fmu(model, {runtime, options.out, TRACTUS_VERSION});
}

Result<void> write(const models::PalpationModel& model, const FmuOptions& options) {
  const auto runtime = TRY(fmu::runtime_path(model.effects));
  const auto field = TRY(carried_field(model, options.model, TRY(field_options(options))));
  TRY(fmu::write_fmu(model, field, {runtime, options.out, TRACTUS_VERSION}));
  const auto& [begin, end] = field.part.box;
  fmt::print("{} × {} × {} voxels of the field, {:.1f} MiB\n", end[0] - begin[0], end[1] - begin[1],
             end[2] - begin[2], double(fmu::opacity_bytes(field).size()) / (1 << 20));
  return {};
}

Outcome run_fmu(const FmuOptions& options) {
  const auto model = TRY(models::read_model(options.model));
  const auto written = std::visit([&](const auto& m) { return write(m, options); }, model);
  if (!written)
    return Error{written.error().code,
                 fmt::format("{}: {}", options.model.string(), written.error().what)};
  fmt::print("Written to {}\n", options.out.string());
  if (std::visit([](const auto& m) { return fmu::has_formula(m.effects); }, model))
    fmt::print(
        "It has a formula: where it runs, the library muParser is needed (libmuparser.so.2, "
        "Debian's libmuparser2v5).\n");
  return 0;
}

}  // namespace

Command fmu_command() {
  return {
      .name = "fmu",
      .summary =
          "Write a model as an FMU, which other simulation tools run (FMI 2.0, co-simulation)",
      .example = "tractus fmu better.model.json --out bone.fmu",
      .make = [](CLI::App& app) -> std::function<Outcome()> {
        auto options = std::make_shared<FmuOptions>();
        app.add_option("model", options->model, "model file in the format tractus-model/1")
            ->required();
        app.add_option("--out", options->out, "file for the FMU")->required();
        app.add_option("--measurements", options->measurements,
                       "palpation: recordings (a folder with set.json, or a zip of it); the FMU "
                       "carries the part of the volume that they reach, and their \"down\"");
        app.add_option("--margin", options->margin,
                       "palpation: how far beyond what they reach, in mm or with a unit; 5 mm if "
                       "not given");
        app.add_option("--box", options->box,
                       "palpation: two corners of the part to carry, in the volume's frame, as "
                       "12,-40,110 in mm or with a unit")
            ->expected(2);
        return [options] { return run_fmu(*options); };
      }};
}

}  // namespace commands
}  // namespace tractus
