/// Checks a planned tract in a volume before a case is made from it.
#pragma once

#include "cases/carving.hpp"
#include "core/json.hpp"
#include "server/api/schema.hpp"

namespace tractus::api {

/// Distance between the depths along the tract at which the walls of the bone are reported.
inline constexpr double kWallStep_m = 0.0005;
/// A request with a plan is no larger.
inline constexpr std::uint64_t kMaxPlan_bytes = 4096 + volume::EnvelopeMark::kMostMarks * 128;

/// The result of cases::place for the plan, in the JSON form of the routes: {"length_m", "side",
/// "tract", "walls", "breach", "problems", "warnings"}. Never fails: errors of the plan are among the problems,
/// and values that could not be found are null.
core::Json tract_json(const volume::Volume& ct, const volume::TransferFunction& transfer,
                      cases::CarvingPlan plan);

/// The same for a plan that does not lie in the volume.
core::Json no_tract_json(const cases::CarvingPlan& plan, const std::string& problem);

/// Fields of a plan in a request; the breach is the schema BreachWish.
std::vector<schema::Field> plan_fields();

}  // namespace tractus::api
