/// id_tokens: the standard's own examples, and every way in which one may not hold.
#include "server/api/people/id_token.hpp"

#include "server/api/people/id_token_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using core::Json;
using testing::encoded;
using testing::Signer;

constexpr std::int64_t kNow_s = 1'000'000;

// RFC 7515 appendices A.2 and A.3: the same payload, {"iss":"joe", …}, signed by either method.
const std::string kPayload =
    "eyJpc3MiOiJqb2UiLA0KICJleHAiOjEzMDA4MTkzODAsDQogImh0dHA6Ly9leGFtcGxlLmNvbS9pc19yb290Ijp0cnVl"
    "fQ";
const std::string kRs256 =
    "eyJhbGciOiJSUzI1NiJ9." + kPayload +
    ".cC4hiUPoj9Eetdgtv3hF80EGrhuB__dzERat0XF9g2VtQgr9PJbu3XOiZj5RZmh7AAuHIm4Bh-0Qc_lF5YKt_O8W2Fp5"
    "jujGbds9uJdbF9CUAr7t1dnZcAcQjbKBYNX4BAynRFdiuB--f_nZLgrnbyTyWzO75vRK5h6xBArLIARNPvkSjtQBMHlb1L"
    "07Qe7K0GarZRmB_eSN9383LcOLn6_dO--xi12jzDwusC-eOkHWEsqtFZESc6BfI7noOPqvhJ1phCnvWh6IeYI2w9QOYEUi"
    "pUTI8np6LbgGY9Fs98rqVt5AXLIhWkWywlVmtVrBp0igcN_IoypGlUPQGe77Rw";
const std::string kEs256 =
    "eyJhbGciOiJFUzI1NiJ9." + kPayload +
    ".DtEhU3ljbEg8L38VWAfUAqOyKAM6-Xx-F4GawxaepmXFCgfTjDxw5djxLa8ISlSApmWQxfKTUJqPP3-Kg6NU1Q";
const Json kStandardKeys = {
    {"keys",
     {{{"kty", "RSA"},
       {"n",
        "ofgWCuLjybRlzo0tZWJjNiuSfb4p4fAkd_wWJcyQoTbji9k0l8W26mPddxHmfHQp-Vaw-4qPCJrcS2mJPMEzP1Pt0B"
        "m4d4QlL-yRT-SFd2lZS-pCgNMsD1W_YpRPEwOWvG6b32690r2jZ47soMZo9wGzjb_7OMg0LOL-"
        "bSf63kpaSHSXndS5z"
        "5rexMdbBYUsLA9e-KXBdQOS-UTo7WTBEMa2R2CapHg665xsmtdVMTBQY4uDZlxvb3qCo5ZwKh9kG4LT6_"
        "I5IhlJH7aG"
        "hyxXFvUK-DWNmoudF8NAco9_h9iaGNj8q2ethFkMLs91kzk2PAcDTW9gb54h4FRWyuXpoQ"},
       {"e", "AQAB"}},
      {{"kty", "EC"},
       {"crv", "P-256"},
       {"x", "f83OJ3D2xF1Bg8vub9tLe1gHMzV76e8Tus9uPHvRVEU"},
       {"y", "x_FEzRu9m36HLN_tue659LNpXW6pCyStikYjKIWI5a0"}}}}};

class IdToken : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { signer_ = std::make_unique<Signer>(); }
  static void TearDownTestSuite() { signer_.reset(); }

  static Json claims() {
    return {{"iss", "https://provider"}, {"aud", "tractus"},  {"sub", "person-7"},
            {"exp", kNow_s + 300},       {"iat", kNow_s - 5}, {"nonce", "n-1"}};
  }
  static core::Result<Identity> judged(const std::string& token,
                                       const Json& keys = {{"keys", {signer_->jwk()}}}) {
    return identity_of(token, keys, {"https://provider", "tractus", "n-1", kNow_s});
  }
  /// What is said of the good token with one claim set, or taken out.
  static std::string said_of(const char* claim, const Json& value) {
    Json changed = claims();
    if (value.is_null())
      changed.erase(claim);
    else
      changed[claim] = value;
    const auto identity = judged(signer_->token(changed));
    return identity ? "fine" : identity.error().what;
  }
  static inline std::unique_ptr<Signer> signer_;
};

TEST_F(IdToken, TheStandardsOwnExamplesAreSignedAsTheySay) {
  for (const std::string& token : {kRs256, kEs256}) {
    // Signature and issuer hold; the example has no audience.
    const auto seen = identity_of(token, kStandardKeys, {"joe", "tractus", "n-1", 1300819000});
    ASSERT_FALSE(seen);
    EXPECT_EQ(seen.error().what, "the provider's id_token is for another client (aud)");
    std::string changed = token;
    changed[changed.size() - 20] = changed[changed.size() - 20] == 'A' ? 'B' : 'A';
    const auto forged = identity_of(changed, kStandardKeys, {"joe", "tractus", "n-1", 1300819000});
    ASSERT_FALSE(forged);
    EXPECT_EQ(forged.error().what, "the provider's id_token is not signed by the provider");
  }
}

