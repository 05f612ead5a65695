/// A model and a set of measurements, opened and made ready to judge.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "core/result.hpp"
#include "lab/describe.hpp"
#include "lab/problem.hpp"

namespace lab_io {

struct Sources {
  std::filesystem::path model;                      ///< tractus-model/1
  std::filesystem::path measurements;               ///< a folder or a zip, tractus-measurements/1
  std::vector<std::filesystem::path> effects = {};  ///< the user's own, added to the model
  int threads = 2;
};

/// What the lab works on. Holds all that it needs: files may go once it is open.
struct Case {
  std::string model_name, set_name;
  bool simulated = false;  ///< the set says that its measurements are simulated themselves
  std::unique_ptr<lab::Problem> problem;
  lab::Recorded recorded;
};

/// A palpation's volume lies beside the model, if that names one, else in the set. Errors: those of
/// the readers; bad_input naming both rigs when the model is of another rig than the set, or when
/// nothing names a volume; cancelled.
core::Result<Case> open_case(const Sources& sources, const core::Progress& progress = {});

/// A bar over several pieces of work, each with its share.
core::Progress part_of(const core::Progress& whole, double from, double width);

}  // namespace lab_io
