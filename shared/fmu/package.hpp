/// A model written as an FMU (FMI 2.0, co-simulation): one file that other simulation tools run.
#pragma once

#include <filesystem>
#include <string_view>

#include "core/result.hpp"
#include "models/probing_model.hpp"

namespace tractus::fmu {

/// Has the model an effect that is a user's formula? Its FMU then needs the library muParser where it
/// runs; others need none.
bool has_formula(const models::ProbingModel& model);

/// The shared object that runs such a model in an FMU: beside this program, in ../lib/tractus, with the
/// licences of what is linked in (licences.txt). Errors: not_found.
core::Result<std::filesystem::path> runtime_path(const models::ProbingModel& model);

/// Writes the FMU, whole or not at all. The same model and program give the same bytes.
/// @param runtime  of runtime_path(). @param version  of this program.
/// Errors: io, conflict.
core::Result<void> write_fmu(const models::ProbingModel& model,
                             const std::filesystem::path& runtime, const std::filesystem::path& out,
                             std::string_view version);

}  // namespace tractus::fmu
