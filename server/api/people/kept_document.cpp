#include "server/api/people/kept_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "core/try.hpp"

namespace tractus {
namespace api {
namespace {

constexpr std::int64_t kFirstPause_s = 2, kLongestPause_s = 60;
constexpr int kDoublings = 5;  // 2 s * 2^5 is beyond the longest

}  // namespace

std::int64_t steady_now_s() {
  return std::chrono::duration_cast<std::chrono::seconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

core::Result<core::Json> fetched_json(const Fetch& what) {
  const auto got = TRY(fetch(what));
  auto out = core::parse_json(got.body, "the answer of " + what.who);
  if (got.status == 200 && out && out->is_object()) return out;
  return core::Error{core::Errc::unavailable,
                     fmt::format("{} answered with the HTTP status {}", what.who, got.status)};
}

core::Result<void> Breaker::check() const {
  const std::lock_guard held(mutex_);
  const std::int64_t wait_s = closed_until_s_ - now_s_();
  if (failures_ == 0 || wait_s <= 0) return {};
  return core::Error{core::Errc::unavailable,
                     fmt::format("{}; the next attempt is possible in {} s", why_, wait_s)};
}

void Breaker::succeeded() {
  const std::lock_guard held(mutex_);
  failures_ = 0;
}

void Breaker::failed(const core::Error& error) {
  const std::lock_guard held(mutex_);
  const std::int64_t pause_s = kFirstPause_s << std::min(failures_, kDoublings);
  closed_until_s_ = now_s_() + std::min(pause_s, kLongestPause_s);
  why_ = error.what;
  ++failures_;
}

bool KeptDocument::is_fresh(std::int64_t age_s) const {
  return kept_ && now_s_() - kept_since_s_ < age_s;
}

core::Result<core::Json> KeptDocument::asked(const Ask& ask) const try {
  auto outcome = ask();
  if (outcome)
    breaker_.succeeded();
  else
    breaker_.failed(outcome.error());
  return outcome;
} catch (const std::exception&) {  // out of memory: those who wait have to hear of it
  return core::Error{core::Errc::unavailable, "no memory for the provider's answer"};
}

core::Result<core::Json> KeptDocument::at_most(std::int64_t age_s, const Ask& ask) {
  std::unique_lock held(mutex_);
  if (is_fresh(age_s)) return *kept_;
  if (asking_) {
    answered_.wait(held, [this, before = answers_] { return answers_ != before; });
    return last_;
  }
  TRY(breaker_.check());
  asking_ = true;
  held.unlock();
  auto outcome = asked(ask);
  held.lock();
  asking_ = false;
  ++answers_;
  last_ = std::move(outcome);
  if (last_) kept_ = *last_, kept_since_s_ = now_s_();
  answered_.notify_all();
  return last_;
}

}  // namespace api
}  // namespace tractus
