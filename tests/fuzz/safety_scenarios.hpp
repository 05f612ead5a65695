/// Scenarios, models and hands out of a seed, run through the station's own guards.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace tractus::fuzz {

/// What one run came to; `broken` is empty when every promise was kept.
struct Outcome {
  std::string broken;
  bool made = false;     ///< the numbers were a valid scenario or model (else another was drawn)
  bool moved = false;    ///< the hand was given something
  double highest = 0.0;  ///< share of the limit that was reached, <= 1
};

/// A probing scenario with effects of the catalogue, any numbers that the readers allow, walls
/// anywhere; a stage with lag under a hand that pushes, lets go, jumps; answers that are lost, late
/// or wrong. Held: |speed| and |torque| of the command never above the clamp, nothing after a
/// fault.
Outcome run_probing(std::uint64_t seed);

/// A palpation model with effects, any numbers allowed, on a small simulated block of bone; poses
/// of a hand, wild now and then. Held: |force| and |torque| never above the clamp, their change
/// never above the slew, zero from the tick of a fault.
class Palpation {
 public:
  Palpation();
  ~Palpation();
  Outcome run(std::uint64_t seed) const;

 private:
  struct Fields;
  std::unique_ptr<Fields> fields_;
};

}  // namespace tractus::fuzz
