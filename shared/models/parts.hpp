/// What the model files of both rigs have in common: identity, `fixed`, `effects`.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/json.hpp"
#include "effects/effect.hpp"

namespace tractus::models {

inline constexpr std::string_view kModelFormat = "tractus-model/1";

/// The first thing wrong with a part, or nothing.
using OptionalError = std::optional<core::Error>;

/// bad_input "WHERE/KEY: WHY".
core::Error bad(const std::string& where, std::string_view key, const std::string& why);

/// `format`, `rig` (which must be the one asked for) and `name`.
OptionalError read_identity(core::Fields& fields, std::string_view rig, std::string& name);
/// `fixed`: JSON pointers, `*` for every element, each leading to something in the base of
/// `whole`.
OptionalError read_fixed(core::Fields& fields, const core::Json& whole,
                         std::vector<std::string>& fixed);
/// What is known of an effect of one rig, of the catalogue or a user's own; not_found naming the
/// id.
using FactsOf = core::Result<effects::EffectFacts> (*)(const effects::EffectInstance& use);
/// `effects`: a list of {"id", "parameters": {name: number, or an array for a parameter of several
/// components}}, every parameter given (but for those with an `if_missing`) and
/// within its range, no id twice. A user's own effect has
/// its whole file beside them as "expression".
OptionalError read_effects(core::Fields& fields, FactsOf facts_of,
                           std::vector<effects::EffectInstance>& uses);
/// The same list, written. Every effect must be known.
core::Json effects_to_json(const std::vector<effects::EffectInstance>& uses, FactsOf facts_of);

}  // namespace tractus::models
