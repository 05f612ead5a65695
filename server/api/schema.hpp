/// Short functions for JSON Schema: the routes describe their fields with them, and the types of
/// the web pages are generated from the result. `meaning` is the description that readers of the
/// API see.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/json.hpp"

namespace tractus::api::schema {

using Field = std::pair<std::string, core::Json>;

/// All fields are required unless `optional` wraps them; other fields are not allowed.
core::Json object(const std::vector<Field>& fields);
core::Json text(std::string_view meaning);
core::Json one_of(const std::vector<std::string>& values, std::string_view meaning);
/// A word of an enum.
template <core::Named E>
core::Json one_of(std::string_view meaning) {
  return one_of(core::names<E>(), meaning);
}
/// `unit`: for example "N", "s" or "1".
core::Json number(std::string_view unit, std::string_view meaning);
core::Json integer(std::string_view unit, std::string_view meaning);
core::Json truth(std::string_view meaning);
core::Json array(core::Json items, std::string_view meaning);
/// An array of exactly `size` items.
core::Json tuple(core::Json items, std::size_t size, std::string_view meaning);
core::Json map(core::Json values, std::string_view meaning);
core::Json nullable(core::Json inner);
core::Json any_of(const std::vector<core::Json>& alternatives, std::string_view meaning);
/// Name and version of a file format, "tractus-case/1".
core::Json file_format(std::string_view name);
core::Json optional(core::Json inner);
/// Any JSON object. Only where nobody can say which fields it has: routes_test.cpp lists every use with its reason.
core::Json anything(std::string_view meaning);
/// A reference to a schema that a route defines in `schemas`.
core::Json ref(std::string_view name);

}  // namespace tractus::api::schema
