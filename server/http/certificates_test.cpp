#include "server/http/certificates.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "core/bytes.hpp"
#include "core/file.hpp"

namespace tractus {
namespace http {
namespace {
namespace fs = std::filesystem;

constexpr std::int64_t kNow_s = 1'780'000'000, kDay_s = 86'400;

class Certificates : public ::testing::Test {
 protected:
  Certificates() { fs::create_directories(folder_); }
  ~Certificates() override { fs::remove_all(folder_); }
  std::string text(const fs::path& path) {
    const auto bytes = core::read_file(path);
    return bytes ? std::string(core::text_of(*bytes)) : "";
  }
  /// An independent judge: the openssl program, at a time of its own.
  int openssl(const std::string& arguments) {
    return std::system(("openssl " + arguments + " >/dev/null 2>&1").c_str());
  }
  std::string verifying(const std::string& more, std::int64_t at_s = kNow_s) {
    return "verify -attime " + std::to_string(at_s) + " -CAfile " + files_.authority.string() +
           " " + more + " " + files_.certificate.string();
  }
  const fs::path folder_ = fs::path(::testing::TempDir()) / ("tls-" + core::new_id());
  const CertificateFiles files_ = certificate_files(folder_);
  const std::vector<std::string> names_{"sim.example.org", "192.0.2.7", "2001:db8::7"};
};

TEST_F(Certificates, OfTheHouseHoldBeforeOpensslForTheirNamesAlone) {
  ASSERT_TRUE(ensure_certificates(folder_, names_, kNow_s));
  EXPECT_EQ(openssl(verifying("-purpose sslserver -verify_hostname sim.example.org")), 0);
  EXPECT_EQ(openssl(verifying("-verify_ip 192.0.2.7")), 0);
  EXPECT_EQ(openssl(verifying("-verify_ip 2001:db8::7")), 0);
  EXPECT_NE(openssl(verifying("-verify_hostname evil.example.org")), 0);
  EXPECT_NE(openssl(verifying("-verify_ip 192.0.2.8")), 0);
  EXPECT_NE(openssl(verifying("-purpose sslclient")), 0);
  EXPECT_NE(openssl(verifying("", kNow_s + 398 * kDay_s)), 0) << "ends";
}

TEST_F(Certificates, KeysAreForTheirOwnerAlone) {
  ASSERT_TRUE(ensure_certificates(folder_, names_, kNow_s));
  for (const fs::path& key : {files_.key, files_.authority_key})
    EXPECT_EQ(fs::status(key).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(Certificates, StayWhileTheyServeAndAreRenewedBeforeTheyEnd) {
  ASSERT_TRUE(ensure_certificates(folder_, names_, kNow_s));
  const std::string authority = text(files_.authority), first = text(files_.certificate);
  ASSERT_TRUE(ensure_certificates(folder_, names_, kNow_s + 300 * kDay_s));
  EXPECT_EQ(text(files_.certificate), first);
  ASSERT_TRUE(ensure_certificates(folder_, names_, kNow_s + 370 * kDay_s));
  EXPECT_NE(text(files_.certificate), first);
  EXPECT_EQ(text(files_.authority), authority) << "stations trust it: it stays";
  EXPECT_EQ(openssl(verifying("", kNow_s + 700 * kDay_s)), 0);
}

TEST_F(Certificates, AreMadeAnewForAnotherName) {
  ASSERT_TRUE(ensure_certificates(folder_, {"one.example.org"}, kNow_s));
  ASSERT_TRUE(ensure_certificates(folder_, {"one.example.org", "two.example.org"}, kNow_s));
  EXPECT_EQ(openssl(verifying("-verify_hostname two.example.org")), 0);
}

TEST_F(Certificates, RenewalWithoutTheAuthoritysKeySaysWhatIsMissing) {
  ASSERT_TRUE(ensure_certificates(folder_, names_, kNow_s));
  fs::remove(files_.authority_key);
  EXPECT_TRUE(ensure_certificates(folder_, names_, kNow_s)) << "not needed yet";
  const auto refused = ensure_certificates(folder_, names_, kNow_s + 380 * kDay_s);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("authority.key"), std::string::npos);
}

TEST_F(Certificates, ANameThatIsMoreThanANameIsRefused) {
  for (const char* bad : {"", "a b", "a,DNS:evil", "x:y", "a\nb", "*"})
    EXPECT_FALSE(ensure_certificates(folder_, {bad}, kNow_s)) << bad;
}

}  // namespace
}  // namespace http
}  // namespace tractus
