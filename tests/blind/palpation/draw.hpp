#pragma once
/// What a palpation set is: volume, probe, hidden effects and the supplied model, all from a
/// seed.
#include <cstdint>

#include "palpation/hand.hpp"

namespace blind {

struct PalpationRequest {
  std::uint64_t seed = 0;
  std::string kind;              ///< "", "single", "pair", "none", "base_wrong" or "outside"
  std::vector<std::string> ids;  ///< of the effects, when they are not to be drawn
  int trials = 8;
  double duration_s = 8.0, rate_Hz = 200.0;
  bool states_tract = false;  ///< in set.json: where the channel is
  std::filesystem::path ct;   ///< a real scan, used by some seeds; empty: never
};

struct PalpationPlan {
  PalpationRequest request;
  std::string kind, source;
  Volume volume;
  Tract tract;
  Transfer transfer;
  FieldKind field = FieldKind::kPaper;
  Probe truth, supplied;
  std::string how;
  std::vector<std::string> fixed;  ///< names of base parameters
  std::vector<Hidden> effects;
  std::vector<double> strengths;
  std::vector<std::uint64_t> trial_seeds;
  double tempo = 1;  ///< how much faster than usual the hands work
  bool jumps_allowed = false;
};

const std::vector<std::string>& palpation_catalogue();
const std::vector<std::string>& palpation_outside();
PalpationPlan draw_palpation(const PalpationRequest& request);

/// Makes an effect about `factor` times as strong.
void enlarge(Hidden& effect, double factor, const Probe& probe);
/// Whether its size is one that a probe and a bone can have.
bool plausible(const Hidden& effect, const Probe& probe);

}  // namespace blind
