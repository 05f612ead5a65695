/// Formulas for what no catalogue explains: searched on the recordings, fitted as user effects, and
/// weighed against the catalogue's answer and against functions without a formula.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "lab/discover/unknown_function.hpp"
#include "lab/identify/diagnosis.hpp"

namespace tractus::lab {

struct ProposedNumber {
  std::string name, unit, meaning;
  double value = 0.0, low = 0.0, high = 0.0;  ///< 90 % interval
};

/// One product of a proposal, ready to be added.
struct ProposedTerm {
  std::string formula, words;  ///< words: what it resembles in physics
  std::vector<ProposedNumber> numbers;
  core::Json effect;  ///< tractus-effect/1
};

struct Proposal {
  std::vector<ProposedTerm> terms;
  std::vector<std::string> beside;  ///< effects of the catalogue that it stands beside
  double rmse = 0.0, held_out_rmse = 0.0;
  double probability = 0.0;  ///< that it is right, among all that was tried
  double stability = 0.0;    ///< share of resamplings of the trials in which it scores best
  int trials_improved = 0, trials = 0;
  int size = 0;  ///< factors and numbers: less is simpler
  bool passive = false;
};

struct Discovery {
  std::vector<Proposal> proposals;         ///< most probable first
  std::optional<UnknownFunction> unknown;  ///< the best one
  double unknown_probability = 0.0;        ///< that it is no formula of the grammar
  double catalogue_probability = 0.0;      ///< that the diagnosis' own answer is right
  std::size_t formulas_tried = 0;
  double base_held_out_rmse = 0.0, noise_floor = 0.0;
  std::string remark;  ///< why there is nothing, or what to know of it
};

struct DiscoverOptions {
  int threads = 2;
  std::size_t most = 5;  ///< proposals
};

/// "amplitude * sgn(v_m_s) + amplitude * x_m^2": the terms' formulas joined.
std::string formula_text(const Proposal& proposal);
/// A paragraph for people. @param unit  of the errors.
std::string sentences(const Discovery& discovery, std::string_view unit);

/// @param diagnosis  of the same problem. Errors: cancelled.
core::Result<Discovery> discover(const Problem& problem, const Diagnosis& diagnosis,
                                 const DiscoverOptions& options = {},
                                 const core::Progress& progress = {});

}  // namespace tractus::lab
