#include <fmt/format.h>

#include <cmath>

#include "core/try.hpp"
#include "effects/probing_effect.hpp"
#include "fmu/module/simulation.hpp"
#include "models/probing_stream.hpp"

namespace tractus {
namespace fmu {
namespace {

using core::Errc;
using core::Error;
using core::Result;

constexpr double kTravel_m = 1.0;  // the motion says how far it goes, as in a replay

effects::ProbingTick tick_of(double t_s, std::span<const double> values) {
  const auto at = [&](ProbingPlace place) { return values[std::size_t(place)]; };
  return {.t_s = t_s,
          .x_m = at(ProbingPlace::x_m),
          .v_m_s = at(ProbingPlace::v_m_s),
          .a_m_s2 = at(ProbingPlace::a_m_s2),
          .theta_rad = at(ProbingPlace::theta_rad),
          .omega_rad_s = at(ProbingPlace::omega_rad_s),
          .tz_Nm = at(ProbingPlace::recorded_tz_Nm),
          .rest_m_s = at(ProbingPlace::rest_m_s),
          .rest_rad_s = at(ProbingPlace::rest_rad_s)};
}

class ProbingSimulation final : public Simulation {
 public:
  ProbingSimulation(models::ProbingRuntime runtime, double start_s, double stop_s)
      : runtime_(std::make_shared<const models::ProbingRuntime>(std::move(runtime))),
        stream_(*runtime_, start_s, stop_s) {}

  std::unique_ptr<Simulation> copy() const override {
    return std::make_unique<ProbingSimulation>(*this);
  }
  Result<std::vector<double>> outputs(double t_s, std::span<const double> values) override {
    const auto out = stream_.at(tick_of(t_s, values));
    if (!std::isfinite(out.fz_N) || !std::isfinite(out.tz_Nm))
      return Error{Errc::out_of_range,
                   fmt::format("fz_N = {}, tz_Nm = {} at {} s: the motion is beyond all measure",
                               out.fz_N, out.tz_Nm, t_s)};
    return std::vector{out.fz_N, out.tz_Nm};
  }
  Result<void> keep(double t_s, std::span<const double> values) override {
    stream_.keep(tick_of(t_s, values));
    return {};
  }

 private:
  std::shared_ptr<const models::ProbingRuntime> runtime_;
  models::ProbingStream stream_;
};

class CarriedProbing final : public Carried {
 public:
  explicit CarriedProbing(models::ProbingModel model)
      : Carried(fmu::variables(model)), model_(std::move(model)) {}

  Result<std::unique_ptr<Simulation>> simulation(std::span<const double> values, double start_s,
                                                 std::optional<double> stop_s) const override {
    const auto model = TRY(with_parameters(model_, variables(), values));
    for (const effects::EffectInstance& use : model.effects) {
      const auto facts = TRY(effects::probing_facts(use));
      if (facts.free_per_trial && !stop_s)
        return Error{Errc::bad_input, fmt::format("{} runs over the whole trial: "
                                                  "fmi2SetupExperiment must give the stop time",
                                                  use.id)};
    }
    auto runtime = TRY(models::ProbingRuntime::make(model, kTravel_m));
    return std::unique_ptr<Simulation>(
        new ProbingSimulation(std::move(runtime), start_s, stop_s.value_or(start_s)));
  }

 private:
  models::ProbingModel model_;
};

}  // namespace

std::unique_ptr<Carried> carried(models::ProbingModel model) {
  return std::make_unique<CarriedProbing>(std::move(model));
}

}  // namespace fmu
}  // namespace tractus
