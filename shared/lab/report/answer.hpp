/// The lab's answers as JSON: what `tractus compare`, `diagnose` and `fit` print with --json and
/// what the server hands out. A number that does not exist is null.
#pragma once

#include "core/json.hpp"
#include "lab/compare/comparison.hpp"
#include "lab/discover/discovery.hpp"
#include "lab/identify/diagnosis.hpp"
#include "lab/identify/fit.hpp"
#include "lab/rigs/palpation/tract_map.hpp"

namespace tractus::lab {

/// {"channels":[{name, rmse, r2, noise_floor, explained, …}], "trials":[{id, rmse, …}],
///  "where":[{region, share_of_error, share_of_time, rmse, mean}], "phases":[…], …}. Where several
/// channels are judged together, they stand first in "channels" under their common name.
core::Json to_json(const Comparison& comparison);

/// {"verdict", "base":{rmse, held_out_rmse, noise_floor}, "effects":[{id, probability,
/// parameters:{name:{value, sd}}}], "ranking":[{id, probability, held_out_rmse}],
/// "steps":[{model, rmse, held_out_rmse}], "confounded":[[id, id]],
/// "settle":{between, recording, expected_gain} or null, …}. A parameter of several components has
/// arrays as value and sd.
core::Json to_json(const Discovery& discovery);
core::Json to_json(const Diagnosis& diagnosis);

/// The "ranking" of a diagnosis by itself.
core::Json to_json(const std::vector<Ranked>& ranking);

/// {"depth_m", "angle_rad": edges, "rmse", "share": [depth][angle], null where nothing touched}.
core::Json to_json(const TractMap& map);

/// {"base":{rmse, noise_floor}, "rmse", "held_out_rmse", "effects":[…], "parameters":[{name, value,
/// sd, …}], "trials":[…], "channels":[…], "remarks":[…]}; `given` is the error of the model before.
core::Json to_json(const Fit& fit, const Comparison& given);

/// A number, or null if it is not finite.
core::Json number(double value);

}  // namespace tractus::lab
