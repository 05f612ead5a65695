#include "cases/case.hpp"
#include "fuzz/target.hpp"

namespace tractus {
namespace fuzz {
namespace {
bool run(core::ByteView bytes) {
  const bool truth =
      taken_json(bytes, [](const core::Json& json) { return cases::Truth::from_json(json, "it"); });
  const bool manifest =
      taken_json(bytes, [](const core::Json& json) { return cases::Case::from_json(json, "it"); });
  return truth || manifest;
}
}  // namespace

Target case_manifest() {
  return {"case_manifest", "case.json and truth.json of a case that is fetched", {}, run};
}

}  // namespace fuzz
}  // namespace tractus
