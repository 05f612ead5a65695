/// An unknown function of one signal as a user effect: a table, and it says so.
#pragma once

#include <optional>
#include <string>

#include "core/json.hpp"
#include "lab/discover/unknown_function.hpp"

namespace tractus::lab {

/// `tractus-effect/1` whose formula is straight between the function's knots and constant beyond them,
///
///     F(u) = scale · (c + Σ_k s_k |u − u_k|),
///
/// u the signal in its SI unit, s_k half the change of slope at knot k; fitted again, it moves as a whole by `scale`.
/// Nothing of a function of two signals, or of more knots or memory than a formula has room for.
std::optional<core::Json> table_effect(const UnknownFunction& function, const std::string& id);

}  // namespace tractus::lab
