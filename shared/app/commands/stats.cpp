/// `tractus stats`: the study's analyses on a CSV file, one method per file of
/// assessment/methods.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <memory>

#include "app/command.hpp"
#include "assessment/report.hpp"
#include "core/file.hpp"
#include "core/progress.hpp"
#include "core/try.hpp"

namespace tractus {
namespace commands {
namespace {

struct StatsOptions {
  std::string data, formula, svg;
  bool json = false, drop_missing = false;
  std::map<std::string, std::string> more;
};

Outcome run_stats(const assessment::Method& method, const StatsOptions& o) {
  core::Result<assessment::Findings> found = core::Error{core::Errc::bad_input, ""};
  std::map<std::string, std::string> given;
  for (const auto& [name, value] : o.more)
    if (!value.empty()) given.emplace(name, value);
  const auto progress = core::terminal_progress(method.id);
  if (method.formula.empty()) {
    found = assessment::run(method, given, progress);
  } else {
    const auto formula = TRY(assessment::parse_formula(o.formula));
    const auto missing = o.drop_missing ? assessment::Missing::drop : assessment::Missing::refuse;
    const auto table = TRY(assessment::Table::read(o.data, formula.columns(), missing));
    const auto options = TRY(assessment::complete(method, given));
    found = method.run({formula, table, o.formula, options, progress});
  }
  if (!found) return found.error();
  if (!o.svg.empty()) {
    if (found->figures.empty())
      return core::Error{core::Errc::bad_input, "--svg: " + method.id + " draws no picture"};
    plot::Figure figure = found->figures[0];
    figure.title = o.formula;
    TRY(core::write_file(o.svg, core::bytes_of(plot::svg(figure))));
  }
  if (o.json)
    std::puts(found->report.dump(2, ' ', false, core::Json::error_handler_t::replace).c_str());
  else
    std::fputs(assessment::printed(found->report).c_str(), stdout);
  return 0;
}

std::string example_of(const assessment::Method& method) {
  if (method.id == "looks")
    return "tractus stats looks --at 4 --power 0.9\n"
           "  tractus stats looks --at \"0.3 0.7 1\" --spending pocock";
  if (method.formula.empty())
    return "tractus stats power --test repeated --effect 0.25 --levels 3 --power 0.8\n"
           "  28 people\n"
           "  tractus stats power --test correlation --effect 0.3065 --n 10\n"
           "  tractus stats power --test mixed --effect -0.2 --trials 12 --scenarios 4 "
           "--surgeon-sd 1 --slope-sd 0.1";
  return fmt::format("tractus stats {} --data trials.csv --formula \"{}\" --json", method.id,
                     method.formula);
}

void add_method(CLI::App& app, const assessment::Method& method,
                const std::shared_ptr<StatsOptions>& options, std::string& chosen) {
  CLI::App* sub = app.add_subcommand(method.id, method.summary);
  sub->footer("Example:\n  " + example_of(method));
  if (!method.formula.empty()) {
    sub->add_option("--data", options->data, "CSV file with a header line")->required();
    sub->add_option("--formula", options->formula,
                    "y ~ x + C(number) + a*b + a:b + I(x^2) + log(x) + (1|subject); 0 for no "
                    "intercept; successes/trials on the left for counts. Here: " +
                        method.formula)
        ->required();
    sub->add_flag("--drop-missing", options->drop_missing,
                  "leave out rows with an empty cell in a used column, and print their number");
    sub->add_option("--svg", options->svg, "SVG file for the first picture of the analysis");
  }
  for (const auto& option : method.options) {
    std::string meaning = option.meaning;
    if (!option.choices.empty()) meaning += fmt::format(": {}", fmt::join(option.choices, ", "));
    if (!option.fallback.empty()) meaning += " [" + option.fallback + "]";
    sub->add_option("--" + option.name, options->more[option.name], meaning);
  }
  sub->add_flag("--json", options->json, "print the result as JSON, with all digits");
  sub->callback([&chosen, id = method.id] { chosen = id; });
}

/// The published worked example: wrong breach answers of ten surgeons against years of experience.
constexpr const char* kExample =
    "tractus stats ols --data surgeons.csv --formula \"wrong_breach ~ experience_years\"\n"
    "  where surgeons.csv contains the published Table 2 (wrong answers in 6 breach trials):\n"
    "    surgeon,experience_years,wrong_breach\n"
    "    1,6,2\n    2,3,1\n    3,1,0\n    4,1,1\n    5,0.5,0\n"
    "    6,0.33,0\n    7,0.1,0\n    8,0,3\n    9,0,1\n    10,0,1\n"
    "  It prints the published Table 3: years 0.1588, SE 0.1744, t 0.9106, p 0.3891, and a\n"
    "  warning that surgeon 1 dominates the fit.\n"
    "  tractus stats rm-anova --data trials.csv --formula \"velocity ~ scenario*repetition + "
    "(1|surgeon)\"\n"
    "  tractus stats METHOD --help   shows the options of METHOD";

}  // namespace

Command stats_command() {
  return {"stats",
          "Analyse a CSV file: regression, ANOVA, mixed models, recognition, learning curves",
          kExample, [](CLI::App& app) {
            auto options = std::make_shared<StatsOptions>();
            auto chosen = std::make_shared<std::string>();
            app.require_subcommand(1);
            for (const auto& method : assessment::methods::all())
              add_method(app, method, options, *chosen);
            return [options, chosen]() -> Outcome {
              const auto method = TRY(assessment::method_named(*chosen));
              return run_stats(method, *options);
            };
          }};
}

}  // namespace commands
}  // namespace tractus
