/// A provider of identities, or a learning platform, that can hang, drip, fail and change its keys.
#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>

#include "server/api/people/id_token_test_support.hpp"

namespace tractus::api::testing {

inline constexpr std::int64_t kUtc_s = 1'000'000;

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

  /// An id_token by the key that it shows.
  std::string token(const core::Json& of) {
    const std::lock_guard held(mutex_);
    return signer_.token(of, {{"alg", "RS256"}, {"kid", kid_}});
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
        mood == Mood::fails ? std::pair(500, core::Json::object()) : document(path, good);
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
      changed_.wait_for(held, std::chrono::milliseconds(10));
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
  std::pair<int, core::Json> document(const std::string& path, bool good_code) const {
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
  core::Json claims() const {
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

}  // namespace tractus::api::testing
