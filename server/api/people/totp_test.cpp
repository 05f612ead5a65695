#include "server/api/people/totp.hpp"

#include <gtest/gtest.h>

namespace tractus {
namespace api {
namespace {

const std::string kSeed20 = "12345678901234567890";
const std::string kSeed32 = "12345678901234567890123456789012";
const std::string kSeed64 = "1234567890123456789012345678901234567890123456789012345678901234";

/// RFC 6238, appendix B: the seeds, times and codes of its table.
TEST(OneTimeCodes, AreThoseOfTheStandardsTable) {
  struct Row {
    std::uint64_t time_s;
    const char *sha1, *sha256, *sha512;
  };
  for (const Row& row : {Row{59, "94287082", "46119246", "90693936"},
                         Row{1111111109, "07081804", "68084774", "25091201"},
                         Row{1111111111, "14050471", "67062674", "99943326"},
                         Row{1234567890, "89005924", "91819424", "93441116"},
                         Row{2000000000, "69279037", "90698825", "38618901"},
                         Row{20000000000, "65353130", "77737706", "47863826"}}) {
    const std::uint64_t step = row.time_s / 30;
    EXPECT_EQ(hotp(core::bytes_of(kSeed20), step, 8, TotpHash::sha1), row.sha1) << row.time_s;
    EXPECT_EQ(hotp(core::bytes_of(kSeed32), step, 8, TotpHash::sha256), row.sha256) << row.time_s;
    EXPECT_EQ(hotp(core::bytes_of(kSeed64), step, 8, TotpHash::sha512), row.sha512) << row.time_s;
  }
}

/// RFC 4226, appendix D.
TEST(OneTimeCodes, OfCountersAreThoseOfTheStandardsTable) {
  const char* const codes[] = {"755224", "287082", "359152", "969429", "338314",
                               "254676", "287922", "162583", "399871", "520489"};
  for (std::uint64_t i = 0; i < 10; ++i) EXPECT_EQ(hotp(core::bytes_of(kSeed20), i), codes[i]);
}

TEST(OneTimeCodes, AreTakenOnceAndAStepToEitherSide) {
  const auto secret = core::bytes_of(kSeed20);
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
