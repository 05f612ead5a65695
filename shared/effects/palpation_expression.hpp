/// A user's formula on the palpation rig.
#pragma once

#include "effects/expression.hpp"
#include "effects/palpation_effect.hpp"

namespace tractus::effects {

/// f_N, a force at each contact point against its motion, F = −f v/|v|; from v_m_s, v_n_m_s,
/// v_t_m_s, base_N and opacity of that point.
const ExpressionRig& palpation_expressions();

/// The formula of a use as a force at the contact points. Errors: bad_input naming what is wrong in
/// the definition; out_of_range naming the parameter.
core::Result<PalpationEffect> make_palpation_expression(const EffectInstance& use);

}  // namespace tractus::effects
