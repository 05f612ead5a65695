#include "lab/compare/describe.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/require.hpp"
#include "lab/settings.hpp"
#include "lab/signal/phases.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kDescription = kSettings.description;
/// Units that a state's name may end in, longest first.
constexpr std::array<std::pair<std::string_view, std::string_view>, 9> kUnits{{{"_rad_s", "rad/s"},
                                                                               {"_m_s2", "m/s²"},
                                                                               {"_N_s", "N/s"},
                                                                               {"_m_s", "m/s"},
                                                                               {"_rad", "rad"},
                                                                               {"_Nm", "N·m"},
                                                                               {"_N", "N"},
                                                                               {"_m", "m"},
                                                                               {"_s", "s"}}};

/// "depth_m" → depth, m.
Feature feature_named(const std::string& state) {
  Feature out{state, "", {}};
  for (const auto& [suffix, unit] : kUnits)
    if (state.ends_with(suffix)) {
      out.name = state.substr(0, state.size() - suffix.size());
      out.unit = unit;
      break;
    }
  std::ranges::replace(out.name, '_', ' ');
  return out;
}

using Column = std::vector<double>;

const Column* state(const States& states, std::string_view name) {
  const auto it = std::ranges::find(states.names, name);
  return it == states.names.end() ? nullptr
                                  : &states.values[std::size_t(it - states.names.begin())];
}

std::vector<float> every(std::span<const double> values, std::size_t stride, bool unsigned_) {
  std::vector<float> out;
  for (std::size_t k = 0; k < values.size(); k += stride)
    out.push_back(float(unsigned_ ? std::abs(values[k]) : values[k]));
  return out;
}

std::vector<float> every(const std::vector<float>& values, std::size_t stride) {
  std::vector<float> out;
  for (std::size_t k = 0; k < values.size(); k += stride) out.push_back(values[k]);
  return out;
}

/// The recorded channel at the residual's times. A problem may leave samples out at the ends, and
/// nothing else.
Column at_times(const Recorded::Trial& trial, std::size_t channel, std::span<const double> t_s) {
  Column out(t_s.size());
  std::size_t from = 0;
  for (std::size_t k = 0; k < t_s.size(); ++k) {
    while (from + 1 < trial.t_s.size() && trial.t_s[from + 1] <= t_s[k] + 1e-9) ++from;
    out[k] = trial.values[channel][from];
  }
  return out;
}

/// Direction, phase and time since a reversal of a motion along or about the probe's axis.
template <class Add>
void add_courses(const States& states, const Residuals& residuals, const TrialSamples& trial,
                 const Add& add) {
  const bool slides = state(states, "depth_m") != nullptr;
  const Column* velocity = state(states, slides ? "velocity_m_s" : "omega_rad_s");
  if (!velocity) return;
  Column crossing;
  if (slides)
    for (const Judgement j : residuals.judgement)
      crossing.push_back(j == Judgement::at_border ? 1.0 : 0.0);
  const Courses course = courses(trial.t_s, *velocity, crossing);
  add({"direction", "", slides ? kDirections : kTurningDirections},
      every(course.direction, trial.stride));
  add({"phase", "", slides ? kProbingPhases : kTurningPhases}, every(course.phase, trial.stride));
  add({"time since reversal", "s", {}}, every(course.since_reversal_s, trial.stride));
}

void add_features(const States& states, const Residuals& residuals, bool probing, Samples& samples,
                  TrialSamples& trial) {
  const bool first = samples.features.empty();
  const auto add = [&](Feature feature, std::vector<float> values) {
    if (first) samples.features.push_back(std::move(feature));
    trial.features.push_back(std::move(values));
  };
  if (probing) add_courses(states, residuals, trial, add);
  const Column *force = state(states, "force_N"), *speed = state(states, "velocity_m_s"),
               *along = state(states, "speed_along_force_m_s");
  if (!probing && force && speed && along)
    add({"phase", "", kPalpationPhases},
        every(palpation_phases(*force, *speed, *along, kDescription.sensor_noise_N), trial.stride));
  for (std::size_t s = 0; s < states.names.size(); ++s) {
    Feature feature = feature_named(states.names[s]);
    if (feature.unit == "m/s²" || feature.name == "time" || states.names[s] == "theta_rad")
      continue;
    const bool velocity = feature.unit == "m/s" || feature.unit == "rad/s";
    if (feature.name == "velocity") feature.name = "speed";
    if (feature.name == "omega") feature.name = probing ? "rotation" : "turning of the handle";
    add(std::move(feature), every(states.values[s], trial.stride, velocity));
  }
}

