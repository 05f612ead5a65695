/// A cache of decoded trials for the web pages.
#pragma once

#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "core/result.hpp"
#include "trial/signals.hpp"

namespace tractus::api {

/// Keeps the most recently used trials, together at most `limit_bytes` (the newest always stays).
/// Decodes one trial at a time, so that many pages opened at the same time need the memory of one.
class TrialViews {
 public:
  using Decode = std::function<core::Result<trial::Signals>()>;
  explicit TrialViews(std::size_t limit_bytes = 256u << 20) : limit_bytes_(limit_bytes) {}

  core::Result<std::shared_ptr<const trial::Signals>> of(const std::string& trial_id,
                                                         const Decode& decode);
  std::size_t bytes() const;

 private:
  struct Entry {
    std::string trial_id;
    std::shared_ptr<const trial::Signals> signals;
    std::size_t bytes;
  };
  std::shared_ptr<const trial::Signals> known(const std::string& trial_id);
  void keep(Entry entry);

  std::size_t limit_bytes_;
  std::mutex decoding_;       ///< held while a trial is decoded
  mutable std::mutex mutex_;  ///< guards what follows
  std::list<Entry> entries_;  ///< most recent first
  std::size_t bytes_ = 0;
};

}  // namespace tractus::api
