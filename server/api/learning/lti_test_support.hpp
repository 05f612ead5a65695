/// A learning platform beside the people of PeopleTest.
#pragma once

#include <atomic>

#include "server/api/operations/notifier.hpp"
#include "server/api/people/people_test_support.hpp"
#include "server/api/people/provider_test_support.hpp"

namespace tractus::api::testing {

inline constexpr const char* kBase = "https://tractus.example.org";

class LtiTest : public PeopleTest {
 protected:
  LtiTest() {
    backend_.notifier = &notifier_;
    backend_.platform_keys.now_s = [this] { return clock_s_.load(); };
    backend_.platform_keys.patience = std::chrono::milliseconds(300);
    now_ = kUtc_s * 1'000'000;
  }
  NotifierSettings settings() {
    NotifierSettings out{.networks = http::Networks::loopback(), .base = kBase};
    out.score = [this](const ScoreCall& call) -> core::Result<void> {
      scores_.push_back(call);
      if (refusal_) return *refusal_;
      return {};
    };
    return out;
  }

  core::Json registration() const {
    return {{"issuer", platform_.issuer},
            {"client_id", "tractus"},
            {"deployments", {"d-1"}},
            {"authorization_url", platform_.issuer + "/authorize"},
            {"token_url", platform_.issuer + "/token"},
            {"keys_url", platform_.issuer + "/keys"}};
  }
  /// Registers the platform; returns its id.
  std::string register_platform(const core::Json& changed = core::Json::object()) {
    core::Json wish = registration();
    wish.update(changed);
    const auto made = post("ann", "/lti/platforms", wish);
    EXPECT_EQ(made.status, 201) << text(made);
    return json(made).value("id", "");
  }
  void link(const std::string& platform_id, const std::string& account,
            const std::string& subject) {
    const auto linked = post("ann", "/lti/platforms/" + platform_id + "/people",
                             {{"account", account}, {"subject", subject}});
    EXPECT_EQ(linked.status, 204) << text(linked);
  }

  /// A launch that the platform was asked for.
  struct Begun {
    std::string state, nonce, cookie;
  };
  Begun begin() {
    const auto sent =
        ask(request("GET", "/api/v1/lti/login?iss=" + percent_encoded(platform_.issuer) +
                               "&login_hint=7&target_link_uri=" + percent_encoded(kBase) +
                               "&client_id=tractus"));
    EXPECT_EQ(sent.status, 303);
    http::RequestHead to;
    const std::string location(sent.header("Location"));
    EXPECT_TRUE(location.starts_with(platform_.issuer + "/authorize?")) << location;
    EXPECT_TRUE(http::read_target(location.substr(platform_.issuer.size()), to));
    const std::string set(sent.header("Set-Cookie"));
    return {to.query["state"], to.query["nonce"], set.substr(0, set.find(';'))};
  }
  /// The claims of 1EdTech's LTI 1.3 Core, section 5.3, of a launch of tom's assignment.
  core::Json claims(const Begun& begun) const {
    const auto lti = [](const char* name) {
      return std::string("https://purl.imsglobal.org/spec/lti/claim/") + name;
    };
    return {
        {"iss", platform_.issuer},
        {"aud", {"tractus"}},
        {"sub", "person-7"},
        {"exp", kUtc_s + 300},
        {"iat", kUtc_s - 5},
        {"nonce", begun.nonce},
        {lti("message_type"), "LtiResourceLinkRequest"},
        {lti("version"), "1.3.0"},
        {lti("deployment_id"), "d-1"},
        {lti("target_link_uri"), kBase},
        {lti("resource_link"), {{"id", "link-1"}}},
        {lti("roles"), {"http://purl.imsglobal.org/vocab/lis/v2/institution/person#Administrator"}},
        {lti("custom"), {{"assignment", "a-tom"}}},
        {"https://purl.imsglobal.org/spec/lti-ags/claim/endpoint",
         {{"scope", {"https://purl.imsglobal.org/spec/lti-ags/scope/score"}},
          {"lineitem", platform_.issuer + "/items/7?type=x"}}}};
  }
  http::Response post_launch(const Begun& begun, const std::string& token) {
    return ask(
        request("POST", "/api/v1/lti/launch",
                {{"content-type", "application/x-www-form-urlencoded"},
                 {"origin", platform_.issuer},
                 {"cookie", begun.cookie}},
                "id_token=" + percent_encoded(token) + "&state=" + percent_encoded(begun.state)));
  }
  /// The whole launch, with claims changed by this merge patch (RFC 7396).
  http::Response launch(const core::Json& patch = core::Json::object()) {
    const Begun begun = begin();
    core::Json said = claims(begun);
    said.merge_patch(patch);
    return post_launch(begun, platform_.token(said));
  }
  static std::string where(const http::Response& sent) {
    EXPECT_EQ(sent.status, 303);
    return std::string(sent.header("Location"));
  }

  std::atomic<std::int64_t> clock_s_ = 1000;
  Provider platform_;
  std::vector<ScoreCall> scores_;
  std::optional<core::Error> refusal_;
  Notifier notifier_{backend_, settings()};
};

}  // namespace tractus::api::testing
