/// Refusals in the audit trail: noted, and too few to flood it.
#include "server/api/refusals.hpp"

#include "server/api/people/people_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using testing::PeopleTest;

constexpr std::int64_t kRefusalWindow_us = 60'000'000;

class Refusals : public PeopleTest {
 protected:
  /// Of what people and stations did.
  core::Json rows() {
    const core::Json trail = json(get("ann", "/audit?limit=100"));
    core::Json out = core::Json::array();
    for (const auto& row : trail["rows"])
      if (row["role"] != store::kServer) out.push_back(row);
    return out;
  }
};

TEST_F(Refusals, WhoAsksForWhatIsNotTheirsIsNotedWithWhatAndWhose) {
  EXPECT_EQ(get("tom", "/accounts").status, 403);
  EXPECT_EQ(get("tom", "/trials/" + trial_of("tia")).status, 404);
  EXPECT_EQ(ask(request("GET", "/api/v1/trials", station("token-1"))).status, 403);
  const auto all = rows();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[2]["what"], "refused: accounts");
  EXPECT_EQ(all[2]["who"], "tom");
  EXPECT_EQ(all[1]["what"], "refused: trial");
  EXPECT_EQ(all[1]["object"], "id=" + trial_of("tia"));
  EXPECT_EQ(all[0]["who"], "station-1");
  EXPECT_EQ(all[0]["role"], "station");
  // What is not there for anybody is no refusal.
  EXPECT_EQ(get("ann", "/trials/" + std::string(32, 'f')).status, 404);
  EXPECT_EQ(rows().size(), 3u);
}

TEST_F(Refusals, AFloodLeavesTenRowsAndItsCount) {
  const auto cookie = as("tom");
  for (int i = 0; i < 200; ++i)
    EXPECT_EQ(ask(request("GET", "/api/v1/accounts", cookie)).status, 403);
  EXPECT_EQ(rows().size(), 10u);
  EXPECT_EQ(get("tia", "/accounts").status, 403);  // another is noted none the less
  EXPECT_EQ(rows()[0]["detail"]["refusals_not_noted"], 190);
  now_ += kRefusalWindow_us;
  for (int i = 0; i < 20; ++i) ask(request("GET", "/api/v1/accounts", cookie));
  EXPECT_EQ(rows().size(), 16u);  // five a minute
}

TEST(RefusalLimit, HoldsAllCallersTogetherToOneRateInBoundedMemory) {
  RefusalLimit limit;
  int noted = 0;
  for (int caller = 0; caller < 5000; ++caller)
    noted += limit.turn("caller-" + std::to_string(caller), 1).has_value() ? 1 : 0;
  EXPECT_EQ(noted, 120);
  EXPECT_TRUE(limit.turn("later", 1 + kRefusalWindow_us).has_value());
}

}  // namespace
}  // namespace api
}  // namespace tractus
