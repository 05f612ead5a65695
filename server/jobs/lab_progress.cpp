#include "server/jobs/lab_progress.hpp"

#include <algorithm>

#include "core/clock.hpp"
#include "db/store/lab/lab.hpp"

namespace tractus::jobs {
namespace {
constexpr std::chrono::milliseconds kBetween{500};
}

LabProgress::LabProgress(store::Store& store, std::string run_id, std::function<bool()> ending)
    : store_(store), run_id_(std::move(run_id)), ending_(std::move(ending)) {}

core::Progress LabProgress::at(const std::string& phase, double from, double width) {
  say(phase);
  return [this, from, width](double share) {
    return note(from + width * std::clamp(share, 0.0, 1.0));
  };
}

void LabProgress::say(const std::string& phase) {
  if (phase == phase_) return;
  phase_ = phase;
  next_ = {};
}

bool LabProgress::note(double share) {
  if (ending_()) return false;
  share_ = std::max(share_, share);  // a bar does not run back
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return true;
  next_ = now + kBetween;
  const auto stop = store_.write_beside([&](store::Writing& tx) {
    return store::note_lab_share(tx, run_id_, share_, phase_, core::utc_us());
  });
  return !stop || !*stop;  // a database that is busy for once stops nothing
}

}  // namespace tractus::jobs
