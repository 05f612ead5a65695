#include "effects/probing_effect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/try.hpp"
#include "effects/expression.hpp"

namespace tractus {
namespace effects {
namespace probing {
std::vector<ProbingEffectInfo> all();  // made by the build from the files of probing/
}

namespace {

/// A user's formula, added to the resistance. A speed that counts as rest is 0 in it, so that sgn
/// v_m_s does not chatter.
class ExpressionForce final : public ProbeForce {
 public:
  ExpressionForce(FormulaProgram program, std::span<const double> values)
      : program_(std::move(program)) {
    std::ranges::copy(values, program_.inputs().last(values.size()).begin());
  }
  double force_N(const ProbingTick& tick, double base_N,
                 ProbingMemory& memory) const noexcept override {
    if (program_.remembers() && !memory.formula.started && tick.dt_s > 0.0) {
      // Live, the first moment that is asked for comes after the start: there the probe rested.
      ProbingTick start = tick;
      start.t_s -= tick.dt_s;
      start.x_m = memory.depth_m;
      start.v_m_s = start.a_m_s2 = 0.0;
      value(start, base_N, memory.formula);
    }
    return value(tick, base_N, memory.formula);
  }

 private:
  double value(const ProbingTick& tick, double base_N, FormulaMemory& memory) const noexcept {
    const auto in = program_.inputs();
    in[0] = tick.x_m;
    in[1] = std::abs(tick.v_m_s) <= tick.rest_m_s ? 0.0 : tick.v_m_s;
    in[2] = tick.a_m_s2;
    in[3] = tick.theta_rad;
    in[4] = tick.omega_rad_s;
    in[5] = tick.t_s;
    in[6] = tick.tz_Nm;
    in[7] = base_N;
    return program_.value({tick.dt_s, tick.rest_m_s}, memory);
  }

  FormulaProgram program_;
};

core::Result<ProbingEffect> make_expression(const EffectInstance& use) {
  auto expression = TRY(Expression::of(use, probing_expressions()));
  TRY(check(expression.facts(), use.values));
  auto program = TRY(expression.program());
  return ProbingEffect(std::unique_ptr<ProbeForce>(
      std::make_unique<ExpressionForce>(std::move(program), use.values)));
}

core::Error unknown_probing_effect(std::string_view id) {
  return {core::Errc::not_found, fmt::format("'{}' is not an effect of the probing rig", id)};
}

}  // namespace

const std::vector<ProbingEffectInfo>& probing_effects() {
  static const std::vector<ProbingEffectInfo> kAll = probing::all();
  return kAll;
}

const ProbingEffectInfo* find_probing_effect(std::string_view id) {
  for (const ProbingEffectInfo& info : probing_effects())
    if (info.facts.id == id) return &info;
  return nullptr;
}

std::vector<double> spread(double low, double high, int count) {
  std::vector<double> out;
  for (int k = 0; k < count; ++k)
    out.push_back(low * std::pow(high / low, (k + 0.5) / double(count)));
  return out;
}

core::Result<EffectFacts> probing_facts(const EffectInstance& use) {
  if (is_expression(use.id)) {
    const auto expression = TRY(Expression::of(use, probing_expressions()));
    return expression.facts();
  }
  const auto* found = find_probing_effect(use.id);
  if (!found) return unknown_probing_effect(use.id);
  return found->facts;
}

core::Result<ProbingEffect> make_probing_effect(const EffectInstance& use) {
  if (is_expression(use.id)) return make_expression(use);
  const auto* found = find_probing_effect(use.id);
  if (!found) return unknown_probing_effect(use.id);
  TRY(check(found->facts, use.values));
  return found->make(use.values);
}

}  // namespace effects
}  // namespace tractus
