/// An expert's tuning of a scenario: the eight parameters nudged while the probe is felt.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "scenarios/version.hpp"

namespace tractus::session {

/// One of the eight [Probing, Table 1], as a person sees it.
struct TunedParameter {
  const char* symbol;  ///< "K"
  const char* field;   ///< of the file: "bone/stiffness_N_per_m"
  double least_step;   ///< of a nudge, in the field's unit
};

/// A value: what was tuned so far, and how to go back. Knows no keys and no rig.
class Tuning {
 public:
  static constexpr std::size_t kParameters = 8;
  static constexpr double kShare = 0.05;  ///< of a value that a nudge changes it by
  static std::span<const TunedParameter, kParameters> parameters();

  explicit Tuning(scenarios::Scenario scenario) : parent_(scenario), now_(std::move(scenario)) {}

  double value(std::size_t parameter) const;
  /// By 5 % of its value, or its least step if that is more, up (+1) or down (−1). Errors: what
  /// Scenario::check refuses; nothing is changed then.
  core::Result<void> nudge(std::size_t parameter, int direction);
  /// Takes the last nudge back; false when there is none.
  bool undo();
  bool changed() const { return !before_.empty(); }
  const scenarios::Scenario& now() const { return now_; }

  /// A new version of the scenario, with who and when, and the parent's id. From then on it is the
  /// parent. Errors: bad_input (nobody named, nothing changed).
  core::Result<scenarios::Scenario> save(const std::string& who, std::int64_t when_utc_us);

 private:
  scenarios::Scenario parent_, now_;
  std::vector<scenarios::Scenario> before_;
};

}  // namespace tractus::session
