#include "lab/rigs/palpation/experiments.hpp"

#include <array>

namespace tractus {
namespace lab {
namespace {

struct Advice {
  std::string_view effect, recording;
};
constexpr std::array kAdvice{
    Advice{"contact_friction", "slides along one wall to and fro at 5, 20 and 60 mm/s"},
    Advice{"contact_damping", "presses into one wall at 2, 10 and 40 mm/s, each held for 2 s"},
    Advice{"contact_nonlinearity", "slow presses into one wall, from light to as hard as is safe"},
    Advice{"contact_hysteresis", "slow presses into one wall and out again, ten times"},
    Advice{"shank_taper",
           "sideways presses with the tip alone, and with the shank a few centimetres behind it"},
    Advice{"shank_curvature", "the same sideways press at four rolls of the handle, 90° apart"},
    Advice{"pose_offset", "presses into opposite walls in three directions, with two rolls"},
    Advice{"tip_ball", "light touches of the end and of all walls, from free to just touching"},
    Advice{"probe_weight", "slow turns in free air about all three axes"},
    Advice{"probe_inertia", "quick shakes in free air along and across the probe"},
    Advice{"sensor_bias", "five seconds in free air before and after, at several tilts"},
    Advice{"sensor_drift", "two trials of 60 s with free air at their ends"},
    Advice{"time_delay", "quick taps on something hard, three a second"},
};

std::string_view of(std::string_view effect) {
  for (const Advice& advice : kAdvice)
    if (advice.effect == effect) return advice.recording;
  return {};
}

}  // namespace

std::string palpation_recording(std::string_view a, std::string_view b) {
  std::string out(of(a));
  const std::string_view other = of(b);
  if (out.empty()) return std::string(other);
  if (!other.empty() && other != out) out += "; and " + std::string(other);
  return out;
}

}  // namespace lab
}  // namespace tractus
