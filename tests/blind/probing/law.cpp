#include "probing/law.hpp"

#include <algorithm>
#include <cmath>

namespace blind {

double sign_of(double value) { return value > 0 ? 1.0 : value < 0 ? -1.0 : 0.0; }

const Layer* Base::at(double x_m) const {
  for (const Layer& layer : layers)
    if (x_m >= layer.start_m && x_m < layer.start_m + layer.thickness_m) return &layer;
  return nullptr;
}

Physics::Physics(Base base, const std::vector<HiddenEffect>& effects, std::uint64_t set_seed)
    : base_(std::move(base)) {
  for (const HiddenEffect& effect : effects)
    if (auto term = make_term(effect, set_seed)) terms_.push_back(std::move(term));
}

void Physics::begin(const TrialContext& trial, const Moment& first) {
  last_sign_ = 0;
  for (auto& term : terms_) term->begin(trial, first);
}

Resistance Physics::at(const Moment& m) const {
  Moment seen = m;
  double factor = 1.0;
  for (const auto& term : terms_) {
    seen = term->seen(seen);
    factor *= term->base_factor(m);
  }
  Resistance out;
  const Layer* layer = base_.at(seen.x_m);
  if (layer != nullptr) {
    out.rest_N = factor * layer->stiffness_N_per_m * (seen.x_m - layer->equilibrium_m);
    out.damping_Ns_per_m = factor * layer->damping_Ns_per_m;
    if (seen.v_m_s != m.v_m_s) {  // the bone moves with a speed of its own
      out.rest_N += out.damping_Ns_per_m * seen.v_m_s;
      out.damping_Ns_per_m = 0;
    }
  }
  const double base_N = out.rest_N + out.damping_Ns_per_m * m.v_m_s;
  for (const auto& term : terms_) term->add(m, layer, base_N, out);
  return out;
}

double Physics::force(const Moment& m) const {
  const Resistance r = at(m);
  const double sign = m.v_m_s != 0 ? sign_of(m.v_m_s) : last_sign_;
  return r.rest_N + r.damping_Ns_per_m * m.v_m_s + r.drag_Ns2_per_m2 * m.v_m_s * std::abs(m.v_m_s) +
         r.friction_N * sign + r.mass_kg * m.a_m_s2;
}

void Physics::step(const Moment& from, const Moment& to) {
  if (from.v_m_s != 0) last_sign_ = sign_of(from.v_m_s);
  for (auto& term : terms_) term->step(from, to);
}

}  // namespace blind
