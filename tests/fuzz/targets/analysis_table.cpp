#include "assessment/snapshot.hpp"
#include "fuzz/target.hpp"

namespace tractus::fuzz {

Target analysis_table() {
  return {"analysis_table",
          "a CSV to analyse, from a person",
          {"shared/assessment/examples/probing-study/surgeons.csv"},
          [](core::ByteView bytes) {
            return taken(assessment::frozen({bytes.begin(), bytes.end()},
                                            {"fuzz", "2026-01-01T00:00:00Z", "nobody", true, {}}));
          }};
}

}  // namespace tractus::fuzz
