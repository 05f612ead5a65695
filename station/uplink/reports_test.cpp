#include "station/uplink/reports.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include "core/file.hpp"

namespace tractus {
namespace uplink {
namespace {
namespace fs = std::filesystem;

/// Takes what holds "good", refuses what holds "bad", is away for the rest.
class Taking final : public Server {
 public:
  core::Result<HttpResponse> send(const Request& request) override {
    const std::string body(core::text_of(request.body));
    if (body.find("good") != std::string::npos) return taken.push_back(body), HttpResponse{204, {}};
    if (body.find("bad") != std::string::npos) return HttpResponse{400, {}};
    return core::Error{core::Errc::unavailable, "nobody there"};
  }
  std::vector<std::string> taken;
};

class Reports : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = fs::temp_directory_path() / "reports-XXXXXX";
    folder_ = ::mkdtemp(name.data());
  }
  void TearDown() override { fs::remove_all(folder_); }
  void put(const std::string& name, const std::string& text) {
    ASSERT_TRUE(core::write_file(folder_ / name, core::bytes_of(text)));
  }
  fs::path folder_;
  Taking server_;
};

TEST_F(Reports, GoOnceTheServerHasThem) {
  put("2.json", R"({"version":"good 2"})");
  put("1.json", R"({"version":"good 1"})");
  const auto handed = hand_over_reports(server_, folder_);
  ASSERT_TRUE(handed);
  EXPECT_EQ(handed->handed_over, 2);
  EXPECT_EQ(server_.taken.front(), R"({"version":"good 1"})") << "oldest first";
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(Reports, ThatAreRefusedAreSetAsideAndDoNotHoldUpTheNext) {
  put("1.json", R"({"version":"bad"})");
  put("2.json", R"({"version":"good"})");
  const auto handed = hand_over_reports(server_, folder_);
  ASSERT_TRUE(handed);
  EXPECT_EQ(handed->handed_over, 1);
  EXPECT_EQ(handed->refused.size(), 1u);
  EXPECT_TRUE(fs::exists(folder_ / "1.refused"));
}

TEST_F(Reports, StayWhileTheServerIsAway) {
  put("1.json", R"({"version":"x"})");
  EXPECT_FALSE(hand_over_reports(server_, folder_));
  EXPECT_TRUE(fs::exists(folder_ / "1.json"));
  EXPECT_TRUE(hand_over_reports(server_, folder_ / "none")) << "no folder, nothing to do";
}

}  // namespace
}  // namespace uplink
}  // namespace tractus
