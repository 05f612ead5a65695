/// Schemas of the files of an analysis, member for member as shared/assessment/{plan,snapshot,
/// analyse}.cpp read and write them.
#pragma once

#include "server/api/route.hpp"

namespace tractus::api {

/// Options of a statistical method: texts or numbers, by name.
core::Json method_options_schema();
/// PlanFile with its parts.
std::vector<NamedSchema> plan_file_schemas();
/// Snapshot, AnalysisResult and their parts.
std::vector<NamedSchema> analysis_file_schemas();

}  // namespace tractus::api
