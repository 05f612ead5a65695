/// modelDescription.xml of FMI 2.0: what an importer reads of a model before it runs it.
#pragma once

#include <span>
#include <string>

#include "fmu/variables.hpp"

namespace tractus::fmu {

/// The name of the shared object in an FMU, and the `modelIdentifier`.
inline constexpr const char* kModelIdentifier = "tractus_model";

/// @param version  of this program. The same model gives the same text.
std::string description_xml(const models::ProbingModel& model, std::span<const Variable> variables,
                            std::string_view guid, std::string_view version);

}  // namespace tractus::fmu
