/// modelDescription.xml of FMI 2.0: what an importer reads of a model before it runs it.
#pragma once

#include <span>
#include <string>

#include "fmu/variables.hpp"

namespace tractus::fmu {

/// The name of the shared object in an FMU, and the `modelIdentifier`.
inline constexpr const char* kModelIdentifier = "tractus_model";

struct Description {
  std::string model_name, summary;
  std::span<const Variable> variables;
  std::string guid;
  std::string_view version;  ///< of this program
};

/// The same description gives the same text.
std::string description_xml(const Description& description);

}  // namespace tractus::fmu
