/// The catalogue of effects as JSON: what `tractus effects --json` prints and the server hands out.
#pragma once

#include <string>
#include <string_view>

#include "core/json.hpp"
#include "core/result.hpp"
#include "effects/effect.hpp"
#include "lab/io/own_effect.hpp"

namespace tractus::lab_io {

/// {"id", "rig", "kind", "summary", "equation", "source", "needs", "contains", "free_per_trial",
/// "passive", "parameters":[{name, unit, meaning, components, initial, low, high, off, if_missing,
/// logarithmic}]}; off and if_missing are null where there is none.
core::Json effect_json(std::string_view rig, const effects::EffectFacts& facts);

/// {"effects":[…], "adds_to", "adds_unit", "states":[{name, unit, meaning}]}: the rig's catalogue,
/// and what a formula of one's own adds to and may name. @pre rig is probing or palpation
core::Json catalogue_json(std::string_view rig);

/// A user's own effect as an entry of the catalogue; its rig is the one it says. Errors: bad_input
/// naming what is wrong, in the formula the part whose units do not fit.
core::Result<core::Json> own_effect_json(const OwnEffect& own);

}  // namespace tractus::lab_io
