#include "server/jobs/scenario_facts.hpp"

#include "core/try.hpp"
#include "server/jobs/case_facts.hpp"

namespace tractus::jobs {

core::Result<scenarios::Scenario> scenario_of(store::Store& store, const store::Objects& objects,
                                              const std::string& case_id) {
  auto json = TRY(case_json_part(store, objects, case_id, "scenario.json"));
  if (!json) return core::Error{core::Errc::not_found, "no scenario " + case_id.substr(0, 64)};
  return scenarios::Scenario::from_json(*json, "scenario " + case_id.substr(0, 12) + ": ");
}

}  // namespace tractus::jobs
