#include "capture/force.hpp"
#include "fuzz/target.hpp"

namespace tractus {
namespace fuzz {
namespace {
bool run(core::ByteView bytes) {
  const auto force = capture::read_force(placed("force/f", bytes));
  if (!taken(force)) return false;
  for (std::size_t k = 0; k < force->t_s.size(); ++k) {
    core::require(k == 0 || force->t_s[k] > force->t_s[k - 1], "time runs forward");
    core::require(force->wrench_S[k].force_N.allFinite(), "a force is finite");
  }
  return true;
}
}  // namespace

Target force_file() {
  return {"force_file",
          "a force/torque recording as CSV or in a C3D file, from a person",
          {"tests/golden/c3d/intel_real.c3d", "tests/golden/c3d/mips_integer.c3d"},
          run};
}

}  // namespace fuzz
}  // namespace tractus
