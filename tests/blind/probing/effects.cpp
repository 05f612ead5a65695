/// The catalogue's effects on the force, one small class each, from the table of laws.
#include <cmath>

#include "probing/law.hpp"
#include "probing/outside.hpp"
#include "support/angle.hpp"

namespace blind {
namespace {

class Inertia final : public Term {
 public:
  explicit Inertia(const Parameters& p) : mass_(p.at("mass_kg")) {}
  void add(const Moment&, const Layer*, double, Resistance& r) const override {
    r.mass_kg += mass_;
  }

 private:
  double mass_;
};

class Coulomb final : public Term {
 public:
  explicit Coulomb(const Parameters& p) : friction_(p.at("friction_N")) {}
  void add(const Moment&, const Layer*, double, Resistance& r) const override {
    r.friction_N += friction_;
  }

 private:
  double friction_;
};

class Stribeck final : public Term {
 public:
  explicit Stribeck(const Parameters& p)
      : slide_(p.at("friction_N")),
        break_(p.at("breakaway_N")),
        speed_(p.at("stribeck_velocity_m_s")) {}
  void add(const Moment& m, const Layer*, double, Resistance& r) const override {
    const double ratio = m.v_m_s / speed_;
    r.friction_N += slide_ + (break_ - slide_) * std::exp(-ratio * ratio);
  }

 private:
  double slide_, break_, speed_;
};

class Drag final : public Term {
 public:
  explicit Drag(const Parameters& p) : coefficient_(p.at("coefficient_Ns2_per_m2")) {}
  void add(const Moment&, const Layer*, double, Resistance& r) const override {
    r.drag_Ns2_per_m2 += coefficient_;
  }

 private:
  double coefficient_;
};

/// q̇ = v − q/τ, solved exactly for a speed constant over the step.
class Relaxation final : public Term {
 public:
  explicit Relaxation(const Parameters& p)
      : stiffness_(p.at("stiffness_N_per_m")), time_(p.at("time_constant_s")) {}
  void begin(const TrialContext&, const Moment&) override { q_ = 0; }
  void add(const Moment&, const Layer*, double, Resistance& r) const override {
    r.rest_N += stiffness_ * q_;
  }
  void step(const Moment& from, const Moment& to) override {
    const double dt = to.t_s - from.t_s;
    const double decay = std::exp(-dt / time_);
    q_ = q_ * decay + (to.x_m - from.x_m) / dt * time_ * (1.0 - decay);
  }

 private:
  double stiffness_, time_, q_ = 0;
};

/// ż = v − |v| z/δ, solved exactly for a speed constant over the step.
class Dahl final : public Term {
 public:
  explicit Dahl(const Parameters& p)
      : stiffness_(p.at("stiffness_N_per_m")), yield_(p.at("yield_displacement_m")) {}
  void begin(const TrialContext&, const Moment&) override { z_ = 0; }
  void add(const Moment&, const Layer*, double, Resistance& r) const override {
    r.rest_N += stiffness_ * z_;
  }
  void step(const Moment& from, const Moment& to) override {
    const double way = to.x_m - from.x_m;
    const double goal = sign_of(way) * yield_;
    z_ = goal + (z_ - goal) * std::exp(-std::abs(way) / yield_);
  }

 private:
  double stiffness_, yield_, z_ = 0;
};

/// A dead zone of full width: the bone's depth follows when an edge of the gap touches it.
/// `of_hand` = 1 leaves the damping with the hand's speed; 0 gives the bone its own.
class Backlash final : public Term {
 public:
  explicit Backlash(const Parameters& p)
      : half_(0.5 * p.at("gap_m")), of_hand_(p.at("of_hand") != 0) {}
  void begin(const TrialContext&, const Moment& m) override { bone_ = m.x_m; }
  Moment seen(const Moment& m) const override {
    Moment out = m;
    const bool pushed = m.x_m - bone_ >= half_ - kRounding && m.v_m_s > 0;
    const bool pulled = m.x_m - bone_ <= -half_ + kRounding && m.v_m_s < 0;
    out.x_m = std::min(std::max(bone_, m.x_m - half_), m.x_m + half_);
    if (!of_hand_ && !pushed && !pulled) out.v_m_s = 0;
    return out;
  }
  void step(const Moment&, const Moment& to) override {
    bone_ = std::min(std::max(bone_, to.x_m - half_), to.x_m + half_);
  }

 private:
  static constexpr double kRounding = 1e-12;
  double half_;
  bool of_hand_;
  double bone_ = 0;
};

class DepthFriction final : public Term {
 public:
  explicit DepthFriction(const Parameters& p) : slope_(p.at("slope_N_per_m")) {}
  void add(const Moment& m, const Layer*, double, Resistance& r) const override {
    r.friction_N += slope_ * std::max(m.x_m, 0.0);
  }

 private:
  double slope_;
};

class RotationCoupling final : public Term {
 public:
  explicit RotationCoupling(const Parameters& p) : coefficient_(p.at("coefficient_s_per_rad")) {}
  double base_factor(const Moment& m) const override {
    return 1.0 / (1.0 + coefficient_ * std::abs(m.omega_rad_s));
  }

 private:
  double coefficient_;
};

class Ripple final : public Term {
 public:
  explicit Ripple(const Parameters& p)
      : amplitude_(p.at("amplitude_N")), period_(p.at("period_m")), phase_(p.at("phase_rad")) {}
  void add(const Moment& m, const Layer*, double, Resistance& r) const override {
    r.rest_N += amplitude_ * std::sin(kTwoPi * m.x_m / period_ + phase_);
  }

 private:
  double amplitude_, period_, phase_;
};

template <class T>
std::unique_ptr<Term> make(const Parameters& p) {
  return std::make_unique<T>(p);
}

}  // namespace

std::unique_ptr<Term> make_term(const HiddenEffect& effect, std::uint64_t set_seed) {
  using Maker = std::unique_ptr<Term> (*)(const Parameters&);
  static const std::map<std::string, Maker> kMakers = {
      {"inertia", make<Inertia>},
      {"coulomb_friction", make<Coulomb>},
      {"stribeck_friction", make<Stribeck>},
      {"quadratic_drag", make<Drag>},
      {"viscoelastic_relaxation", make<Relaxation>},
      {"hysteresis", make<Dahl>},
      {"backlash", make<Backlash>},
      {"depth_friction", make<DepthFriction>},
      {"rotation_coupling", make<RotationCoupling>},
      {"force_ripple", make<Ripple>}};
  const auto found = kMakers.find(effect.id);
  if (found != kMakers.end()) return found->second(effect.parameters);
  return make_outside_term(effect, set_seed);
}

}  // namespace blind
