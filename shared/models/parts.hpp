/// What the model files of both rigs have in common: identity, `fixed`, `effects`.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/json.hpp"
#include "effects/effect.hpp"

namespace models {

inline constexpr std::string_view kModelFormat = "tractus-model/1";

/// The first thing wrong with a part, or nothing.
using Fault = std::optional<core::Error>;

/// bad_input "WHERE/KEY: WHY".
core::Error bad(const std::string& where, std::string_view key, const std::string& why);

/// `format`, `rig` (which must be the one asked for) and `name`.
Fault read_identity(core::Fields& fields, std::string_view rig, std::string& name);
/// `fixed`: JSON pointers, `*` for every element, each leading to something in the base of
/// `whole`.
Fault read_fixed(core::Fields& fields, const core::Json& whole, std::vector<std::string>& fixed);
/// What a catalogue says of an effect, or null where it does not know the id.
using FactsOf = const effects::EffectFacts* (*)(std::string_view id);
/// `effects`: a list of {"id", "parameters": {name: number, or an array for a parameter of several
/// components}}, every parameter given and within its range, no id twice.
Fault read_effects(core::Fields& fields, FactsOf facts_of, std::vector<effects::Use>& uses);
/// The same list, written. Every id must be known to the catalogue.
core::Json effects_to_json(const std::vector<effects::Use>& uses, FactsOf facts_of);

}  // namespace models
