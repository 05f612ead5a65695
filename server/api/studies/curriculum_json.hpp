/// Where people stand in curricula, in the JSON form of the routes.
#pragma once

#include "server/api/studies/passing.hpp"

namespace tractus::api {

/// {"people": […]}: the people in curricula whom the caller may see. Of a trainee's own, without
/// what is not released and without the name of the next case, which is blinded.
/// @param account_id, curriculum_id  only these; empty: all.
core::Result<core::Json> curriculum_people_json(store::Reading& tx, const Call& call,
                                                const std::string& account_id,
                                                const std::string& curriculum_id);
std::vector<NamedSchema> curriculum_people_schemas();

}  // namespace tractus::api
