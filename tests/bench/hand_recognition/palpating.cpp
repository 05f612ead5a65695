#include "bench/hand_recognition/palpating.hpp"

#include "core/require.hpp"
#include "station/loop/placement.hpp"

namespace tractus {
namespace bench {
namespace {
constexpr core::Instant_ns kTick_ns = 250'000;
}  // namespace

devices::SimulatedAnswer palpated(const Form& form, const models::PalpationRuntime& runtime,
                                  std::uint64_t seed, double duration_s,
                                  const devices::HandSense& sense) {
  const auto model = published_model();
  const volume::Tract& tract = form.carved.tract;
  auto made = devices::find("sim-lambda6")
                  ->make({.seed = seed,
                          .duration_s = duration_s,
                          .probe_length_m = model.base.length_m,
                          .channel = {.entry_m = tract.entry_m,
                                      .axis = tract.axis,
                                      .medial = tract.medial,
                                      .superior = tract.superior,
                                      .length_m = tract.length_m,
                                      .radius_m = tract.radius_m,
                                      .enclosed_from_m = loop::enclosed_from_m(
                                          form.carved.volume, model.transfer, tract)},
                          .sense = sense});
  core::require(made && made->device->open(), "the simulated device opens");
  laws::PalpationState state;
  for (core::Instant_ns now = 0; !made->trainee->done(); now += kTick_ns) {
    devices::Sample sample;
    core::require(made->device->read(now, sample) == devices::Status::ok, "it can be read");
    auto wrench = runtime.step(sample.X_DH, state).wrench_H;
    wrench.force_N = sample.X_DH.q * wrench.force_N;
    wrench.torque_Nm = sample.X_DH.q * wrench.torque_Nm;
    core::require(made->device->write(wrench) == devices::Status::ok, "it can be written");
  }
  made->device->close();
  return made->trainee->answer();
}

}  // namespace bench
}  // namespace tractus
