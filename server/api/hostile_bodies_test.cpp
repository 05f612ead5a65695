/// Documents that no client sends, to every route that takes a body, by every role that may call
/// it.
#include <fmt/format.h>

#include <regex>

#include "server/api/people/people_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using testing::kCase;
using testing::PeopleTest;

constexpr std::uint64_t kMostBody_bytes = 512 * 1024;

struct Document {
  std::string what, text;
};

std::string repeated(const std::string& piece, std::uint64_t times) {
  std::string out;
  for (std::uint64_t i = 0; i < times; ++i) out += piece;
  return out;
}

/// As large as the route takes, up to kMostBody_bytes.
std::vector<Document> documents(std::uint64_t limit_bytes) {
  const std::uint64_t size = std::min(limit_bytes, kMostBody_bytes);
  std::string members = "{\"m0\":0";
  for (int i = 1; members.size() + 20 < size; ++i) members += fmt::format(",\"m{}\":0", i);
  members += "}";
  return {{"deep arrays", repeated("[", size / 2) + repeated("]", size / 2)},
          {"deep objects", repeated("{\"a\":", size / 6) + "0" + repeated("}", size / 6)},
          {"open arrays", repeated("[", size)},
          {"wide array", "[0" + repeated(",0", (size - 3) / 2) + "]"},
          {"wide object", members},
          {"long integer", repeated("9", size)},
          {"long number", "{\"a\":0." + repeated("1", size - 8) + "}"},
          {"overflow", "{\"a\":1e999}"},
          {"name twice", R"({"name":"a","name":"b"})"},
          {"invalid UTF-8", "{\"name\":\"\xff\xfe\xed\xa0\x80\"}"},
          {"zero in a text", R"({"name":"a\u0000b","password":"a\u0000b"})"},
          {"nothing but a number", "0"}};
}

class HostileBodies : public PeopleTest {
 protected:
  static std::string someone(Role role) {
    const std::map<Role, std::string> names{{Role::admin, "ann"},      {Role::director, "dora"},
                                            {Role::faculty, "fay"},    {Role::researcher, "rex"},
                                            {Role::technician, "ted"}, {Role::trainee, "tom"}};
    return names.at(role);
  }
  /// Of an object of tom's, with every parameter that the route needs.
  static std::string address(const RouteInfo& route) {
    const std::map<Object, std::string> objects{
        {Object::none, kCase},         {Object::published_case, kCase},
        {Object::account, "tom"},      {Object::cohort, "c-tom"},
        {Object::assignment, "a-tom"}, {Object::trial, trial_of("tom")}};
    std::string out = route.path;
    for (const auto& [key, value] : std::map<std::string, std::string>{
             {"{" + route.object_parameter + "}", objects.at(route.object)},
             {"{trial_id}", std::string(32, 'a')}})
      if (const auto at = out.find(key); at != std::string::npos)
        out.replace(at, key.size(), value);
    out = std::regex_replace(out, std::regex("\\{[^}]+\\}"), "none");
    for (const Parameter& p : route.parameters)
      if (p.in == Parameter::In::query && p.required && !p.fallback)
        out += (out.find('?') == std::string::npos ? "?" : "&") + p.name + "=" +
               (p.kind == Parameter::Kind::text ? "x" : fmt::format("{:.0f}", p.low));
    return out;
  }
  /// Routes that judge any JSON document: their 200 says what is wrong with it.
  static bool says_what_is_wrong(const RouteInfo& route) {
    return route.id == "checkEffect" || route.id == "checkScenario";
  }
  /// Routes to which a browser posts a form: it is sent to the page that says why not.
  static bool refuses_by_a_page(const http::Response& answer) {
    return answer.status == 303 && std::ranges::any_of(answer.headers, [](const auto& header) {
             return header.first == "Location" && header.second.ends_with("?sign_in=launch_failed");
           });
  }
  http::Response send(const RouteInfo& route, std::map<std::string, std::string> headers,
                      const Document& document) {
    headers["content-type"] = "application/json";
    headers["x-crc32c"] = "00000000";
    return ask(request(route.method, address(route), std::move(headers), document.text));
  }
  void send_all(const RouteInfo& route, const std::string& role,
                const std::map<std::string, std::string>& headers) {
    for (const Document& document : documents(route.body_limit_bytes)) {
      const http::Response answer = send(route, headers, document);
      const std::string cell = route.id + " by " + role + ", " + document.what;
      if (answer.status == 200 && says_what_is_wrong(route)) {
        EXPECT_FALSE(json(answer)["error"].get<std::string>().empty()) << cell;
      } else if (!refuses_by_a_page(answer)) {
        EXPECT_GE(answer.status, 400) << cell;
      }
      EXPECT_LT(answer.status, 500) << cell << ": " << text(answer);
      EXPECT_LT(text(answer).size(), 5000u) << cell;
      ++cells_;
      if (text(answer).find("not valid JSON") != std::string::npos) parsed_.insert(route.id);
    }
  }
  int cells_ = 0;
  std::set<std::string> parsed_;  ///< routes of which a refusal came from the parser
};

TEST_F(HostileBodies, AreRefusedByEveryRouteAndTheServerStaysUp) {
  std::size_t routes_with_body = 0;
  for (const RouteInfo& route : routes()) {
    if (route.body.empty()) continue;
    ++routes_with_body;
    if (route.open) send_all(route, "anybody", {{"x-tractus", "1"}});
    for (const Grant& grant : route.who)
      send_all(route, std::string(name(grant.role)),
               grant.role == Role::station ? station("token-1") : as(someone(grant.role)));
  }
  EXPECT_EQ(ask(request("GET", "/api/v1/health")).status, 200);
  std::printf("cells of routes x roles x documents: %d; %zu of %zu routes with a body parsed it\n",
              cells_, parsed_.size(), routes_with_body);
  EXPECT_GT(cells_, 1000);
  EXPECT_GT(parsed_.size(), routes_with_body / 2) << "too many are refused for another reason";
}

}  // namespace
}  // namespace api
}  // namespace tractus
