#include "fuzz/target.hpp"
#include "station/rig/request.hpp"

namespace tractus {
namespace fuzz {
namespace {
bool run(core::ByteView bytes) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  const auto request = rig::parse_request({data, bytes.size()});
  if (!request) return false;
  core::require(request->read_count <= 125 && request->values.size() <= 123,
                "a request keeps the standard's limits");
  core::require(request->read_count > 0 || !request->values.empty(), "a request asks something");
  return true;
}
}  // namespace

Target modbus_request() {
  return {"modbus_request", "a Modbus request to the rig, from its bus", {}, run};
}

}  // namespace fuzz
}  // namespace tractus
