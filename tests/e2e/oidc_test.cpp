/// Signing in by a provider of identities: the real server, a certified provider's process
/// (npm oidc-provider), and what a browser does between them.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <checkout.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/file.hpp"
#include "tests/support/server/process.hpp"

namespace tractus {
namespace {
using namespace world;
namespace fs = std::filesystem;

const fs::path kScripts = fs::path(checkout::kSource) / "tests/oidc";

/// tests/oidc/provider.mjs.
class Provider {
 public:
  explicit Provider(const std::string& algorithm) {
    std::array<int, 2> in{}, out{};
    EXPECT_EQ(::pipe2(in.data(), O_CLOEXEC), 0);
    EXPECT_EQ(::pipe2(out.data(), O_CLOEXEC), 0);
    pid_ = ::fork();
    if (pid_ == 0) {
      ::dup2(in[0], STDIN_FILENO);
      ::dup2(out[1], STDOUT_FILENO);
      const std::string script = kScripts / "provider.mjs";
      ::execlp("node", "node", "--no-warnings", script.c_str(), algorithm.c_str(), nullptr);
      ::_exit(127);
    }
    ::close(in[0]), ::close(out[1]);
    to_ = in[1], from_ = ::fdopen(out[0], "r");
    issuer_ = line_with("http://");
  }
  ~Provider() {
    ::close(to_);  // it ends with its input
    ::waitpid(pid_, nullptr, 0);
    std::fclose(from_);
  }
  Provider(const Provider&) = delete;
  Provider& operator=(const Provider&) = delete;
  const std::string& issuer() const { return issuer_; }
  void send_back_to(const std::string& address) { say(address); }
  /// "NAME GROUP…": the groups of a person from now on.
  void groups(const std::string& of_whom) { say(of_whom); }

 private:
  void say(const std::string& words) {
    const std::string line = words + "\n";
    EXPECT_EQ(::write(to_, line.data(), line.size()), ssize_t(line.size()));
    EXPECT_EQ(line_with("ready"), "ready");
  }
  std::string line_with(const std::string& start) {
    std::array<char, 4096> line{};
    while (std::fgets(line.data(), int(line.size()), from_)) {
      std::string text = line.data();
      text.erase(text.find_last_not_of("\r\n") + 1);
      if (text.starts_with(start)) return text;
    }
    return "";
  }
  pid_t pid_ = -1;
  int to_ = -1;
  std::FILE* from_ = nullptr;
  std::string issuer_;
};

/// What tests/oidc/browser.mjs saw.
core::Json browse(const std::string& start, const std::string& name, const std::string& tamper) {
  const std::string command = "node " + (kScripts / "browser.mjs").string() + " " + start + " " +
                              name + " --tamper " + tamper;
  std::FILE* out = ::popen(command.c_str(), "r");
  std::string said;
  std::array<char, 4096> piece{};
  while (const std::size_t n = std::fread(piece.data(), 1, piece.size(), out))
    said.append(piece.data(), n);
  EXPECT_EQ(::pclose(out), 0) << said;
  return core::Json::parse(said, nullptr, false);
}

class Oidc : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (std::system("node --version > /dev/null 2>&1") != 0)
      GTEST_SKIP() << "OpenID Connect against a real provider: node is not installed";
    if (!fs::exists(kScripts / "node_modules/oidc-provider"))
      GTEST_SKIP() << "OpenID Connect against a real provider: run npm ci in tests/oidc first";
    provider_ = std::make_unique<Provider>(GetParam());
    world_ = std::make_unique<ServedWorld>();
    std::ofstream(world_->folder / "client.secret") << "secret of a test\n";
    std::ofstream(world_->folder / "oidc.json") << core::Json{
        {"format", "tractus-oidc/1"},
        {"issuer", provider_->issuer()},
        {"client_id", "tractus"},
        {"client_secret_file", "client.secret"},
        {"label", "Sign in with the hospital"}}.dump();
    server_ = std::make_unique<ServerProcess>(
        world_->data, std::vector<std::string>{"--oidc", world_->folder / "oidc.json"});
    client_.speak_to(server_->port());
    base_ = "http://127.0.0.1:" + std::to_string(server_->port());
    provider_->send_back_to(base_ + "/api/v1/session/oidc/callback");
    admin_ = world_->admin(client_);
    admin_["content-type"] = "application/json";
  }
  core::Json sign_in(const std::string& name, const std::string& tamper = "nothing") {
    return browse(base_ + "/api/v1/session/oidc/start", name, tamper);
  }
  /// An account of the role, linked with the provider's `subject`.
  std::string linked_account(const std::string& name, const std::string& subject) {
    const Answer made = client_.ask("POST", "/api/v1/accounts", admin_,
                                    core::Json{{"name", name}, {"role", "faculty"}}.dump());
    EXPECT_EQ(made.status, 201) << made.body;
    const std::string id = made.json()["account"]["id"];
    EXPECT_EQ(link(id, subject), 204);
    return id;
  }
  int link(const std::string& account, const std::string& subject) {
    return client_
        .ask("POST", "/api/v1/accounts/" + account + "/subject", admin_,
             core::Json{{"subject", subject}}.dump())
        .status;
  }
  static std::string end_of(const core::Json& browsed) {
    return browsed["visited"].empty() ? "" : browsed["visited"].back().get<std::string>();
  }
  static Headers session_of(const core::Json& browsed) {
    return {{"cookie", "tractus_session=" + browsed["cookies"].value("tractus_session", "")},
            {"x-tractus", "1"}};
  }

  std::unique_ptr<Provider> provider_;
  std::unique_ptr<ServedWorld> world_;
  std::unique_ptr<ServerProcess> server_;
  Client client_;
  std::string base_;
  Headers admin_;
};

