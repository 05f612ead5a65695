/// `tractus diagnose`: which effect is missing from a model.
#include <fmt/format.h>

#include <memory>

#include "app/command.hpp"
#include "app/lab_report.hpp"
#include "core/progress.hpp"
#include "core/try.hpp"

namespace tractus {
namespace commands {
namespace {

struct DiagnoseOptions : LabOptions {
  std::filesystem::path out_model;
};

Outcome run_diagnose(const DiagnoseOptions& options) {
  for (const auto& file : {options.report, options.out_model}) TRY(writable(file));
  const auto opened_case = TRY(opened(options));
  lab_io::DiagnoseRequest wish{.options = {}, .report = !options.report.empty()};
  wish.options.threads = options.sources.threads;
  const auto bar = core::terminal_progress("trying effects");
  const auto answer = TRY(lab_io::diagnosed(opened_case, wish, bar));
  if (bar) bar(1.0);
  TRY(write_files(answer, options.out_model, options.report));
  fmt::print("{}", options.json ? answer.json.dump(2) + "\n" : printed_diagnosis(answer));
  return 0;
}

}  // namespace

Command diagnose_command() {
  return {.name = "diagnose",
          .summary = "Find the physical effects that a model lacks",
          .example =
              "tractus diagnose --model bone.model.json --measurements recordings/ "
              "--out-model better.model.json --report found.html",
          .make = [](CLI::App& app) -> std::function<Outcome()> {
            auto options = std::make_shared<DiagnoseOptions>();
            add_lab_options(app, *options);
            add_own_option(app, *options);
            app.add_option("--out-model", options->out_model,
                           "file for the refitted model with the effects that were found");
            return [options] { return run_diagnose(*options); };
          }};
}

}  // namespace commands
}  // namespace tractus
