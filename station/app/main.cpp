/// `tractus-station`: one training station.
#include <sys/stat.h>

#include <csignal>
#include <cstdio>

#include "core/words.hpp"
#include "station/app/commands.hpp"

int main(int argc, char** argv) {
  using namespace tractus;
  ::umask(0077);  // whatever it makes is its owner's alone
  const app::Parsed parsed = app::parse(argc, argv);
  if (parsed.leave) return *parsed.leave;
  std::signal(SIGINT, [](int) { app::ask_to_stop(); });
  std::signal(SIGTERM, [](int) { app::ask_to_stop(); });
  const auto outcome = parsed.options.command(parsed.options);
  if (outcome) return *outcome;
  std::fprintf(stderr, "%s\n", core::one_line(outcome.error().what, 4000).c_str());
  return 2;
}