/// Which of the problem's channels were recorded, and which of them are judged.
struct Chosen {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  // of the problem, of the recording
};

Chosen choose(const Problem& problem, const Recorded& recorded, Samples& samples) {
  Chosen out;
  const auto& channels = problem.channels();
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const auto it = std::ranges::find(recorded.channels, channels[c].name);
    if (it == recorded.channels.end()) continue;
    out.pairs.emplace_back(c, std::size_t(it - recorded.channels.begin()));
    samples.channels.push_back(channels[c]);
  }
  samples.judged_name = channels.front().name;
  samples.judged_unit = feature_named(samples.judged_name).unit;
  for (std::size_t c = 0; c < samples.channels.size(); ++c)
    if (samples.channels[c].name == samples.judged_name) samples.judged = {c};
  if (samples.judged.empty())
    for (std::size_t c = 0; c < samples.channels.size(); ++c)
      if (samples.channels[c].name.starts_with("f") && samples.channels[c].name.ends_with("_N"))
        samples.judged.push_back(c);
  core::require(!samples.judged.empty(), "what a problem judges was recorded");
  return out;
}

template <class Set>
Recorded copied(const Set& set, std::vector<std::string> channels) {
  Recorded out{std::move(channels), {}};
  for (const auto& trial : set.trials) out.trials.push_back({trial.id, trial.t_s, {}});
  return out;
}

/// Has the trial a sample that counts?
bool judges(const TrialSamples& trial) {
  for (std::size_t k = 0; k < trial.t_s.size(); ++k)
    if (trial.is_judged(k)) return true;
  return false;
}

}  // namespace

Recorded recorded(const trial::ProbingSet& set) {
  std::vector<std::string> channels;
  const auto all = [&](auto member) {
    return std::ranges::none_of(set.trials, [&](const auto& t) { return (t.*member).empty(); });
  };
  const bool force = all(&trial::ProbingMeasurement::fz_N),
             torque = all(&trial::ProbingMeasurement::tz_Nm);
  if (force) channels.push_back("fz_N");
  if (torque) channels.push_back("tz_Nm");
  Recorded out = copied(set, std::move(channels));
  for (std::size_t t = 0; t < set.trials.size(); ++t) {
    if (force) out.trials[t].values.push_back(set.trials[t].fz_N);
    if (torque) out.trials[t].values.push_back(set.trials[t].tz_Nm);
  }
  return out;
}

Recorded recorded(const trial::PalpationSet& set) {
  Recorded out = copied(set, {"fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm"});
  for (std::size_t t = 0; t < set.trials.size(); ++t)
    for (int c = 0; c < 6; ++c) {
      auto& values = out.trials[t].values.emplace_back();
      for (const math::Wrench& w : set.trials[t].wrench_H)
        values.push_back(c < 3 ? w.force_N[c] : w.torque_Nm[c - 3]);
    }
  return out;
}

Samples samples_of(const Problem& problem, const Structure& structure,
                   std::span<const double> values, const Recorded& recorded) {
  core::require(std::size_t(problem.trials()) == recorded.trials.size(),
                "a problem's recording has its trials");
  Samples out;
  const Chosen chosen = choose(problem, recorded, out);
  std::size_t total = 0;
  for (const auto& trial : recorded.trials) total += trial.t_s.size();
  for (int t = 0; t < problem.trials(); ++t) {
    const Recorded::Trial& source = recorded.trials[std::size_t(t)];
    Residuals residuals = problem.full_rate(structure, values, t);
    TrialSamples trial;
    trial.id = problem.trial_id(t);
    trial.t_s = std::move(residuals.t_s);
    trial.stride = 1 + total / kDescription.most_rows;
    for (const auto& [from, to] : chosen.pairs) {
      trial.measured.push_back(at_times(source, to, trial.t_s));
      Column simulated = trial.measured.back();
      for (std::size_t k = 0; k < simulated.size(); ++k)
        simulated[k] -= residuals.channels[from][k];
      trial.simulated.push_back(std::move(simulated));
    }
    trial.judgement = residuals.judgement;
    add_features(problem.states(t), residuals, problem.rig() == "probing", out, trial);
    out.trials.push_back(std::move(trial));
  }
  if (std::ranges::none_of(out.trials, judges))
    for (TrialSamples& trial : out.trials) trial.judgement.clear();
  return out;
}

Samples samples_as_given(const Problem& problem, const Recorded& recorded) {
  std::vector<double> values;
  for (const Parameter& parameter : problem.parameters({})) values.push_back(parameter.start);
  return samples_of(problem, {}, values, recorded);
}

}  // namespace lab
}  // namespace tractus
