/// What the torque about the probe's axis says, of sets that record it beside the force.
#pragma once

#include "lab/io/answers.hpp"
#include "models/probing_model.hpp"
#include "trial/probing_set.hpp"

namespace tractus::lab_io {

/// Does every trial both slide and turn, with its torque recorded?
bool records_torque(const trial::ProbingSet& set);

/// A model with those of its effects alone that act about the probe's axis.
models::ProbingModel about_axis(models::ProbingModel model);

/// Diagnoses the torque and adds it to the force's answer: its effects to the effects, its error under "torque"; verdict,
/// sentences, probability and model are of both. Errors: those of lab::diagnose.
core::Result<void> add_torque(const lab::Problem& torque, const lab::Diagnosis& force,
                              const DiagnoseRequest& wish, LabResult& out,
                              const core::Progress& progress);

}  // namespace tractus::lab_io
