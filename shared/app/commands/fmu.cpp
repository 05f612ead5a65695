/// `tractus fmu`: a model for other simulation tools.
#include <fmt/format.h>

#include <memory>

#include "app/command.hpp"
#include "core/try.hpp"
#include "fmu/package.hpp"

namespace tractus {
namespace commands {
namespace {

namespace fs = std::filesystem;
using core::Errc;
using core::Error;

struct FmuOptions {
  fs::path model, out;
};

Outcome run_fmu(const FmuOptions& options) {
  const auto model = TRY(models::read_model(options.model));
  const auto* probing = std::get_if<models::ProbingModel>(&model);
  if (!probing)
    return Error{
        Errc::bad_input,
        fmt::format("{}: a model of the palpation rig needs its volume and runs in no FMU; "
                    "tractus replay gives its forces for a recorded motion",
                    options.model.string())};
  const auto runtime = TRY(fmu::runtime_path(*probing));
  auto written = fmu::write_fmu(*probing, runtime, options.out, TRACTUS_VERSION);
  if (!written)
    return Error{written.error().code,
                 fmt::format("{}: {}", options.model.string(), written.error().what)};
  fmt::print("Written to {}\n", options.out.string());
  if (fmu::has_formula(*probing))
    fmt::print(
        "It has a formula: where it runs, the library muParser is needed (libmuparser.so.2, "
        "Debian's libmuparser2v5).\n");
  return 0;
}

}  // namespace

Command fmu_command() {
  return {.name = "fmu",
          .summary =
              "Write a model of the probing rig as an FMU, which other simulation tools run "
              "(FMI 2.0, co-simulation)",
          .example = "tractus fmu better.model.json --out bone.fmu",
          .make = [](CLI::App& app) -> std::function<Outcome()> {
            auto options = std::make_shared<FmuOptions>();
            app.add_option("model", options->model, "model file in the format tractus-model/1")
                ->required();
            app.add_option("--out", options->out, "file for the FMU")->required();
            return [options] { return run_fmu(*options); };
          }};
}

}  // namespace commands
}  // namespace tractus
