#include "lab/experiments/preposterior.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "core/try.hpp"
#include "lab/experiments/probing_programs.hpp"
#include "lab/rigs/probing/problem.hpp"
#include "lab/signal/smoother.hpp"
#include "models/probing_runtime.hpp"

namespace tractus {
namespace lab {
namespace {

using core::Errc;
using core::Error;
using core::Result;

constexpr double kTravel_m = 0.3;  // more than any recording's

double middle_of(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

effects::ProbingMotion played(const trial::PlannedMotion& planned) {
  return {.t_s = planned.t_s,
          .x_m = planned.x_m,
          .v_m_s = planned.v_m_s,
          .a_m_s2 = planned.a_m_s2,
          .theta_rad = planned.theta_rad,
          .omega_rad_s = planned.omega_rad_s};
}

MotionRange range_of(const trial::ProbingSet& set) {
  MotionRange out{1e9, -1e9, 0.0, false};
  for (const auto& trial : set.trials) {
    const auto [least, most] = std::ranges::minmax(trial.x_m);
    out.least_m = std::min(out.least_m, least), out.most_m = std::max(out.most_m, most);
    if (trial.theta_rad.empty()) continue;
    const auto [from, to] = std::ranges::minmax(trial.theta_rad);
    out.turns = out.turns || to - from > 1e-3;
  }
  out.fastest_m_s = 0.08;
  return out;
}

/// A structure made ready to be recorded once more.
class SimulatedTruth {
 public:
  static Result<SimulatedTruth> make(const Problem& problem, const Hypothesis& hypothesis) {
    const auto model = TRY(models::ProbingModel::from_json(
        problem.model(hypothesis.structure, hypothesis.values), "hypothesis: "));
    auto runtime = TRY(models::ProbingRuntime::make(model, kTravel_m));
    SimulatedTruth out(std::move(runtime));
    for (int k = 0; k < problem.trials(); ++k)
      out.residuals_.push_back(noise_of(problem, hypothesis, k));
    for (const Candidate& candidate : problem.candidates())
      if (candidate.facts.free_per_trial &&
          std::ranges::find(hypothesis.structure.effects, candidate.facts.id) !=
              hypothesis.structure.effects.end())
        for (const Derived& d :
             problem.derived(hypothesis.structure, hypothesis.values, candidate.facts.id))
          out.drift_N_ = std::max(out.drift_N_, d.value);
    return out;
  }

  std::vector<double> force(const effects::ProbingMotion& motion) const {
    models::ProbingForces out;
    runtime_.predict(motion, out);
    return std::move(out.fz_N);
  }

  /// A recording of a motion: the model's force, a stretch of what was left of a real trial as its noise, a course of the
  /// sensor's zero where the structure has one, and noise on the position.
  trial::ProbingMeasurement recorded(const effects::ProbingMotion& motion, double x_noise_sd_m,
                                     std::mt19937_64& random) const {
    trial::ProbingMeasurement out;
    out.t_s = motion.t_s;
    out.x_m = motion.x_m;
    out.fz_N = force(motion);
    std::normal_distribution<double> normal;
    for (double& x : out.x_m) x += x_noise_sd_m * normal(random);
    const auto& noise =
        residuals_[std::uniform_int_distribution<std::size_t>(0, residuals_.size() - 1)(random)];
    std::size_t at = std::uniform_int_distribution<std::size_t>(0, noise.size() - 1)(random);
    const double rise = drift_N_ * (random() % 2 == 0 ? 1.0 : -1.0);
    for (std::size_t i = 0; i < out.fz_N.size(); ++i, at = (at + 1) % noise.size())
      out.fz_N[i] += noise[at] + rise * (double(i) / double(out.fz_N.size()) - 0.5);
    return out;
  }

 private:
  explicit SimulatedTruth(models::ProbingRuntime runtime) : runtime_(std::move(runtime)) {}

  /// What the structure leaves of a trial; where it cannot judge a sample, the one before.
  static std::vector<double> noise_of(const Problem& problem, const Hypothesis& hypothesis,
                                      int trial) {
    const Residuals left = problem.full_rate(hypothesis.structure, hypothesis.values, trial);
    std::vector<double> out;
    double last = 0.0;
    for (std::size_t i = 0; i < left.t_s.size(); ++i) {
      if (left.judgement[i] == Judgement::judged) last = left.channels.front()[i];
      out.push_back(last);
    }
    return out;
  }

  models::ProbingRuntime runtime_;
  std::vector<std::vector<double>> residuals_;
  double drift_N_ = 0.0;
};

/// Root mean square difference of two predictions but for a constant, in standard deviations of the noise.
double difference(const std::vector<double>& a, const std::vector<double>& b, double noise_N) {
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += a[i] - b[i], squares += (a[i] - b[i]) * (a[i] - b[i]);
  const double n = double(a.size());
  return std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n))) / noise_N;
}

/// The whole of it for one diagnosis.
class Preposterior {
 public:
  Preposterior(const Problem& problem, const Diagnosis& diagnosis,
               const models::ProbingModel& given, const trial::ProbingSet& set,
               const PreposteriorOptions& options)
      : problem_(problem), diagnosis_(diagnosis), given_(given), set_(set), options_(options) {}

