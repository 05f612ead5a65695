/// What a station is told of a trial's result, for the trainee who did it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "core/named.hpp"

namespace tractus::wire {

enum class ResultState {
  held,       ///< the trainee may not see it yet, or ever
  assessing,  ///< it comes in a moment
  assessed,
  failed,  ///< the trial could not be assessed
};
constexpr auto words(ResultState) {
  using enum ResultState;
  return std::to_array<core::Word<ResultState>>(
      {{held, "held"}, {assessing, "assessing"}, {assessed, "assessed"}, {failed, "failed"}});
}

/// One value, with its name and unit as on the pages.
struct ResultScore {
  std::string label, unit;
  std::string shown_as;  ///< word of metrics::ShownAs
  double value = 0.0;
};

struct TrialResult {
  ResultState state = ResultState::held;
  std::optional<bool> correct = {};      ///< the answer; empty: it is not known
  std::vector<ResultScore> scores = {};  ///< those that a trainee's page follows, in its order

  core::Json to_json() const;
  /// Errors: bad_input naming `where` and the field.
  static core::Result<TrialResult> from_json(const core::Json& json, const std::string& where);
};

}  // namespace tractus::wire
