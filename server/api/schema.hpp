/// JSON Schema in few words: what the routes say of their fields, and from which the web's types
/// are made.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/json.hpp"

namespace tractus::api::schema {

using Field = std::pair<std::string, core::Json>;

/// All fields are required unless `optional` wraps them; none other may be there.
core::Json object(const std::vector<Field>& fields);
core::Json text(std::string_view meaning);
core::Json one_of(const std::vector<std::string>& values, std::string_view meaning);
/// `unit` as printed: "N", "s", "1".
core::Json number(std::string_view unit, std::string_view meaning);
core::Json integer(std::string_view unit, std::string_view meaning);
core::Json truth(std::string_view meaning);
core::Json array(core::Json items, std::string_view meaning);
/// Exactly so many items.
core::Json tuple(core::Json items, std::size_t size, std::string_view meaning);
core::Json map(core::Json values, std::string_view meaning);
core::Json nullable(core::Json inner);
core::Json optional(core::Json inner);
/// Any object: what it holds is another's matter.
core::Json anything(std::string_view meaning);
/// A schema named by some route's `schemas`.
core::Json ref(std::string_view name);

}  // namespace tractus::api::schema
