#include "station/uplink/clock_offset.hpp"

#include <gtest/gtest.h>

namespace tractus {
namespace uplink {
namespace {

/// A server whose clock is 2.5 s ahead, over a line whose ways there and back take what is said.
class Distant final : public Server {
 public:
  explicit Distant(core::ManualClock& clock) : clock_(clock) {}
  core::Result<HttpResponse> send(const Request&) override {
    const auto [there_ms, back_ms] = ways_ms[std::size_t(asked++) % ways_ms.size()];
    clock_.advance(there_ms * 1'000'000);
    const std::string text = core::Json{{"server_utc_us", clock_.now() / 1000 + 2'500'000}}.dump();
    clock_.advance(back_ms * 1'000'000);
    const auto bytes = core::bytes_of(text);
    return HttpResponse{200, core::Bytes(bytes.begin(), bytes.end())};
  }
  std::vector<std::pair<int, int>> ways_ms{{5, 5}};
  int asked = 0;

 private:
  core::ManualClock& clock_;
};

class ClockOffsets : public testing::Test {
 protected:
  core::Result<ClockOffset> measure() {
    return measure_clock(server_, clock_, [this] { return clock_.now() / 1000; });
  }
  core::ManualClock clock_;
  Distant server_{clock_};
};

TEST_F(ClockOffsets, AreExactWhenBothWaysTakeAsLong) {
  const auto measured = measure();
  ASSERT_TRUE(measured);
  EXPECT_NEAR(measured->offset_s, 2.5, 1e-6);
  EXPECT_NEAR(measured->error_s, 0.005, 1e-9);
}

TEST_F(ClockOffsets, AreTakenFromTheShortestRoundTripAndLieWithinTheirBound) {
  server_.ways_ms = {{200, 10}, {90, 300}, {9, 1}, {70, 70}};
  const auto measured = measure();
  ASSERT_TRUE(measured);
  EXPECT_EQ(server_.asked, kTries);
  EXPECT_NEAR(measured->error_s, 0.005, 1e-9);   // half of 9 + 1 ms
  EXPECT_NEAR(measured->offset_s, 2.504, 1e-6);  // off by (9 − 1)/2 ms
  EXPECT_LE(std::abs(measured->offset_s - 2.5), measured->error_s);
}

}  // namespace
}  // namespace uplink
}  // namespace tractus
