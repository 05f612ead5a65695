#include "trial/measurement_set.hpp"

#include "fuzz/target.hpp"
#include "trial/probing_set.hpp"

namespace tractus {
namespace fuzz {
namespace {
bool run(core::ByteView bytes) {
  static const auto csv = placed("set/a.csv", core::bytes_of("t_s,x_m,fz_N\n0,0,0\n0.1,0,1\n"));
  placed("set/set.json", bytes);
  const auto folder = csv.parent_path();
  taken(trial::rig_of_set(folder));
  const bool palpation = taken(trial::read_palpation_set(folder));
  return taken(trial::read_probing_set(folder)) || palpation;
}
}  // namespace

Target measurement_set() {
  return {"measurement_set",
          "set.json of tractus-measurements/1, from a person",
          {"tests/data/force/cable_tool_odbl/drum/light_slow/set.json"},
          run};
}

}  // namespace fuzz
}  // namespace tractus
