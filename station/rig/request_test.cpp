#include "station/rig/request.hpp"

#include <gtest/gtest.h>

#include <random>

namespace tractus {
namespace rig {
namespace {

using Bytes = std::vector<std::uint8_t>;

// The byte sequences are the examples of the Modbus application protocol V1.1b3, sections 6.3, 6.6,
// 6.12 and 6.17.
TEST(Request, TakesTheStandardsExamplesApart) {
  const auto read = parse_request(Bytes{0x03, 0x00, 0x6B, 0x00, 0x03});
  ASSERT_TRUE(read);
  EXPECT_EQ(read->read_start, 107);
  EXPECT_EQ(read->read_count, 3);
  EXPECT_TRUE(read->values.empty());
  const auto one = parse_request(Bytes{0x06, 0x00, 0x01, 0x00, 0x03});
  ASSERT_TRUE(one);
  EXPECT_EQ(one->write_start, 1);
  EXPECT_EQ(one->values, std::vector<std::uint16_t>{3});
  const auto many =
      parse_request(Bytes{0x10, 0x00, 0x01, 0x00, 0x02, 0x04, 0x00, 0x0A, 0x01, 0x02});
  ASSERT_TRUE(many);
  EXPECT_EQ(many->values, (std::vector<std::uint16_t>{10, 0x102}));
  const auto both = parse_request(Bytes{0x17, 0x00, 0x03, 0x00, 0x06, 0x00, 0x0E, 0x00, 0x03, 0x06,
                                        0x00, 0xFF, 0x00, 0xFF, 0x00, 0xFF});
  ASSERT_TRUE(both);
  EXPECT_EQ(both->read_start, 3);
  EXPECT_EQ(both->read_count, 6);
  EXPECT_EQ(both->write_start, 14);
  EXPECT_EQ(both->values, (std::vector<std::uint16_t>{255, 255, 255}));
}

TEST(Request, RefusesWhatContradictsItself) {
  EXPECT_FALSE(parse_request(Bytes{}));
  EXPECT_FALSE(parse_request(Bytes{0x03}));
  EXPECT_FALSE(parse_request(Bytes{0x03, 0x00, 0x00, 0x00, 0x00}));        // none
  EXPECT_FALSE(parse_request(Bytes{0x03, 0x00, 0x00, 0x00, 0x7E}));        // 126
  EXPECT_FALSE(parse_request(Bytes{0x03, 0x00, 0x00, 0x00, 0x01, 0x00}));  // a byte too many
  EXPECT_FALSE(parse_request(Bytes{0x10, 0x00, 0x01, 0x00, 0x02, 0x02, 0x00, 0x0A}));
  EXPECT_FALSE(parse_request(Bytes{0x10, 0x00, 0x01, 0x00, 0x02, 0x04, 0x00, 0x0A}));
  EXPECT_FALSE(parse_request(Bytes{0x17, 0x00, 0x03, 0x00, 0x06}));
  EXPECT_FALSE(is_offered(0x2B));
}

TEST(Request, SurvivesAnyBytes) {
  std::mt19937 random(5);
  int taken = 0;
  for (int k = 0; k < 200000; ++k) {
    Bytes bytes(random() % 24);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random() % 32);
    if (const auto request = parse_request(bytes)) {
      ++taken;
      ASSERT_LE(request->read_count, 125);
      ASSERT_LT(2 * request->values.size(), bytes.size());
    }
  }
  EXPECT_GT(taken, 0);
}

}  // namespace
}  // namespace rig
}  // namespace tractus