TEST_F(IdToken, NamesThePersonWhenAllHolds) {
  const auto identity = judged(signer_->token(claims()));
  ASSERT_TRUE(identity) << identity.error().what;
  EXPECT_EQ(identity->subject, "person-7");
}

TEST_F(IdToken, EveryClaimThatDoesNotHoldIsRefused) {
  const std::string token = "the provider's id_token ";
  EXPECT_EQ(said_of("iss", "https://other"), token + "has another issuer (iss)");
  EXPECT_EQ(said_of("aud", "another"), token + "is for another client (aud)");
  EXPECT_EQ(said_of("aud", Json()), token + "is for another client (aud)");
  EXPECT_EQ(said_of("aud", {"another", "tractus"}),
            token + "is for several clients and does not name the authorised client (azp)");
  EXPECT_EQ(said_of("aud", Json::array({"tractus"})), "fine");
  EXPECT_EQ(said_of("azp", "another"), token + "was issued to another client (azp)");
  EXPECT_EQ(said_of("exp", kNow_s - 61), token + "has expired");
  EXPECT_EQ(said_of("exp", kNow_s - 59), "fine") << "a minute's difference of clocks";
  EXPECT_EQ(said_of("exp", Json()), token + "has expired");
  EXPECT_EQ(said_of("exp", "tomorrow"), token + "has expired");
  EXPECT_EQ(said_of("iat", kNow_s + 61), token + "was issued in the future (iat)");
  EXPECT_EQ(said_of("iat", kNow_s - 601), token + "is too old");
  EXPECT_EQ(said_of("nbf", kNow_s + 61), token + "is not valid yet (nbf)");
  EXPECT_EQ(said_of("nonce", "n-2"), token + "is not the answer to this sign-in");
  EXPECT_EQ(said_of("nonce", Json()), token + "is not the answer to this sign-in");
  EXPECT_EQ(said_of("sub", ""), token + "names no person (sub)");
  EXPECT_EQ(said_of("sub", std::string(256, 'x')), token + "names no person (sub)");
}

TEST_F(IdToken, NoOtherMethodAndNoOtherKeyWillDo) {
  const Signer other;
  EXPECT_EQ(judged(other.token(claims())).error().code, core::Errc::unauthorised);
  // "none" and a MAC by what everybody knows, the two classic forgeries (RFC 8725 section 2.1).
  for (const char* method : {"none", "HS256", "RS512", "PS256"}) {
    const auto seen = judged(signer_->token(claims(), {{"alg", method}, {"kid", "k1"}}));
    ASSERT_FALSE(seen) << method;
    EXPECT_NE(seen.error().what.find("not signed with RS256 or ES256"), std::string::npos)
        << method;
  }
  const std::string bare = encoded("{\"alg\":\"none\"}") + "." + encoded(claims().dump()) + ".";
  EXPECT_FALSE(judged(bare));
  // An EC key by an RSA key's name; a key for encryption; two keys and no name.
  Json ec = kStandardKeys["keys"][1];
  ec["kid"] = "k1";
  EXPECT_EQ(judged(signer_->token(claims()), {{"keys", {ec}}}).error().code, core::Errc::not_found);
  Json sealing = signer_->jwk();
  sealing["use"] = "enc";
  EXPECT_EQ(judged(signer_->token(claims()), {{"keys", {sealing}}}).error().code,
            core::Errc::not_found);
  EXPECT_FALSE(judged(signer_->token(claims(), {{"alg", "RS256"}}),
                      {{"keys", {other.jwk("a"), signer_->jwk("b")}}}));
  EXPECT_TRUE(judged(signer_->token(claims(), {{"alg", "RS256"}})));
  EXPECT_EQ(judged(signer_->token(claims(), {{"alg", "RS256"}, {"kid", "k2"}})).error().code,
            core::Errc::not_found)
      << "the provider's keys are then fetched again";
}

TEST_F(IdToken, RubbishIsRefused) {
  for (const std::string& rubbish :
       {std::string(), std::string("."), std::string(".."), std::string("a.b"),
        std::string("a.b.c.d"), std::string("{}.{}.{}"), std::string(20000, 'a'),
        "e30." + encoded(claims().dump()) + ".AA", std::string("e30.e30.A")})
    EXPECT_FALSE(judged(rubbish)) << rubbish.substr(0, 40);
  for (const Json& keys : {Json(), Json::array(), Json{{"keys", 3}}, Json{{"keys", {1, "x"}}},
                           Json{{"keys", {{{"kty", "RSA"}, {"n", "!"}, {"e", "AQAB"}}}}}})
    EXPECT_FALSE(judged(signer_->token(claims()), keys)) << keys.dump();
}

}  // namespace
}  // namespace api
}  // namespace tractus
