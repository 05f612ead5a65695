/// Criteria and verdicts in the JSON form of the routes.
#pragma once

#include "assessment/criteria.hpp"
#include "server/api/schema.hpp"

namespace tractus::api {

/// Each requirement with its sentence.
core::Json requirements_json(const assessment::Criteria& of);

core::Json requirement_schema();
/// Of a file in the format tractus-criteria/1.
core::Json criteria_file_schema();
core::Json judged_requirement_schema();
/// Of assessment::verdict_json.
std::vector<schema::Field> verdict_fields();

}  // namespace tractus::api
