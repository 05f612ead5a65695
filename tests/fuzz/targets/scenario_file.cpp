#include "fuzz/target.hpp"
#include "scenarios/scenario.hpp"
#include "scenarios/version.hpp"

namespace tractus {
namespace fuzz {
namespace {
bool run(core::ByteView bytes) {
  taken(scenarios::parse_change(std::string(core::text_of(bytes))));
  return taken_json(
      bytes, [](const core::Json& json) { return scenarios::Scenario::from_json(json, "it"); });
}
}  // namespace

Target scenario_file() {
  return {"scenario_file",
          "tractus-scenario/1, and a change to one, from a person",
          {"shared/scenarios/tuned/hard.json", "shared/scenarios/tuned/in_out_in.json"},
          run};
}

}  // namespace fuzz
}  // namespace tractus
