/// `tractus fit`: a model's parameters fitted to measurements, with effects added by hand.
#include <fmt/format.h>

#include <memory>

#include "app/command.hpp"
#include "app/lab_report.hpp"
#include "core/progress.hpp"
#include "core/try.hpp"

namespace tractus {
namespace commands {
namespace {

struct FitOptions : LabOptions {
  std::filesystem::path out;
  std::vector<std::string> add;
};

Outcome run_fit(const FitOptions& options) {
  for (const auto& file : {options.report, options.out}) TRY(writable(file));
  const auto opened_case = TRY(opened(options));
  const auto bar = core::terminal_progress("fitting");
  const auto answer = TRY(lab_io::fitted(opened_case, options.add, options.sources.threads, bar));
  if (bar) bar(1.0);
  TRY(write_files(answer, options.out, options.report));
  fmt::print("{}", options.json ? answer.json.dump(2) + "\n" : printed_fit(answer));
  return 0;
}

}  // namespace

Command fit_command() {
  return {.name = "fit",
          .summary = "Fit a model to measurements, with the effects that you add",
          .example =
              "tractus fit --model bone.model.json --measurements recordings/ "
              "--add coulomb_friction --add inertia --out better.model.json",
          .make = [](CLI::App& app) -> std::function<Outcome()> {
            auto options = std::make_shared<FitOptions>();
            add_lab_options(app, *options);
            app.add_option("--add", options->add,
                           "id of an effect to add (see tractus effects); may be repeated")
                ->expected(1, 64)
                ->allow_extra_args(false);
            add_own_option(app, *options);
            app.add_option("--out", options->out, "file for the fitted model")->required();
            return [options] { return run_fit(*options); };
          }};
}

}  // namespace commands
}  // namespace tractus
