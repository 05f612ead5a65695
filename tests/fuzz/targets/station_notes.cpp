#include "fuzz/target.hpp"
#include "station/check/findings.hpp"
#include "station/headset/alignment.hpp"

namespace tractus {
namespace fuzz {
namespace {
bool run(core::ByteView bytes) {
  const auto file = placed("notes/alignment.json", bytes);
  const auto alignment = headset::kept_alignment(file.parent_path());
  if (taken(alignment)) {
    const auto& X_SD = (*alignment)->alignment.X_SD;
    core::require(X_SD.p.allFinite(), "a place is finite");
    core::require(std::abs(X_SD.q.norm() - 1.0) < 1e-5, "a turn is of unit length");
    return true;
  }
  const auto calibration = check::Calibration::read(file);
  if (!taken(calibration)) return false;
  core::require(!check::day_of((*calibration)->due_utc_us).empty(), "a due date is a day");
  static_cast<void>(check::due_warning(**calibration, 0));
  return true;
}
}  // namespace

Target station_notes() {
  return {
      "station_notes", "a station's alignment.json or calibration, as somebody left it", {}, run};
}

}  // namespace fuzz
}  // namespace tractus
