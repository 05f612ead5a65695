#include "metrics/breach_class.hpp"

#include <fmt/format.h>

#include <cmath>

#include "metrics/drilled_channel.hpp"

namespace tractus {
namespace metrics {
namespace {

std::optional<double> number_member(const core::Json& of, const char* key) {
  const auto at = of.find(key);
  return at != of.end() && at->is_number() ? std::optional(at->get<double>()) : std::nullopt;
}

/// "medial", by the side on which the channel's farthest point lies; empty where the event does not
/// say.
std::string side_of_farthest(const core::Json& worst) {
  const auto at = worst.find("farthest_m");
  const bool known = at != worst.end() && at->is_array() && at->size() == 2 &&
                     (*at)[0].is_number() && (*at)[1].is_number();
  if (!known) return "";
  const math::Vec2 offset((*at)[0].get<double>(), (*at)[1].get<double>());
  return fmt::format(", {}", name(volume::Tract::side_of(offset)));
}

Score beyond_cortex(const Subject& subject) {
  const core::Json* detail = drilled_detail(subject);
  if (!detail) return {{}, kCutShort};
  const auto channel = detail->find("channel");
  const bool measured =
      channel != detail->end() && channel->is_object() && channel->contains("worst");
  if (!measured) return {{}, "the station did not measure the channel across the pedicle"};
  const core::Json& worst = channel->at("worst");
  if (!worst.is_object()) return {{}, "the channel came to no place with a known cortex"};
  const auto beyond_m = number_member(worst, "beyond_m");
  const auto depth_m = number_member(worst, "depth_m");
  if (!beyond_m || !depth_m) return {{}, "the station did not measure the channel"};
  const BreachClass found = breach_class_of(*beyond_m);
  return {*beyond_m, fmt::format("class {}: {:.1f} mm {}, at depth {:.0f} mm{}", name(found),
                                 std::abs(*beyond_m) * 1e3,
                                 found == BreachClass::a ? "of bone remain" : "beyond the cortex",
                                 *depth_m * 1e3, side_of_farthest(worst))};
}

}  // namespace

MetricInfo breach_class() {
  return {"breach_class",
          "Breach of the cortex, Gertzbein-Robbins class",
          "m",
          "Largest distance from the outer face of the cortex about the planned tract to the "
          "channel's surface outside it, across the tract, as the image shows the bone before the "
          "drilling, negative where the channel stays within; class A: no breach, B: below 2 mm, "
          "C: 2 to below 4 mm, D: 4 to below 6 mm, E: 6 mm or more.",
          "Gertzbein1990; the distance: own definition",
          trial::Rig::palpation,
          beyond_cortex,
          drills};
}

}  // namespace metrics
}  // namespace tractus
