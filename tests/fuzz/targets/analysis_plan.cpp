#include "assessment/formula.hpp"
#include "assessment/plan.hpp"
#include "fuzz/target.hpp"

namespace tractus {
namespace fuzz {
namespace {
bool run(core::ByteView bytes) {
  const bool formula = taken(assessment::parse_formula(std::string(core::text_of(bytes))));
  const bool plan = taken_json(
      bytes, [](const core::Json& json) { return assessment::Plan::from_json(json, "it"); });
  return formula || plan;
}
}  // namespace

Target analysis_plan() {
  return {"analysis_plan",
          "tractus-plan/1, and a formula alone, from a person",
          {"shared/assessment/examples/probing-study/plan.json"},
          run};
}

}  // namespace fuzz
}  // namespace tractus
