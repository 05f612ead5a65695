/// What the routes of lists have in common: their parameters, the request made of them, and the
/// page in the answer.
#pragma once

#include "db/store/finding/list.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"

namespace tractus::api {

/// search, sort, order, cursor, limit, and a parameter for each filter.
/// @param searched  where a search looks: "person, operator, case or station"
std::vector<Parameter> list_parameters(const store::ListShape& shape, const std::string& searched);
/// The arguments of a route with those parameters. Errors: bad_input for a search that is too long
/// or not text.
core::Result<store::ListRequest> list_request(const Call& call, const store::ListShape& shape);

/// The fields of an answer that say where its rows are in the list; and the answer with them.
std::vector<schema::Field> page_fields();
core::Json with_page(core::Json answer, const store::ListPage& page);

}  // namespace tractus::api
