/// A model and a set of measurements, opened and made ready to judge.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "core/result.hpp"
#include "lab/compare/describe.hpp"
#include "lab/identify/problem.hpp"
#include "lab/io/own_effect.hpp"
#include "models/probing_model.hpp"
#include "trial/probing_set.hpp"

namespace tractus::lab_io {

struct Sources {
  std::filesystem::path model;         ///< tractus-model/1
  std::filesystem::path measurements;  ///< a folder or a zip, tractus-measurements/1
  std::vector<OwnEffect> own = {};     ///< the user's own effects, candidates as the catalogue's
  int threads = 2;
  bool keep_recordings = false;  ///< for weighing programs
};

/// What a probing problem was made of.
struct ProbingRecordings {
  models::ProbingModel model;
  trial::ProbingSet set;
};

/// What the lab works on. Holds all that it needs: files may go once it is open.
struct Case {
  std::string model_name, set_name;
  bool simulated = false;        ///< the set says that its measurements are simulated themselves
  core::Json tract;              ///< where the palpated channel is, as the set states it; else null
  std::vector<std::string> own;  ///< ids of the user's own effects
  std::unique_ptr<lab::Problem> problem;
  std::unique_ptr<lab::Problem>
      torque;  ///< about the probe's axis, where it was recorded beside the force; else null
  lab::Recorded recorded;
  std::optional<ProbingRecordings> kept = {};  ///< where asked for, of the probing rig
};

/// A palpation's volume lies beside the model, if that names one, else in the set. Errors: those of
/// the readers; bad_input naming both rigs when the model is of another rig than the set, or when
/// nothing names a volume; cancelled.
core::Result<Case> open_case(const Sources& sources, const core::Progress& progress = {});

/// What a set holds, once all of it was read.
struct SetFacts {
  std::string rig;
  bool simulated = false;
  std::size_t trials = 0, samples = 0;
};
/// Reads a whole set and keeps nothing. Errors: as of open_case, with the file's name within the
/// set rather than where it was unpacked.
core::Result<SetFacts> facts_of_set(const std::filesystem::path& path);

/// A bar over several pieces of work, each with its share.
core::Progress part_of(const core::Progress& whole, double from, double width);

}  // namespace tractus::lab_io
