#include "station/sensors/igtl_message.hpp"

#include "fuzz/target.hpp"
#include "station/sensors/motion_rows.hpp"

namespace fuzz {
namespace {
bool run(core::ByteView bytes) {
  const auto header = sensors::parse_igtl_header(bytes);
  if (!header) return false;
  const auto body = bytes.subspan(sensors::kIgtlHeaderBytes);
  static_cast<void>(sensors::parse_igtl_status(*header, body));
  sensors::MotionRows rows({"probe"});
  for (const auto& seen : sensors::parse_igtl_body(*header, body)) {
    core::require(seen.X_CB.p.allFinite(), "a place is finite");
    core::require(std::abs(seen.X_CB.q.norm() - 1.0) < 1e-6, "a turn is of unit length");
    core::require(seen.body.find_first_of(",\n\r") == std::string::npos, "a name keeps its cell");
    static_cast<void>(rows.take(seen, 0.0));
  }
  return true;
}
}  // namespace

Target igtl_message() {
  return {"igtl_message", "an OpenIGTLink message, from a motion capture system", {}, run};
}

}  // namespace fuzz
