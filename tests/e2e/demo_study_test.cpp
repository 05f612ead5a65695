/// The demo study, run as a person runs it: it judges itself, by counts, hashes and what stations
/// could tell.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <checkout.hpp>
#include <cstdlib>
#include <string>

namespace tractus {
namespace {

int exit_of_demo(const std::string& options) {
  const std::string command = std::string("TRACTUS_BIN=") + checkout::kBin + " " +
                              checkout::kSource + "/deploy/demo-study " + options;
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(DemoStudy, EndsWithEverySampleOnTheServerThoughAStationIsKilledAndTellsNothing) {
  EXPECT_EQ(exit_of_demo(""), 0);
}

TEST(DemoStudy, EndsSoThoughTheServerIsKilledTooAndStationsGoOnWithoutIt) {
  EXPECT_EQ(exit_of_demo("--kill-server"), 0);
}

}  // namespace
}  // namespace tractus
