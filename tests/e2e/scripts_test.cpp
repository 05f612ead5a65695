/// The guide's examples for scripts, run as a reader runs them, against the real server.
#include <gtest/gtest.h>

#include <checkout.hpp>
#include <cstdlib>
#include <filesystem>

#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/json.hpp"
#include "tests/support/server/process.hpp"

namespace tractus {
namespace {
using namespace world;
namespace fs = std::filesystem;

const fs::path kExamples = fs::path(checkout::kSource) / "web/src/features/guide/scripts";

class Scripts : public ::testing::Test {
 protected:
  void SetUp() override {
    client_.speak_to(server_.port());
    admin_ = world_.admin(client_);
    admin_["content-type"] = "application/json";
    const core::Json wish{{"name", "example"},
                          {"scopes", {"trials:read", "cohort:read"}},
                          {"expires_utc_us", core::utc_us() + 3600ll * 1'000'000},
                          {"password", ServedWorld::kPassword}};
    const Answer made = client_.ask("POST", "/api/v1/tokens", admin_, wish.dump());
    ASSERT_EQ(made.status, 201) << made.body;
    token_ = made.json()["token"];
    id_ = made.json()["entry"]["id"];
    ::setenv("TRACTUS_TOKEN", token_.c_str(), 1);
    ::setenv("TRACTUS_URL", ("http://127.0.0.1:" + std::to_string(server_.port())).c_str(), 1);
  }
  static bool has(const std::string& program) {
    return std::system(("command -v " + program + " > /dev/null 2>&1").c_str()) == 0;
  }
  /// The exit status; what it prints is in `said`.
  int run(const std::string& program, const std::string& file) {
    const fs::path out = world_.folder / "said";
    const int status = std::system(("cd " + world_.folder.string() + " && " + program + " " +
                                    (kExamples / file).string() + " > " + out.string() + " 2>&1")
                                       .c_str());
    said = std::string(core::text_of(core::read_file(out).value()));
    return status;
  }
  std::string table() {
    return std::string(core::text_of(core::read_file(world_.folder / "trials.csv").value()));
  }

  ServedWorld world_;
  ServerProcess server_{world_.data};
  Client client_;
  Headers admin_;
  std::string token_, id_, said;
};

TEST_F(Scripts, CurlReadsTrialsAndSavesTheTable) {
  if (!has("curl")) GTEST_SKIP() << "curl is not installed";
  EXPECT_EQ(run("sh -eu", "trials.sh"), 0) << said;
  EXPECT_NE(said.find("\"name\":\"admin\""), std::string::npos) << said;
  EXPECT_NE(said.find("\"trials\":[]"), std::string::npos) << said;
  EXPECT_TRUE(table().starts_with("trial,")) << table();
  const Answer revoked = client_.ask("DELETE", "/api/v1/tokens/" + id_, admin_);
  EXPECT_EQ(revoked.status, 204);
  EXPECT_NE(run("sh -eu", "trials.sh"), 0);
  EXPECT_NE(said.find("revoked"), std::string::npos) << said;
}

TEST_F(Scripts, PythonSavesTheTable) {
  if (!has("python3")) GTEST_SKIP() << "python3 is not installed";
  EXPECT_EQ(run("python3", "trials.py"), 0) << said;
  EXPECT_TRUE(table().starts_with("trial,")) << table();
}

TEST_F(Scripts, RReadsTheTable) {
  if (!has("Rscript")) GTEST_SKIP() << "R is not installed";
  EXPECT_EQ(run("Rscript", "trials.R"), 0) << said;
  EXPECT_EQ(said, "[1] 0\n");
}

}  // namespace
}  // namespace tractus
