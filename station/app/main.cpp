/// `tractus-station`: one training station.
#include <csignal>
#include <cstdio>

#include "core/words.hpp"
#include "station/app/deeds.hpp"

namespace {
core::Result<int> done(const app::Options& options) {
  switch (options.deed) {
    case app::Deed::run:
      return app::run_trials(options);
    case app::Deed::probe:
      return app::run_probing_trials(options);
    case app::Deed::tune:
      return app::tune_scenario(options);
    case app::Deed::study:
      return app::run_study(options);
    case app::Deed::sync:
      return app::sync_cases(options);
    case app::Deed::upload:
      return app::upload_trials(options);
    case app::Deed::assigned:
      return app::run_assigned(options);
    case app::Deed::enrol:
      return app::enrol_station(options);
    case app::Deed::limits:
      return app::show_limits(options);
    case app::Deed::trust:
      return app::trust_signer(options);
  }
  return 2;
}
}  // namespace

int main(int argc, char** argv) {
  const app::Parsed parsed = app::parse(argc, argv);
  if (parsed.leave) return *parsed.leave;
  std::signal(SIGINT, [](int) { app::ask_to_stop(); });
  std::signal(SIGTERM, [](int) { app::ask_to_stop(); });
  const auto outcome = done(parsed.options);
  if (outcome) return *outcome;
  std::fprintf(stderr, "%s\n", core::one_line(outcome.error().what, 4000).c_str());
  return 2;
}
