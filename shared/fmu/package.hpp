/// A model written as an FMU (FMI 2.0, co-simulation): one file that other simulation tools run.
#pragma once

#include <filesystem>
#include <string_view>

#include "core/result.hpp"
#include "fmu/palpation.hpp"
#include "models/probing_model.hpp"

namespace tractus::fmu {

/// Has the model an effect that is a user's formula? Its FMU then needs the library muParser where it
/// runs; others need none.
bool has_formula(std::span<const effects::EffectInstance> effects);

/// The shared object that runs such a model in an FMU: beside this program, in ../lib/tractus, with the
/// licences of what is linked in (licences.txt). Errors: not_found.
core::Result<std::filesystem::path> runtime_path(std::span<const effects::EffectInstance> effects);

/// Where an FMU is written and by whom.
struct Target {
  std::filesystem::path runtime;  ///< of runtime_path()
  std::filesystem::path out;
  std::string_view version;  ///< of this program
};

/// Writes the FMU, whole or not at all. The same model and program give the same bytes.
/// Errors: io, conflict, too_large.
core::Result<void> write_fmu(const models::ProbingModel& model, const Target& target);
/// Errors: also out_of_range for a model that no FMU can run (with_parameters).
core::Result<void> write_fmu(const models::PalpationModel& model, const CarriedField& field,
                             const Target& target);

}  // namespace tractus::fmu
