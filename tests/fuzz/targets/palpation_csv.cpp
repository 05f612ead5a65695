#include "fuzz/target.hpp"
#include "trial/measurement_set.hpp"

namespace tractus {
namespace fuzz {
namespace {
bool run(core::ByteView bytes) {
  static const auto set = placed("palpation/set.json", core::bytes_of(R"({
    "format":"tractus-measurements/1","rig":"palpation","trials":[{"id":"a","file":"a.csv"}]})"));
  placed("palpation/a.csv", bytes);
  return taken(trial::read_palpation_set(set.parent_path()));
}
}  // namespace

Target palpation_csv() { return {"palpation_csv", "a palpation as CSV, from a person", {}, run}; }

}  // namespace fuzz
}  // namespace tractus
