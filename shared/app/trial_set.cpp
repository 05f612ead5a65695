#include "app/trial_set.hpp"

#include <fmt/format.h>

#include <set>

#include "core/try.hpp"
#include "trial/measurement_set.hpp"
#include "trial/probing_set.hpp"
#include "trial/trial_file.hpp"

namespace tractus {
namespace commands {
namespace {
using core::Errc;
using core::Error;
using trial::Trial;

constexpr const char* kOfModel =
    "forces are those of the model that ran at the station, not of a sensor";

/// From when on the sensor of a probing trial is tared: the drive is enabled then.
double tared_s(const Trial& trial) {
  for (const auto& sample : trial.probing)
    if (sample.mode != trial::ProbingMode::holding) return sample.t_s;
  return 0.0;
}

trial::ProbingMeasurement probing_of(const Trial& trial) {
  trial::ProbingMeasurement out;
  const double from_s = tared_s(trial);
  for (const auto& s : trial.probing) {
    if (s.flags & trial::kStale || s.t_s < from_s) continue;
    if (!out.t_s.empty() && s.t_s <= out.t_s.back()) continue;
    out.t_s.push_back(s.t_s);
    out.x_m.push_back(s.x_m);
    out.theta_rad.push_back(s.theta_rad);
    out.fz_N.push_back(double(s.fz_N));
    out.tz_Nm.push_back(double(s.tz_Nm));
  }
  return out;
}

trial::PalpationMeasurement palpation_of(const Trial& trial) {
  trial::PalpationMeasurement out;
  out.notes = kOfModel;
  const auto vector_of = [](const std::array<float, 3>& v) {
    return math::Vec3(double(v[0]), double(v[1]), double(v[2]));
  };
  for (const auto& s : trial.samples) {
    if (s.flags & trial::kStale || (!out.t_s.empty() && s.t_s <= out.t_s.back())) continue;
    out.t_s.push_back(s.t_s);
    out.X_VH.push_back(s.pose());
    out.wrench_H.push_back({vector_of(s.force_N), vector_of(s.torque_Nm)});
  }
  return out;
}

core::Json stated_of(const Trial& trial) {
  return {
      {"sampling_rate_Hz", trial.header.rate_Hz},
      {"simulated", trial.header.simulated},
      {"source", fmt::format("recorded by {} on {}", trial.header.station, trial.header.device)}};
}

template <class Set, class Measurement>
core::Result<void> add(Set& set, Measurement measurement, const Trial& trial,
                       const std::string& file, std::size_t& samples) {
  if (measurement.t_s.size() < 2)
    return Error{Errc::bad_input,
                 fmt::format("{}: {} samples with a fresh reading, at least 2 are expected", file,
                             measurement.t_s.size())};
  measurement.id = trial.header.id;
  measurement.file = trial.header.id + ".csv";
  measurement.operator_name = trial.header.operator_name;
  samples += measurement.t_s.size();
  if (set.trials.empty()) set.stated = stated_of(trial);
  if (trial.header.simulated) set.stated["simulated"] = true;
  set.trials.push_back(std::move(measurement));
  return {};
}
}  // namespace

core::Result<std::size_t> write_trial_set(std::span<const std::string> files,
                                          const std::filesystem::path& folder) {
  trial::ProbingSet probing;
  trial::PalpationSet palpation;
  std::set<std::string> ids;
  std::size_t samples = 0;
  for (const std::string& file : files) {
    const auto trial = trial::read_trial(file);
    if (!trial) return trial.error();
    if (!ids.insert(trial->header.id).second)
      return Error{Errc::bad_input, fmt::format("{}: this trial occurs twice", file)};
    const bool probes = trial->header.rig == trial::Rig::probing;
    if (probes ? !palpation.trials.empty() : !probing.trials.empty())
      return Error{Errc::bad_input, fmt::format("{}: this trial is of another rig ({}) than the "
                                                "first trial; a set must contain trials of one rig",
                                                file, trial::name(trial->header.rig))};
    TRY(probes ? add(probing, probing_of(*trial), *trial, file, samples)
               : add(palpation, palpation_of(*trial), *trial, file, samples));
  }
  TRY(probing.trials.empty() ? trial::write_palpation_set(folder, palpation)
                             : trial::write_probing_set(folder, probing));
  return samples;
}

}  // namespace commands
}  // namespace tractus
