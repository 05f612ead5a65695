/// How far a run of the lab has come, told to the database; and whether it shall stop.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "core/progress.hpp"
#include "db/store/store.hpp"

namespace tractus::jobs {

/// Notes share and phase about twice a second, a new phase at once. Used from the one thread that
/// works; outlives the progresses it hands out.
class LabProgress {
 public:
  /// @param ending  true when the server wants to end.
  LabProgress(store::Store& store, std::string run_id, std::function<bool()> ending);

  /// A piece of the work, in words, with its share of the whole.
  core::Progress at(const std::string& phase, double from, double width);
  /// The next phase within the same piece.
  void say(const std::string& phase);

 private:
  bool note(double share);

  store::Store& store_;
  std::string run_id_, phase_;
  std::function<bool()> ending_;
  double share_ = 0.0;
  std::chrono::steady_clock::time_point next_{};  ///< not before this is it noted again
};

}  // namespace tractus::jobs
