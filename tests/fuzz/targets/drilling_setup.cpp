#include "drilling/redrill.hpp"
#include "fuzz/target.hpp"

namespace tractus::fuzz {

Target drilling_setup() {
  return {"drilling_setup", "a trial's burr, from its header", {}, [](core::ByteView bytes) {
            return taken_json(bytes, [](const core::Json& json) {
              trial::Header header;
              header.extra["drilling"] = json;
              return drilling::Setup::of(header);
            });
          }};
}

}  // namespace tractus::fuzz
