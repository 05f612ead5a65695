/// `tractus`: everything on files, with no server.
#include <cstdio>

#include "app/command.hpp"
#include "core/progress.hpp"
#include "core/words.hpp"

int main(int argc, char** argv) {
  using namespace tractus;
  CLI::App app(
      "Tractus: tools for files of pedicle-screw training: volumes, cases, trials, models, "
      "measurements",
      "tractus");
  app.set_version_flag("--version", TRACTUS_VERSION);
  app.require_subcommand(1);
  const auto catalogue = commands::all();
  std::vector<std::pair<CLI::App*, std::function<commands::Outcome()>>> made;
  for (const auto& command : catalogue) {
    CLI::App* sub = app.add_subcommand(command.name, command.summary);
    sub->footer("Example:\n  " + command.example);
    made.emplace_back(sub, command.make(*sub));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& failure) {
    if (failure.get_exit_code() == 0) return app.exit(failure);
    std::fprintf(stderr, "tractus: %s (see --help)\n", failure.what());
    return 2;
  }
  core::stop_on_signals();
  for (auto& [sub, run] : made) {
    if (!sub->parsed()) continue;
    const auto outcome = run();
    if (outcome) return *outcome;
    std::fprintf(stderr, "%s\n", core::one_line(outcome.error().what, 4000).c_str());
    return 2;
  }
  return 2;
}