  Result<std::vector<ProgramValue>> run(const core::Progress& progress) {
    std::vector<ProgramValue> out;
    TRY(prepare());
    if (truths_.size() < 2) return out;
    out = shortlist();
    double done = 0.0;
    const double all = double(out.size() * truths_.size()) * options_.draws;
    for (ProgramValue& value : out) {
      for (std::size_t h = 0; h < truths_.size(); ++h)
        for (int draw = 0; draw < options_.draws; ++draw) {
          if (progress && !progress(done++ / all)) return Error{Errc::cancelled, "stopped"};
          const double after = TRY(probability_after(value.program, h, draw));
          value.expected_gain +=
              weight_[h] / options_.draws * (after - diagnosis_.hypotheses[h].probability);
        }
      value.gain_per_minute = value.expected_gain / (value.seconds / 60.0);
    }
    std::ranges::stable_sort(out, std::greater<>(), &ProgramValue::gain_per_minute);
    return out;
  }

 private:
  Result<void> prepare() {
    double total = 0.0;
    for (const Hypothesis& hypothesis : diagnosis_.hypotheses) {
      truths_.push_back(TRY(SimulatedTruth::make(problem_, hypothesis)));
      weight_.push_back(hypothesis.weight);
      total += hypothesis.weight;
      ids_.insert(hypothesis.structure.effects.begin(), hypothesis.structure.effects.end());
    }
    for (double& weight : weight_) weight /= total;
    std::vector<double> spacings, noises;
    for (const auto& trial : set_.trials) {
      for (std::size_t i = 1; i < trial.t_s.size(); ++i)
        spacings.push_back(trial.t_s[i] - trial.t_s[i - 1]);
      noises.push_back(noise_sd_on_fast_motion(trial.x_m));
    }
    spacing_s_ = middle_of(std::move(spacings));
    x_noise_sd_m_ = middle_of(std::move(noises));
    return {};
  }

  std::vector<ProgramValue> shortlist() const {
    std::vector<ProgramValue> out;
    for (trial::MotionProgram& program : probing_programs(range_of(set_))) {
      const auto motion = played(program.motion(spacing_s_));
      std::vector<std::vector<double>> forces;
      for (const SimulatedTruth& truth : truths_) forces.push_back(truth.force(motion));
      double told = 0.0, pairs = 0.0;
      for (std::size_t a = 0; a < forces.size(); ++a)
        for (std::size_t b = 0; b < a; ++b) {
          told += weight_[a] * weight_[b] *
                  difference(forces[a], forces[b], diagnosis_.final_fit.noise_floor);
          pairs += weight_[a] * weight_[b];
        }
      const double seconds = options_.repetitions * program.seconds();
      out.push_back({std::move(program), seconds, told / pairs, 0.0, 0.0});
    }
    std::ranges::stable_sort(out, std::greater<>(),
                             [](const ProgramValue& v) { return v.difference / v.seconds; });
    if (out.size() > options_.shortlist) out.resize(options_.shortlist);
    return out;
  }

  /// Of the structure that is true, once the recording is there.
  Result<double> probability_after(const trial::MotionProgram& program, std::size_t truth,
                                   int draw) const {
    std::mt19937_64 random(1000 * truth + std::size_t(draw) + 1);  // the same answer each time
    trial::ProbingSet set = set_;
    const auto motion = played(program.motion(spacing_s_));
    for (int k = 0; k < options_.repetitions; ++k) {
      set.trials.push_back(truths_[truth].recorded(motion, x_noise_sd_m_, random));
      set.trials.back().id = set.trials.back().file = program.name + " " + std::to_string(k + 1);
      if (program_turns(set_)) set.trials.back().theta_rad = motion.theta_rad;
    }
    const auto problem =
        TRY(make_probing_problem(given_, std::move(set), {.threads = options_.threads}));
    DiagnoseOptions options;
    options.threads = options_.threads;
    options.only.assign(ids_.begin(), ids_.end());
    options.detection_limits = false;
    const Diagnosis after = TRY(diagnose(*problem, options));
    for (const Hypothesis& h : after.hypotheses)
      if (h.structure == diagnosis_.hypotheses[truth].structure) return h.probability;
    return 0.0;
  }
  static bool program_turns(const trial::ProbingSet& set) {
    return !set.trials.empty() && !set.trials.front().theta_rad.empty();
  }

  const Problem& problem_;
  const Diagnosis& diagnosis_;
  const models::ProbingModel& given_;
  const trial::ProbingSet& set_;
  PreposteriorOptions options_;
  std::vector<SimulatedTruth> truths_;
  std::vector<double> weight_;
  std::set<std::string> ids_;
  double spacing_s_ = 1e-3, x_noise_sd_m_ = 0.0;
};

}  // namespace

Result<std::vector<ProgramValue>> weigh_programs(const Problem& problem, const Diagnosis& diagnosis,
                                                 const models::ProbingModel& given,
                                                 const trial::ProbingSet& set,
                                                 const PreposteriorOptions& options,
                                                 const core::Progress& progress) {
  if (diagnosis.hypotheses.size() < 2 ||
      std::ranges::any_of(set.trials, [](const auto& trial) { return trial.x_m.empty(); }))
    return std::vector<ProgramValue>{};
  return Preposterior(problem, diagnosis, given, set, options).run(progress);
}

}  // namespace lab
}  // namespace tractus
