#include "station/sensors/igtl_message.hpp"

#include "fuzz/target.hpp"
#include "station/sensors/igtl_reader.hpp"
#include "station/sensors/motion_rows.hpp"

namespace tractus {
namespace fuzz {
namespace {
/// How many poses a connection gives that sends these bytes twice, in pieces of this size.
std::size_t poses_of(core::ByteView bytes, std::size_t piece) {
  sensors::IgtlReader reader;
  std::size_t poses = 0;
  for (int again = 0; again < 2; ++again)
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
      reader.add(bytes.subspan(at, std::min(piece, bytes.size() - at)));
      for (;;) {
        const auto next = reader.next();
        if (!taken(next)) return poses;
        if (!*next) break;
        poses += (*next)->size();
      }
      core::require(reader.held() <= sensors::kIgtlHeaderBytes + sensors::kIgtlMostBytes + piece,
                    "no more than a message is held");
    }
  return poses;
}

bool run(core::ByteView bytes) {
  core::require(poses_of(bytes, 7) == poses_of(bytes, 4096), "pieces of any size read the same");
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
}  // namespace tractus
