/// The description of the API, held to by a linter that others use (Redocly, tests/openapi).
#include <gtest/gtest.h>
#include <unistd.h>

#include <checkout.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/json.hpp"
#include "tests/support/server/process.hpp"

namespace tractus {
namespace {
namespace fs = std::filesystem;

const fs::path kLinter = fs::path(checkout::kSource) / "tests/openapi";

class OpenApi : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::system("node --version > /dev/null 2>&1") != 0)
      GTEST_SKIP() << "linting of the API's description: node is not installed";
    if (!fs::exists(kLinter / "node_modules/@redocly/cli"))
      GTEST_SKIP() << "linting of the API's description: run npm ci in tests/openapi first";
    const auto said = world::run_program("tractus-server", {"openapi"});
    ASSERT_EQ(said.code, 0) << said.out;
    described_ = core::Json::parse(said.out, nullptr, false);
    ASSERT_TRUE(described_.is_object());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  /// What the linter says, and whether it is content.
  std::pair<bool, std::string> linted(const core::Json& description) {
    const fs::path file = folder_ / "openapi.json";
    std::ofstream(file) << description.dump();
    const std::string command = "cd " + kLinter.string() +
                                " && node node_modules/@redocly/cli/bin/cli.js lint --config "
                                "redocly.yaml --format stylish " +
                                file.string() + " 2>&1";
    std::FILE* out = ::popen(command.c_str(), "r");
    std::string said;
    std::array<char, 4096> piece{};
    while (const std::size_t n = std::fread(piece.data(), 1, piece.size(), out))
      said.append(piece.data(), n);
    return {::pclose(out) == 0, said};
  }
  fs::path folder_ =
      fs::path(::testing::TempDir()) / ("tractus-openapi-" + std::to_string(::getpid()));
  core::Json described_;
};

TEST_F(OpenApi, HasNothingThatALinterFinds) {
  const auto [fine, said] = linted(described_);
  EXPECT_TRUE(fine) << said;
  EXPECT_NE(said.find("Your API description is valid"), std::string::npos) << said;
  EXPECT_GT(described_["paths"].size(), 60u);
}

TEST_F(OpenApi, TheLinterFindsWhatIsPlanted) {
  core::Json twice = described_, dangling = described_;
  twice["paths"]["/api/v1/session"]["get"]["operationId"] = "signIn";
  EXPECT_FALSE(linted(twice).first);
  dangling["components"]["schemas"].erase("Error");
  EXPECT_FALSE(linted(dangling).first);
}

}  // namespace
}  // namespace tractus
