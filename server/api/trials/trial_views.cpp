#include "server/api/trials/trial_views.hpp"

#include <algorithm>

#include "core/try.hpp"

namespace tractus::api {

std::shared_ptr<const trial::Signals> TrialViews::known(const std::string& trial_id) {
  const std::lock_guard held(mutex_);
  const auto found = std::ranges::find(entries_, trial_id, &Entry::trial_id);
  if (found == entries_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found);
  return found->signals;
}

void TrialViews::keep(Entry entry) {
  const std::lock_guard held(mutex_);
  bytes_ += entry.bytes;
  entries_.push_front(std::move(entry));
  while (bytes_ > limit_bytes_ && entries_.size() > 1) {
    bytes_ -= entries_.back().bytes;
    entries_.pop_back();
  }
}

std::size_t TrialViews::bytes() const {
  const std::lock_guard held(mutex_);
  return bytes_;
}

core::Result<std::shared_ptr<const trial::Signals>> TrialViews::of(const std::string& trial_id,
                                                                   const Decode& decode) {
  if (auto there = known(trial_id)) return there;
  const std::lock_guard one(decoding_);
  if (auto there = known(trial_id)) return there;
  auto decoded = TRY(decode());
  const std::size_t bytes = decoded.size() * trial::Signals::kBytesPerSample;
  auto signals = std::make_shared<const trial::Signals>(std::move(decoded));
  keep({trial_id, signals, bytes});
  return signals;
}

}  // namespace tractus::api
