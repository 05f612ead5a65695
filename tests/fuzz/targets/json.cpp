#include "fuzz/target.hpp"

namespace tractus {
namespace fuzz {
namespace {

std::size_t depth_of(const core::Json& json) {
  std::size_t deepest = 0;
  if (json.is_structured())
    for (const auto& inner : json) deepest = std::max(deepest, depth_of(inner));
  return deepest + json.is_structured();
}

/// What is taken is within the limits, and its own text is taken again as the same document.
bool run(core::ByteView bytes) {
  const auto json = core::parse_json(core::text_of(bytes), "it");
  if (!taken(json)) return false;
  core::require(depth_of(*json) <= core::kForeignJson.depth, "its depth is limited");
  const auto again = core::parse_json(json->dump(), "it");
  core::require(again && *again == *json, "what was written is read again");
  return true;
}
}  // namespace

Target json() { return {"json", "JSON from anybody", {}, run}; }

}  // namespace fuzz
}  // namespace tractus
