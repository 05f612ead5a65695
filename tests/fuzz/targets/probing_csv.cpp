#include "fuzz/target.hpp"
#include "trial/probing_set.hpp"

namespace tractus {
namespace fuzz {
namespace {
bool run(core::ByteView bytes) {
  static const auto set = placed("probing/set.json", core::bytes_of(R"({
    "format":"tractus-measurements/1","rig":"probing","trials":[{"id":"a","file":"a.csv"}]})"));
  placed("probing/a.csv", bytes);
  return taken(trial::read_probing_set(set.parent_path()));
}
}  // namespace

Target probing_csv() {
  return {"probing_csv", "a recording of the probing rig as CSV, from a person", {}, run};
}

}  // namespace fuzz
}  // namespace tractus
