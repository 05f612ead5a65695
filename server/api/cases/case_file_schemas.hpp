/// Schemas of the files of cases and of scenarios, member for member as shared/cases/case.cpp and
/// shared/scenarios/scenario_file.cpp read and write them.
#pragma once

#include "server/api/route.hpp"

namespace tractus::api {

/// CaseManifest, CaseTract and CasePart.
std::vector<NamedSchema> case_file_schemas();
/// ScenarioFile as the server writes it, ScenarioDraft as it takes it, and ScenarioOrTuned.
std::vector<NamedSchema> scenario_file_schemas();

}  // namespace tractus::api
