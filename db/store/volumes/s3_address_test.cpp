/// Addresses of buckets, and where credentials are found; the rest in tests/s3.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "db/store/store_test_support.hpp"
#include "db/store/volumes/s3_store.hpp"

namespace tractus {
namespace store {
namespace {
using testing::TestFolder;

TEST(S3Address, NamesServerBucketPrefixAndRegion) {
  const auto whole =
      S3Address::parse("https://s3.example.org:8443/bucket/a/b/?region=eu-central-1");
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->url, "https://s3.example.org:8443/bucket/a/b");
  EXPECT_EQ(whole->region, "eu-central-1");
  const auto least = S3Address::parse("https://s3.example.org/bucket");
  ASSERT_TRUE(least);
  EXPECT_EQ(least->region, "us-east-1");
}

TEST(S3Address, RefusesWhatWouldNotBeSignedAsItIsSent) {
  for (const char* wrong :
       {"", "bucket", "s3://", "https://s3.example.org", "https://s3.example.org/",
        "https:///bucket", "https://s3.example.org//bucket",
        "https://s3.example.org/bucket/../other", "https://s3.example.org/a%20b",
        "https://s3.example.org/a b", "https://u:p@host/bucket",
        "https://s3.example.org/bucket?region=", "https://s3.example.org/bucket?zone=x",
        "https://s3.example.org/bucket?region=x&y=z", "https://s3.example.org/bucket#x",
        "https://s3.example.org/bucket\nHost: x"})
    EXPECT_FALSE(S3Address::parse(wrong)) << wrong;
}

/// The environment's variable has this value while it is there; null: none.
class WithVariable {
 public:
  WithVariable(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    set(value);
  }
  ~WithVariable() { set(before_ ? before_->c_str() : nullptr); }
  WithVariable(const WithVariable&) = delete;
  WithVariable& operator=(const WithVariable&) = delete;

 private:
  void set(const char* value) {
    if (value)
      ::setenv(name_, value, 1);
    else
      ::unsetenv(name_);
  }
  const char* name_;
  std::optional<std::string> before_;
};

TEST(S3Credentials, AreThoseOfTheEnvironmentElseOfTheFilesSection) {
  const TestFolder folder;
  const auto path = folder.path() / "credentials";
  std::ofstream(path) << "[default]\naws_access_key_id = ONE\naws_secret_access_key = a/b+c=\n"
                         "[other]\naws_access_key_id=TWO\naws_secret_access_key=two\n"
                         "aws_session_token=token\n[half]\naws_access_key_id=THREE\n";
  const WithVariable key("AWS_ACCESS_KEY_ID", nullptr), secret("AWS_SECRET_ACCESS_KEY", nullptr);
  const WithVariable file("AWS_SHARED_CREDENTIALS_FILE", path.c_str());
  const WithVariable none("AWS_PROFILE", nullptr);
  EXPECT_EQ(S3Credentials::find().value().key_id, "ONE");
  EXPECT_EQ(S3Credentials::find().value().secret, "a/b+c=");
  {
    const WithVariable profile("AWS_PROFILE", "other");
    EXPECT_EQ(S3Credentials::find().value().session_token, "token");
  }
  for (const char* wrong : {"half", "absent"}) {
    const WithVariable profile("AWS_PROFILE", wrong);
    EXPECT_EQ(S3Credentials::find().error().code, core::Errc::bad_input) << wrong;
  }
  const WithVariable own("AWS_ACCESS_KEY_ID", "ENV"), its("AWS_SECRET_ACCESS_KEY", "env");
  EXPECT_EQ(S3Credentials::find().value().key_id, "ENV");
}

}  // namespace
}  // namespace store
}  // namespace tractus