TEST_P(Oidc, LinkedPeopleComeInAsTheirAccountAndLeaveAgain) {
  const Answer offer = client_.ask("GET", "/api/v1/session/oidc");
  EXPECT_EQ(offer.json(), core::Json({{"offered", true}, {"label", "Sign in with the hospital"}}));
  const std::string id = linked_account("fay", "fay@hospital");
  const auto browsed = sign_in("fay@hospital");
  EXPECT_EQ(end_of(browsed), base_ + "/") << browsed.dump();
  EXPECT_FALSE(browsed["cookies"].contains("tractus_oidc")) << "the attempt's cookie is gone";
  const Headers session = session_of(browsed);
  const Answer who = client_.ask("GET", "/api/v1/session", session);
  ASSERT_EQ(who.status, 200) << who.body;
  EXPECT_EQ(who.json()["name"], "fay");
  EXPECT_EQ(who.json()["role"], "faculty");
  EXPECT_EQ(who.json()["must_change"], false);
  const Answer audit = client_.ask("GET", "/api/v1/audit?limit=5", admin_);
  EXPECT_EQ(audit.json()["rows"][0]["what"], "oidcSignIn");
  EXPECT_EQ(audit.json()["rows"][0]["who"], "fay");

  EXPECT_EQ(client_.ask("DELETE", "/api/v1/session", session).status, 204);
  EXPECT_EQ(client_.ask("GET", "/api/v1/session", session).status, 401);
  const Answer end = client_.ask("GET", "/api/v1/session/oidc/end");
  EXPECT_EQ(end.status, 302);
  EXPECT_TRUE(end.headers.at("location").starts_with(provider_->issuer() + "/session/end?"));
}

TEST_P(Oidc, WhoHasNoAccountGetsNoneAndTheAdministratorSeesWhoAsked) {
  const auto browsed = sign_in("stranger");
  EXPECT_EQ(end_of(browsed), base_ + "/?sign_in=unknown") << browsed.dump();
  EXPECT_FALSE(browsed["cookies"].contains("tractus_session"));
  const Answer audit = client_.ask("GET", "/api/v1/audit?limit=5", admin_);
  EXPECT_EQ(audit.json()["rows"][0]["detail"]["subject"], "stranger");
  EXPECT_EQ(client_.ask("GET", "/api/v1/accounts", admin_).json()["accounts"].size(), 1u);
}

TEST_P(Oidc, GroupsOfTheProviderMakeChangeAndDisableAnAccountByTheRule) {
  const core::Json rule{{"format", "tractus-groups/1"},
                        {"lines",
                         {{{"group", "pgy1"}, {"role", "trainee"}, {"level", "PGY-1"}},
                          {{"group", "staff"}, {"role", "faculty"}}}}};
  const Answer stated = client_.ask("POST", "/api/v1/group-rules", admin_,
                                    core::Json{{"rule", rule}, {"reason", "a test"}}.dump());
  ASSERT_EQ(stated.status, 200) << stated.body;
  provider_->groups("una cooks");
  EXPECT_EQ(end_of(sign_in("una")), base_ + "/?sign_in=unknown");
  const auto role_in = [&](const std::string& group) {
    provider_->groups("una " + group);
    const auto browsed = sign_in("una");
    EXPECT_EQ(end_of(browsed), base_ + "/") << browsed.dump();
    const core::Json who = client_.ask("GET", "/api/v1/session", session_of(browsed)).json();
    EXPECT_EQ(who["name"], "una");
    return who.value("role", "");
  };
  EXPECT_EQ(role_in("pgy1"), "trainee");
  EXPECT_EQ(role_in("staff"), "faculty");
  provider_->groups("una");
  EXPECT_EQ(end_of(sign_in("una")), base_ + "/?sign_in=unknown") << "she has left";
  const core::Json accounts = client_.ask("GET", "/api/v1/accounts", admin_).json()["accounts"];
  ASSERT_EQ(accounts.size(), 2u);
  for (const core::Json& one : accounts)
    EXPECT_EQ(one["state"], one["name"] == "una" ? "disabled" : "active");
  EXPECT_EQ(role_in("pgy1"), "trainee") << "and comes back";
}

TEST_P(Oidc, ALinkThatEndedAnAccountSwitchedOffAndAnothersSubjectOpenNothing) {
  const std::string id = linked_account("fay", "fay"), other = linked_account("flo", "flo");
  EXPECT_EQ(link(other, "fay"), 409);
  EXPECT_EQ(
      client_.ask("POST", "/api/v1/accounts/" + id + "/state", admin_, "{\"state\":\"disabled\"}")
          .status,
      200);
  EXPECT_EQ(end_of(sign_in("fay")), base_ + "/?sign_in=unknown");
  EXPECT_EQ(link(other, ""), 204);
  EXPECT_EQ(end_of(sign_in("flo")), base_ + "/?sign_in=unknown");
}

TEST_P(Oidc, AForeignStateACodeOfNobodysAndAnotherBrowserComeToNothing) {
  linked_account("fay", "fay");
  for (const char* tamper : {"state", "code", "nocookie"}) {
    const auto browsed = sign_in("fay", tamper);
    EXPECT_EQ(end_of(browsed), base_ + "/?sign_in=failed") << tamper << browsed.dump();
    EXPECT_FALSE(browsed["cookies"].contains("tractus_session")) << tamper;
  }
}

INSTANTIATE_TEST_SUITE_P(By, Oidc, ::testing::Values("RS256", "ES256"),
                         [](const auto& named) { return std::string(named.param); });

}  // namespace
}  // namespace tractus
