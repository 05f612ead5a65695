/// `tractus compare`: a model beside measurements.
#include <fmt/format.h>

#include <memory>

#include "app/command.hpp"
#include "app/lab_report.hpp"
#include "core/try.hpp"

namespace tractus {
namespace commands {
namespace {

Outcome run_compare(const LabOptions& options) {
  TRY(writable(options.report));
  const auto opened_case = TRY(opened(options));
  const auto answer = lab_io::compared(opened_case);
  TRY(write_files(answer, {}, options.report));
  fmt::print("{}", options.json ? answer.json.dump(2) + "\n" : printed_comparison(answer));
  return 0;
}

}  // namespace

Command compare_command() {
  return {.name = "compare",
          .summary = "Compare a model with measurements: size of the error, and where it is large",
          .example =
              "tractus compare --model bone.model.json --measurements recordings/ "
              "--report compared.html",
          .make = [](CLI::App& app) -> std::function<Outcome()> {
            auto options = std::make_shared<LabOptions>();
            add_lab_options(app, *options);
            return [options] { return run_compare(*options); };
          }};
}

}  // namespace commands
}  // namespace tractus
