/// `tractus compare`: a model beside measurements.
#include <fmt/format.h>

#include <memory>

#include "app/command.hpp"
#include "app/lab_report.hpp"

namespace tractus {
namespace commands {
namespace {

Outcome run(const LabOptions& options) {
  if (auto ready = writable(options.report); !ready) return ready.error();
  const auto opened_case = opened(options);
  if (!opened_case) return opened_case.error();
  const auto answer = lab_io::compared(*opened_case);
  if (auto written = write_files(answer, {}, options.report); !written) return written.error();
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
            return [options] { return run(*options); };
          }};
}

}  // namespace commands
}  // namespace tractus
