#include "fuzz/target.hpp"
#include "station/headset/alignment.hpp"

namespace tractus {
namespace fuzz {
namespace {
bool run(core::ByteView bytes) {
  const auto points = headset::read_fixture(placed("fixture/f.json", bytes));
  if (!taken(points)) return false;
  core::require(points->size() >= 3 && points->size() <= 8, "a fixture has three to eight points");
  std::vector<headset::Touched> touched;
  for (const auto& point : *points) touched.push_back({point, point.p_S_m});
  const auto found = headset::align(touched, 1e-3);
  core::require(bool(found), "points that were taken tell a place");
  core::require(found->X_SD.p.norm() < 1e-3, "touched where they are, nothing has moved");
  return true;
}
}  // namespace

Target fixture() {
  return {"fixture", "tractus-fixture/1, the points to touch, from a person", {}, run};
}

}  // namespace fuzz
}  // namespace tractus
