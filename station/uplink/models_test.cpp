#include "station/uplink/models.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include "core/file.hpp"
#include "station/uplink/double_server.hpp"

namespace tractus {
namespace uplink {
namespace {
namespace fs = std::filesystem;

constexpr const char* kId = "0123456789abcdef0123456789abcdef";
constexpr const char* kFile = R"({"format":"tractus-model/1"})";

class SyncingModels : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = fs::temp_directory_path() / "models-XXXXXX";
    root_ = ::mkdtemp(name.data());
  }
  void TearDown() override { fs::remove_all(root_); }
  void offer(const std::string& sha256) {
    put("/api/v1/station/models",
        core::Json{
            {"models",
             {{{"id", kId}, {"name", "softer bone"}, {"rig", "probing"}, {"sha256", sha256}}}}}
            .dump());
    put(std::string("/api/v1/station/models/") + kId, kFile);
  }
  void put(const std::string& path, const std::string& text) {
    const auto bytes = core::bytes_of(text);
    server_.files[path] = core::Bytes(bytes.begin(), bytes.end());
  }
  fs::path root_;
  DoubleServer server_;
};

TEST_F(SyncingModels, KeepsWhatWasSentAndFindsItByNameAndById) {
  offer(core::sha256(core::bytes_of(kFile)));
  const auto first = sync_models(server_, root_);
  ASSERT_TRUE(first) << first.error().what;
  EXPECT_EQ(first->fetched, std::vector<std::string>{"softer bone"});
  EXPECT_EQ(server_.log.back(), std::string("POST /api/v1/station/models/") + kId + "/there");
  const fs::path kept = root_ / (std::string(kId) + ".json");
  EXPECT_TRUE(fs::exists(kept));
  EXPECT_EQ(model_named(root_, "softer bone").value(), kept);
  EXPECT_EQ(model_named(root_, "01234567").value(), kept);
  const auto second = sync_models(server_, root_);
  ASSERT_TRUE(second) << second.error().what;
  EXPECT_EQ(second->present, std::vector<std::string>{"softer bone"});
}

TEST_F(SyncingModels, ForgetsWhatWasRecalled) {
  offer(core::sha256(core::bytes_of(kFile)));
  ASSERT_TRUE(sync_models(server_, root_));
  put("/api/v1/station/models", R"({"models": []})");
  const auto report = sync_models(server_, root_);
  ASSERT_TRUE(report) << report.error().what;
  EXPECT_EQ(report->recalled, std::vector<std::string>{"softer bone"});
  EXPECT_FALSE(fs::exists(root_ / (std::string(kId) + ".json")));
  EXPECT_FALSE(model_named(root_, "softer bone"));
}

TEST_F(SyncingModels, RefusesAFileThatIsNotWhatWasNamed) {
  offer(std::string(64, 'a'));
  const auto report = sync_models(server_, root_);
  ASSERT_TRUE(report) << report.error().what;
  EXPECT_EQ(report->refused.size(), 1u);
  EXPECT_FALSE(fs::exists(root_ / (std::string(kId) + ".json")));
}

TEST_F(SyncingModels, SaysWhatThereIsWhenANameIsUnknown) {
  const auto none = model_named(root_, "harder bone");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, core::Errc::not_found);
  EXPECT_NE(none.error().what.find("none was"), std::string::npos);
}

}  // namespace
}  // namespace uplink
}  // namespace tractus
