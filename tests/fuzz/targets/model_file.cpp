#include "fuzz/target.hpp"
#include "models/probing_model.hpp"

namespace tractus::fuzz {

Target model_file() {
  return {"model_file",
          "tractus-model/1, from a person or a server",
          {"tests/data/force/cable_tool_odbl/model.json"},
          [](core::ByteView bytes) {
            return taken_json(
                bytes, [](const core::Json& json) { return models::model_from_json(json, "it"); });
          }};
}

}  // namespace tractus::fuzz
