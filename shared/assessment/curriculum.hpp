/// A curriculum: ordered steps, each with its cases, what passing it is, and the steps that must be
/// passed before.
#pragma once

#include "assessment/criteria.hpp"

namespace tractus::assessment {

struct CurriculumStep {
  std::string id, name;
  std::vector<std::string> cases;  ///< ids
  long repeats = 1;                ///< of each case, planned
  std::vector<std::string> after;  ///< ids of earlier steps, all of which must be passed
  Criteria criteria;
};

struct Curriculum {
  std::vector<CurriculumStep> steps;

  /// {"format": "tractus-curriculum/1", "steps": [{"id", "name", "cases", "repeats", "after",
  /// "criteria"}]}, one to twenty. Errors: bad_input with the field.
  static core::Result<Curriculum> from_json(const core::Json& json, const std::string& where);
  core::Json to_json() const;
};

struct StepTrial {
  JudgedTrial trial;
  std::string case_id;
};

struct StepProgress {
  Verdict verdict;
  bool open = false;  ///< the steps before it are passed
};

struct Progress {
  std::vector<StepProgress> steps;
  bool passed = false;                        ///< all steps
  std::optional<std::size_t> next_step = {};  ///< the first that is open and not passed
  std::string next_case = {};  ///< its case whose failure rate may be highest (trainee.hpp)
};

/// @param trials  of each step, in the order of time.
Progress progress(const Curriculum& of, const std::vector<std::vector<StepTrial>>& trials);

}  // namespace tractus::assessment
