#include "probing/outside.hpp"

#include <algorithm>
#include <cmath>

#include "support/angle.hpp"

namespace blind {
namespace {

/// Damping stronger on the way in than out: D (1 + κ sgn v).
class DirectionDamping final : public Term {
 public:
  explicit DirectionDamping(const Parameters& p) : asymmetry_(p.at("asymmetry")) {}
  void add(const Moment& m, const Layer* layer, double, Resistance& r) const override {
    if (layer == nullptr) return;
    r.damping_Ns_per_m += asymmetry_ * layer->damping_Ns_per_m * sign_of(m.v_m_s);
  }

 private:
  double asymmetry_;
};

/// μ |F_base| sgn v.
class LoadFriction final : public Term {
 public:
  explicit LoadFriction(const Parameters& p) : coefficient_(p.at("coefficient")) {}
  void add(const Moment&, const Layer*, double base_N, Resistance& r) const override {
    r.friction_N += coefficient_ * std::abs(base_N);
  }

 private:
  double coefficient_;
};

/// A random function of depth, band-limited, the same in every trial: sum of cosines.
class BoneTexture final : public Term {
 public:
  BoneTexture(const Parameters& p, std::uint64_t seed) : amplitude_(p.at("amplitude_N")) {
    Random random(seed ^ 0x7E87);
    const double length = p.at("length_m");
    for (Wave& wave : waves_) {
      wave.number = kTwoPi / length * random.uniform(0.15, 1.0);
      wave.phase = random.uniform(0, kTwoPi);
      wave.weight = random.normal() * std::sqrt(1.0 / kWaves);
    }
  }
  void add(const Moment& m, const Layer*, double, Resistance& r) const override {
    double sum = 0;
    for (const Wave& wave : waves_) sum += wave.weight * std::cos(wave.number * m.x_m + wave.phase);
    r.rest_N += amplitude_ * sum;
  }

 private:
  static constexpr int kWaves = 48;
  struct Wave {
    double number, phase, weight;
  };
  double amplitude_;
  Wave waves_[kWaves];
};

/// The bone softens with every pass through it: exp(−γ · passes), passes counted over all trials of
/// the specimen.
class TractWear final : public Term {
 public:
  explicit TractWear(const Parameters& p) : per_pass_(p.at("loss_per_pass")) {}
  void begin(const TrialContext& trial, const Moment&) override { depth_ = trial.depth_m; }
  double base_factor(const Moment&) const override {
    return std::exp(-per_pass_ * path_ / (2.0 * depth_));
  }
  void step(const Moment& from, const Moment& to) override { path_ += std::abs(to.x_m - from.x_m); }

 private:
  double per_pass_, depth_ = 1, path_ = 0;
};

/// + K α (x − start)²: a spring that stiffens with depth.
class StiffnessNonlinearity final : public Term {
 public:
  explicit StiffnessNonlinearity(const Parameters& p) : curvature_(p.at("curvature_per_m")) {}
  void add(const Moment& m, const Layer* layer, double, Resistance& r) const override {
    if (layer == nullptr) return;
    const double depth = m.x_m - layer->start_m;
    r.rest_N += curvature_ * layer->stiffness_N_per_m * depth * depth;
  }

 private:
  double curvature_;
};

/// A load from the side that comes and goes like breath, of changing depth and rate; no channel
/// records it.
class LateralLoad final : public Term {
 public:
  explicit LateralLoad(const Parameters& p) : amplitude_(p.at("amplitude_N")) {}
  void begin(const TrialContext& trial, const Moment&) override {
    Random random(trial.seed ^ 0x1A7E);
    for (Wave& wave : waves_) {
      wave.rate = kTwoPi * random.uniform(0.15, 0.6);
      wave.phase = random.uniform(0, kTwoPi);
      wave.weight = 0.6 * random.normal();
    }
  }
  void add(const Moment& m, const Layer*, double, Resistance& r) const override {
    for (const Wave& wave : waves_)
      r.rest_N += amplitude_ * wave.weight * std::sin(wave.rate * m.t_s + wave.phase);
  }

 private:
  struct Wave {
    double rate = 0, phase = 0, weight = 0;
  };
  double amplitude_;
  Wave waves_[5];
};

/// Two Maxwell branches of very different times.
class TwoBranch final : public Term {
 public:
  explicit TwoBranch(const Parameters& p)
      : stiffness_{p.at("fast_stiffness_N_per_m"), p.at("slow_stiffness_N_per_m")},
        time_{p.at("fast_time_s"), p.at("slow_time_s")} {}
  void begin(const TrialContext&, const Moment&) override { q_[0] = q_[1] = 0; }
  void add(const Moment&, const Layer*, double, Resistance& r) const override {
    r.rest_N += stiffness_[0] * q_[0] + stiffness_[1] * q_[1];
  }
  void step(const Moment& from, const Moment& to) override {
    const double dt = to.t_s - from.t_s;
    for (int i = 0; i < 2; ++i) {
      const double decay = std::exp(-dt / time_[i]);
      q_[i] = q_[i] * decay + (to.x_m - from.x_m) / dt * time_[i] * (1.0 - decay);
    }
  }

 private:
  double stiffness_[2], time_[2], q_[2] = {0, 0};
};

/// Trabeculae break: on new ground the force builds up over a random length and drops; behind the
/// front nothing.
class Fracture final : public Term {
 public:
  explicit Fracture(const Parameters& p)
      : rise_(p.at("rise_N_per_m")), spacing_(p.at("spacing_m")) {}
  void begin(const TrialContext& trial, const Moment& m) override {
    random_ = Random(trial.seed ^ 0xF7AC);
    front_ = from_ = m.x_m;
    next_ = front_ + spacing_ * random_.uniform(0.3, 1.7);
  }
  void add(const Moment& m, const Layer*, double, Resistance& r) const override {
    r.rest_N += rise_ * std::max(0.0, (front_ - from_) - (front_ - m.x_m));
  }
  void step(const Moment&, const Moment& to) override {
    front_ = std::max(front_, to.x_m);
    if (front_ < next_) return;
    from_ = front_;
    next_ = front_ + spacing_ * random_.uniform(0.3, 1.7);
  }

 private:
  double rise_, spacing_;
  Random random_{0};
  double front_ = 0, from_ = 0, next_ = 0;
};

}  // namespace

std::unique_ptr<Term> make_outside_term(const HiddenEffect& effect, std::uint64_t set_seed) {
  const Parameters& p = effect.parameters;
  if (effect.id == "direction_damping") return std::make_unique<DirectionDamping>(p);
  if (effect.id == "load_friction") return std::make_unique<LoadFriction>(p);
  if (effect.id == "bone_texture") return std::make_unique<BoneTexture>(p, set_seed);
  if (effect.id == "tract_wear") return std::make_unique<TractWear>(p);
  if (effect.id == "stiffness_nonlinearity") return std::make_unique<StiffnessNonlinearity>(p);
  if (effect.id == "lateral_load") return std::make_unique<LateralLoad>(p);
  if (effect.id == "two_branch_relaxation") return std::make_unique<TwoBranch>(p);
  if (effect.id == "fracture") return std::make_unique<Fracture>(p);
  return nullptr;
}

}  // namespace blind
