#include "server/http/message.hpp"

#include <gtest/gtest.h>

#include <tuple>

#include "server/http/networks.hpp"

namespace tractus {
namespace http {
namespace {

RequestHead head_with(std::string name, std::string value) {
  RequestHead head;
  head.headers.emplace(std::move(name), std::move(value));
  return head;
}

TEST(Target, IsTakenApartAndDecoded) {
  RequestHead head;
  ASSERT_TRUE(read_target("/a/b%2Fc?x=1&name=J%C3%BCrg+K&flag", head));
  EXPECT_EQ(head.path, "/a/b%2Fc");
  EXPECT_EQ(head.query, (std::map<std::string, std::string>{
                            {"x", "1"}, {"name", "J\xc3\xbcrg K"}, {"flag", ""}}));
}

TEST(Target, ABrokenEscapeAZeroByteANameTwiceOrAnAbsoluteAddressIsRefused) {
  for (const char* bad :
       {"/?x=%", "/?x=%2", "/?x=%zz", "/?x=%00", "/?x=1&x=2", "x", "", "http://elsewhere/"}) {
    RequestHead head;
    EXPECT_FALSE(read_target(bad, head)) << bad;
  }
}

TEST(Target, ANameTwiceIsRefusedInOneShortLineWhateverTheName) {
  const std::string name = "a%0Ab" + std::string(5000, 'c');
  RequestHead head;
  const auto refused = read_target("/?" + name + "&" + name, head);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().what.find('\n'), std::string::npos);
  EXPECT_LT(refused.error().what.size(), 200u);
}

TEST(Cookies, AreFoundByTheirWholeName) {
  const RequestHead head = head_with("cookie", "xsession=1; session=two;session2=3");
  EXPECT_EQ(head.cookie("session"), "two");
  EXPECT_EQ(head.cookie("sess"), "");
}

// Expected values: RFC 9110, section 14.1.2, with its file of 10000 bytes.
TEST(Ranges, AreThoseOfTheStandard) {
  using Range = std::pair<std::uint64_t, std::uint64_t>;
  EXPECT_EQ(byte_range("bytes=0-499", 10000).value(), Range(0, 499));
  EXPECT_EQ(byte_range("bytes=500-999", 10000).value(), Range(500, 999));
  EXPECT_EQ(byte_range("bytes=-500", 10000).value(), Range(9500, 9999));
  EXPECT_EQ(byte_range("bytes=9500-", 10000).value(), Range(9500, 9999));
  EXPECT_EQ(byte_range("bytes=9500-20000", 10000).value(), Range(9500, 9999));
  EXPECT_EQ(byte_range("bytes=-20000", 10000).value(), Range(0, 9999));
}

TEST(Ranges, BeyondTheEndIsAnErrorAndAnUnknownFormIsNoRange) {
  for (const char* beyond : {"bytes=10000-", "bytes=10000-10001", "bytes=-0"})
    EXPECT_FALSE(byte_range(beyond, 10000)) << beyond;
  for (const char* unknown : {"", "bytes=", "bytes=a-b", "bytes=5-4", "lines=1-2", "bytes=0-1,5-6",
                              "bytes=1-2x", "bytes=--5", "bytes=99999999999999999999-"}) {
    const auto range = byte_range(unknown, 10000);
    ASSERT_TRUE(range) << unknown;
    EXPECT_FALSE(range.value()) << unknown;
  }
}

TEST(Errors, AreJsonEvenWhenTheTextIsNotUnicode) {
  const Response response = error_response(400, "bad_input", "a \"quote\" and \xff");
  EXPECT_EQ(std::get<std::string>(response.body),
            "{\"error\":\"a \\\"quote\\\" and \xef\xbf\xbd\",\"code\":\"bad_input\"}");
}

TEST(Forwarding, TakesWhatTheProxyItselfWroteLast) {
  RequestHead head;
  head.peer = "127.0.0.1";
  EXPECT_EQ(forwarded_peer(head), "127.0.0.1");
  head.headers["x-forwarded-for"] = "203.0.113.9";
  EXPECT_EQ(forwarded_peer(head), "203.0.113.9");
  head.headers["x-forwarded-for"] = "6.6.6.6, 203.0.113.9";
  EXPECT_EQ(forwarded_peer(head), "203.0.113.9");
  head.headers["x-forwarded-for"] = "203.0.113.9, 2001:db8::1";
  EXPECT_EQ(forwarded_peer(head), "2001:db8::1");
  head.headers["x-forwarded-for"] = "203.0.113.9, a name";
  EXPECT_EQ(forwarded_peer(head), "127.0.0.1") << "no address";
}

TEST(Networks, ContainAddressesByTheirFirstBits) {
  const auto networks = Networks::parse({"10.1.0.0/20", "192.0.2.7", "2001:db8::/33", "::1"});
  ASSERT_TRUE(networks);
  for (const char* inside : {"10.1.0.1", "10.1.15.255", "192.0.2.7", "::ffff:192.0.2.7",
                             "2001:db8:7fff::1", "::1", "::1%lo"})
    EXPECT_TRUE(networks->contain(inside)) << inside;
  for (const char* outside : {"10.1.16.0", "10.0.255.255", "192.0.2.6", "2001:db8:8000::1", "::2",
                              "", "localhost", "10.1.0.1.1", "10.1.0.1/32"})
    EXPECT_FALSE(networks->contain(outside)) << outside;
}

TEST(Networks, AreLoopbackWhereNoneAreNamed) {
  for (const char* own : {"127.0.0.1", "127.255.0.1", "::1", "::ffff:127.0.0.1"})
    EXPECT_TRUE(Networks::loopback().contain(own)) << own;
  EXPECT_FALSE(Networks::loopback().contain("128.0.0.1"));
}

TEST(Networks, RefuseWhatIsNoAddress) {
  for (const char* wrong : {"", "localhost", "10.0.0.0/33", "::/129", "10.0.0.0/", "10.0.0.0/8x",
                            "10.0.0.0/-1", "/8", "1.2.3.4:80"})
    EXPECT_FALSE(Networks::parse({wrong})) << wrong;
}

}  // namespace
}  // namespace http
}  // namespace tractus
