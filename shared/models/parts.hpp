/// What the model files of both rigs have in common: identity, `fixed`, `effects`.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/json.hpp"

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
/// Refuses every effect by its id: this version knows none.
Fault read_effects(core::Fields& fields);

}  // namespace models
