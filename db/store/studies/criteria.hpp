/// Versions of what passing is, and of curricula; rows are only ever added.
#pragma once

#include <vector>

#include "db/store/studies/assignments.hpp"

namespace tractus::store {

/// What a criterion is of.
enum class CriteriaKind { programme, of_case, assignment };
constexpr auto words(CriteriaKind) {
  using enum CriteriaKind;
  return std::to_array<core::Word<CriteriaKind>>(
      {{programme, "programme"}, {of_case, "case"}, {assignment, "assignment"}});
}

struct CriteriaVersion {
  CriteriaKind kind = CriteriaKind::programme;
  std::string subject;  ///< id of the case or the assignment; empty for the programme
  std::int64_t version = 0;
  std::string definition;  ///< JSON, tractus-criteria/1
  std::string reason;
  std::int64_t made_utc_us = 0;
  std::string made_by;
  std::string title = {};  ///< of the case or the assignment; filled on reading
};

/// Adds the next version; `version` is not taken.
core::Result<void> add_criteria(Writing& tx, const CriteriaVersion& of);
/// Oldest first.
core::Result<std::vector<CriteriaVersion>> criteria_of(Reading& tx, CriteriaKind kind,
                                                       const std::string& subject);
/// All, by kind and subject, oldest first.
core::Result<std::vector<CriteriaVersion>> all_criteria(Reading& tx);

struct CurriculumVersion {
  std::string id;
  std::int64_t version = 0;
  std::string title;
  std::string definition;  ///< JSON, tractus-curriculum/1
  std::string reason;
  std::int64_t made_utc_us = 0;
  std::string made_by;
};

/// Adds the next version; `version` is not taken. Returns it.
core::Result<std::int64_t> add_curriculum(Writing& tx, const CurriculumVersion& of);
/// By id, oldest version first.
core::Result<std::vector<CurriculumVersion>> all_curricula(Reading& tx);
/// Oldest first; none if there is no such curriculum.
core::Result<std::vector<CurriculumVersion>> curriculum_versions(Reading& tx,
                                                                 const std::string& id);

/// The assignment that hands out a step's cases.
struct CurriculumAssignment {
  std::string study_id, curriculum_id;
  std::int64_t version = 0;
  std::string step_id;
};
core::Result<void> add_curriculum_assignment(Writing& tx, const CurriculumAssignment& of);
/// Of the assignments that this account has; empty: of all. By curriculum and version.
core::Result<std::vector<CurriculumAssignment>> curriculum_assignments(
    Reading& tx, const std::string& account_id);

}  // namespace tractus::store
