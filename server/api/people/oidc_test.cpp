/// A provider of identities that hangs, drips, fails, changes its keys and comes back.
#include "server/api/people/oidc.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <condition_variable>
#include <thread>

#include "server/api/people/id_token_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using core::Json;
using testing::Signer;
using namespace std::chrono_literals;

constexpr std::int64_t kUtc_s = 1'000'000;

/// A provider on a free port of this machine. Every connection has a thread of its own.
class Provider {
 public:
  enum class Mood { works, hangs, drips, fails };

  Provider() : listening_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(::bind(listening_, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(::listen(listening_, 64), 0);
    EXPECT_EQ(::getsockname(listening_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    issuer = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    accepting_ = std::thread([this] { accept_all(); });
  }
  ~Provider() {
    {
      const std::lock_guard held(mutex_);
      ending_ = true;
    }
    changed_.notify_all();
    ::shutdown(listening_, SHUT_RDWR);
    accepting_.join();
    for (auto& thread : threads_) thread.join();
    ::close(listening_);
  }
  Provider(const Provider&) = delete;
  Provider& operator=(const Provider&) = delete;

  void is(Mood mood, const std::string& where = "") {
    {
      const std::lock_guard held(mutex_);
      mood_ = mood;
      where_ = where;
    }
    changed_.notify_all();
  }
  /// The key that it signs by, and shows.
  void uses(const std::string& kid) {
    const std::lock_guard held(mutex_);
    kid_ = kid;
  }
  int asked(const std::string& path) {
    const std::lock_guard held(mutex_);
    return asked_[path];
  }

  std::string issuer;

 private:
  void accept_all() {
    while (true) {
      const int peer = ::accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
      if (peer < 0) return;
      threads_.emplace_back([this, peer] {
        answer(peer);
        ::close(peer);
      });
    }
  }
  void answer(int peer) {
    std::string request(8192, '\0');
    const ssize_t size = ::recv(peer, request.data(), request.size(), 0);
    if (size <= 0) return;
    const auto from = request.find('/');
    const std::string path = request.substr(from, request.find(' ', from) - from);
    const bool good = request.find("code=good") != std::string::npos;
    std::unique_lock held(mutex_);
    ++asked_[path];
    const Mood mood = where_.empty() || where_ == path ? mood_ : Mood::works;
    if (mood == Mood::hangs) return changed_.wait(held, [this] { return left(); });
    const auto [status, body] =
        mood == Mood::fails ? std::pair(500, Json::object()) : document(path, good);
    held.unlock();
    if (mood == Mood::drips) return drip(peer);
    const std::string text = body.dump();
    send(peer, head(status, text.size()) + text);
  }
  /// Called under the lock.
  bool left() const { return ending_ || mood_ != Mood::hangs; }
  void drip(int peer) {
    bool open = send(peer, head(200, 100'000));
    std::unique_lock held(mutex_);
    while (open && !ending_) {
      changed_.wait_for(held, 10ms);
      held.unlock();
      open = send(peer, " ");
      held.lock();
    }
  }
  static std::string head(int status, std::size_t size) {
    return "HTTP/1.1 " + std::to_string(status) +
           " X\r\nContent-Type: application/json\r\nConnection: close\r\nContent-Length: " +
           std::to_string(size) + "\r\n\r\n";
  }
  static bool send(int peer, const std::string& text) {
    return ::send(peer, text.data(), text.size(), MSG_NOSIGNAL) == ssize_t(text.size());
  }
  std::pair<int, Json> document(const std::string& path, bool good_code) const {
    if (path == "/keys") return {200, {{"keys", {signer_.jwk(kid_)}}}};
    if (path == "/token" && !good_code) return {400, {{"error", "invalid_grant"}}};
    if (path == "/token")
      return {200, {{"id_token", signer_.token(claims(), {{"alg", "RS256"}, {"kid", kid_}})}}};
    return {200,
            {{"issuer", issuer},
             {"authorization_endpoint", issuer + "/authorize"},
             {"token_endpoint", issuer + "/token"},
             {"jwks_uri", issuer + "/keys"}}};
  }
  Json claims() const {
    return {{"iss", issuer},       {"aud", "tractus"},  {"sub", "person-7"},
            {"exp", kUtc_s + 300}, {"iat", kUtc_s - 5}, {"nonce", "n-1"}};
  }

  Signer signer_;
  int listening_;
  std::mutex mutex_;  ///< guards what follows
  std::condition_variable changed_;
  Mood mood_ = Mood::works;
  std::string where_, kid_ = "k1";
  bool ending_ = false;
  std::map<std::string, int> asked_;
  std::thread accepting_;
  std::vector<std::thread> threads_;  ///< of accepting_ until it ended
};

constexpr const char* kDescription = "/.well-known/openid-configuration";
using Mood = Provider::Mood;

class OidcProvider : public ::testing::Test {
 protected:
  bool starts() { return bool(oidc_.sign_in_address({"s", "n-1", "v"})); }
  core::Result<Identity> redeems(const std::string& code = "good") {
    return oidc_.redeemed(code, {"s", "n-1", "v"}, kUtc_s);
  }

  Provider provider_;
  std::atomic<std::int64_t> now_s_ = 1000;
  Oidc oidc_{{.issuer = provider_.issuer,
              .client_id = "tractus",
              .client_secret = "secret",
              .base = "http://127.0.0.1:1",
              .label = "",
              .authority = {},
              .patience = 300ms},
             [this] { return now_s_.load(); }};
};

TEST_F(OidcProvider, ManyWhoComeWhileItHangsWaitForOneAnswerAndNotLongerThanItsPatience) {
  provider_.is(Mood::hangs);
  const auto begun = std::chrono::steady_clock::now();
  std::atomic<int> failed = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 16; ++i) threads.emplace_back([&] { failed += !starts(); });
  for (auto& thread : threads) thread.join();
  const auto took = std::chrono::steady_clock::now() - begun;
  EXPECT_EQ(failed, 16);
  EXPECT_EQ(provider_.asked(kDescription), 1);
  EXPECT_GE(took, 250ms) << "it was asked and waited for";
  EXPECT_LT(took, 3s) << "sixteen times the patience would be 4.8 s";
}

TEST_F(OidcProvider, AnAnswerThatDripsIsCutOffAsAWhole) {
  provider_.is(Mood::drips);
  const auto begun = std::chrono::steady_clock::now();
  EXPECT_FALSE(starts());
  EXPECT_LT(std::chrono::steady_clock::now() - begun, 3s) << "100 000 bytes take 1000 s";
}

TEST_F(OidcProvider, OneThatFailsIsAskedAgainAfterTwiceTheTimeEachTimeAndAtMostAMinute) {
  provider_.is(Mood::fails);
  std::vector<std::int64_t> asked_s;
  for (const std::int64_t begun_s = now_s_; now_s_ < begun_s + 190; ++now_s_) {
    const int before = provider_.asked(kDescription);
    EXPECT_FALSE(starts());
    if (provider_.asked(kDescription) > before) asked_s.push_back(now_s_ - begun_s);
  }
  EXPECT_EQ(asked_s, (std::vector<std::int64_t>{0, 2, 6, 14, 30, 62, 122, 182}));
}

TEST_F(OidcProvider, OneThatComesBackIsAskedOnceAndThenKept) {
  provider_.is(Mood::fails);
  EXPECT_FALSE(starts());
  provider_.is(Mood::works);
  EXPECT_FALSE(starts()) << "it is left alone for two seconds";
  now_s_ += 2;
  EXPECT_TRUE(starts());
  EXPECT_TRUE(redeems());
  const int asked = provider_.asked(kDescription);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(starts());
  EXPECT_EQ(provider_.asked(kDescription), asked);
  provider_.is(Mood::hangs);
  EXPECT_TRUE(starts()) << "what is kept needs no answer";
}

TEST_F(OidcProvider, ANewKeyIsFetchedWhenATokenNamesItAndTheOldOneIsTenSecondsOld) {
  const auto first = redeems();
  ASSERT_TRUE(first) << first.error().what;
  EXPECT_EQ(first->subject, "person-7");
  provider_.uses("k2");
  now_s_ += 5;
  const auto early = redeems();
  ASSERT_FALSE(early);
  EXPECT_EQ(early.error().code, core::Errc::unauthorised);
  EXPECT_EQ(provider_.asked("/keys"), 1);
  now_s_ += 5;
  EXPECT_TRUE(redeems());
  EXPECT_EQ(provider_.asked("/keys"), 2);
}

TEST_F(OidcProvider, KeysThatCannotBeFetchedAgainLeaveTheKnownOnesInForce) {
  ASSERT_TRUE(redeems());
  provider_.uses("k2");
  provider_.is(Mood::fails, "/keys");
  now_s_ += 11;
  EXPECT_FALSE(redeems());
  provider_.uses("k1");
  now_s_ += 2;
  EXPECT_TRUE(redeems());
}

TEST_F(OidcProvider, WrongCodesKeepNobodyOut) {
  for (int i = 0; i < 5; ++i) {
    const auto refused = redeems("guess");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, core::Errc::unauthorised);
  }
  EXPECT_TRUE(redeems());
}

TEST_F(OidcProvider, ATokenEndpointThatHangsIsLeftAloneForAWhile) {
  ASSERT_TRUE(redeems());
  provider_.is(Mood::hangs, "/token");
  EXPECT_FALSE(redeems());
  EXPECT_FALSE(redeems());
  EXPECT_EQ(provider_.asked("/token"), 2) << "one that worked, one that hung";
  provider_.is(Mood::works);
  now_s_ += 2;
  EXPECT_TRUE(redeems());
}

}  // namespace
}  // namespace api
}  // namespace tractus
