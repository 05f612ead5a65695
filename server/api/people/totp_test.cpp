#include "server/api/people/totp.hpp"

#include <gtest/gtest.h>

namespace tractus {
namespace api {
namespace {

const std::string kSeed = "12345678901234567890";

/// RFC 6238, appendix B: the times and SHA-1 codes of its table, of whose eight digits the last six
/// are the code of six digits (RFC 4226 section 5.3: both are remainders of one number).
TEST(OneTimeCodes, AreThoseOfTheStandardsTable) {
  struct Row {
    std::uint64_t time_s;
    const char* code;
  };
  for (const Row& row :
       {Row{59, "287082"}, Row{1111111109, "081804"}, Row{1111111111, "050471"},
        Row{1234567890, "005924"}, Row{2000000000, "279037"}, Row{20000000000, "353130"}})
    EXPECT_EQ(hotp(core::bytes_of(kSeed), row.time_s / 30), row.code) << row.time_s;
}

/// RFC 4226, appendix D.
TEST(OneTimeCodes, OfCountersAreThoseOfTheStandardsTable) {
  const char* const codes[] = {"755224", "287082", "359152", "969429", "338314",
                               "254676", "287922", "162583", "399871", "520489"};
  for (std::uint64_t i = 0; i < 10; ++i) EXPECT_EQ(hotp(core::bytes_of(kSeed), i), codes[i]);
}

TEST(OneTimeCodes, AreTakenOnceAndAStepToEitherSide) {
  const auto secret = core::bytes_of(kSeed);
  const std::int64_t at_us = 59'000'000;  // step 1; its code: the last six digits of 94287082
  EXPECT_EQ(totp_step(secret, "287082", at_us, 0), 1);
  EXPECT_EQ(totp_step(secret, "287082", at_us, 1), std::nullopt) << "used";
  EXPECT_EQ(totp_step(secret, "287082", at_us + 30'000'000, 0), 1);
  EXPECT_EQ(totp_step(secret, "287082", at_us + 60'000'000, 0), std::nullopt) << "too old";
  EXPECT_EQ(totp_step(secret, "359152", at_us, 0), 2) << "a clock that is ahead";
  for (const char* wrong : {"", "287083", "28708", "2870820", "28708a"})
    EXPECT_EQ(totp_step(secret, wrong, at_us, 0), std::nullopt) << wrong;
}

/// RFC 4648, section 10, without its padding.
TEST(Base32, IsThatOfTheStandard) {
  EXPECT_EQ(base32(core::bytes_of("f")), "MY");
  EXPECT_EQ(base32(core::bytes_of("foob")), "MZXW6YQ");
  EXPECT_EQ(base32(core::bytes_of("foobar")), "MZXW6YTBOI");
}

TEST(OneTimeCodes, AnAuthenticatorsAddressEscapesTheName) {
  EXPECT_EQ(totp_uri(core::bytes_of("foobar"), "a b&c"),
            "otpauth://totp/Tractus:a%20b%26c?secret=MZXW6YTBOI&issuer=Tractus&digits=6&period=30");
}

}  // namespace
}  // namespace api
}  // namespace tractus
