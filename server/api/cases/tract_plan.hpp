/// A tract that somebody plans in a volume, looked at before anything is made of it.
#pragma once

#include "cases/carving.hpp"
#include "core/json.hpp"

namespace tractus::api {

/// Walls of the bone are told every so far along the tract.
inline constexpr double kWallStep_m = 0.0005;

/// What cases::place says of the plan, as the pages show it: {"length_m", "side", "tract", "walls",
/// "breach", "problems"}. Never fails: what is wrong with the plan is among the problems, and what
/// could not be found is null.
core::Json tract_json(const volume::Volume& ct, const volume::TransferFunction& transfer,
                      cases::CarvingPlan plan);

/// The same for a plan that is not of this volume at all.
core::Json no_tract_json(const cases::CarvingPlan& plan, const std::string& problem);

}  // namespace tractus::api
