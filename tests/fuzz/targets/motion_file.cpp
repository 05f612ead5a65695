#include "capture/motion.hpp"
#include "fuzz/target.hpp"

namespace tractus {
namespace fuzz {
namespace {
bool run(core::ByteView bytes) {
  // What it is, the bytes themselves say.
  const auto motion = capture::read_motion(placed("motion/m", bytes));
  if (!taken(motion)) return false;
  for (const auto& [name, body] : motion->bodies)
    for (std::size_t k = 0; k < body.t_s.size(); ++k) {
      core::require(k == 0 || body.t_s[k] > body.t_s[k - 1], "a body's time runs forward");
      core::require(body.X_CB[k].p.allFinite(), "a body's place is finite");
      core::require(std::abs(body.X_CB[k].q.norm() - 1.0) < 1e-6, "a turn is of unit length");
    }
  for (const auto& [name, marker] : motion->markers)
    for (std::size_t k = 1; k < marker.t_s.size(); ++k)
      core::require(marker.t_s[k] > marker.t_s[k - 1], "a marker's time runs forward");
  return true;
}
}  // namespace

Target motion_file() {
  return {"motion_file",
          "motion capture as QTM's TSV, Motive's CSV, C3D or our CSV, from a person",
          {"tests/golden/c3d/intel_real.c3d", "tests/golden/c3d/mips_integer.c3d",
           "tests/golden/c3d/dec_real.c3d"},
          run};
}

}  // namespace fuzz
}  // namespace tractus
