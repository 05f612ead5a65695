#include "bench/hand_recognition/foretelling.hpp"

#include "core/require.hpp"

namespace tractus {
namespace bench {
namespace {

cases::Perception perception_of(const devices::HandSense& sense) {
  return {.force_weber = sense.force_weber,
          .force_threshold_N = sense.force_threshold_N,
          .wander_m = sense.wander_m};
}

}  // namespace

Foretelling::Foretelling(const Form& whole)
    : observer_(published_model(), whole.carved.tract, whole.from_m), palpated_(palpated(whole)) {}

cases::Palpated Foretelling::palpated(const Form& form) const {
  const auto model = published_model();
  const auto field = volume::ForceField::make(form.carved.volume, model.transfer, model.field);
  core::require(bool(field), "a field can be made of a volume that was drilled");
  auto out = observer_.palpate(*field);
  core::require(bool(out), "and be palpated");
  return std::move(*out);
}

double Foretelling::share_right(const Form& form, const cases::Palpated& palpated,
                                const devices::HandSense& sense) const {
  const auto perception = perception_of(sense);
  const auto whole = observer_.felt(palpated_, perception),
             breached = observer_.felt(palpated, perception);
  return observer_.foretold(whole, breached, *form.breach, form.at_m, perception);
}

}  // namespace bench
}  // namespace tractus
