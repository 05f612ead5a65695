/// Jobs that make cases from volumes: request, progress, result.
#pragma once

#include <vector>

#include "db/store/operations/jobs.hpp"

namespace tractus::store {

/// A case in the making.
struct CaseMaking {
  std::string id;
  std::string volume_id;
  std::string title;
  std::string plan;  ///< JSON, as jobs::plan_from reads it
  WorkState state = WorkState::queued;
  double share = 0.0;                  ///< of the work, 0 … 1
  std::string phase;                   ///< current step, in words
  std::string error;                   ///< reason for the failure
  std::optional<std::string> case_id;  ///< id of the case; nothing until the job is done
  std::int64_t made_utc_us = 0;
  std::string made_by;
};

core::Result<void> add_case_making(Writing& tx, const CaseMaking& making);
core::Result<std::optional<CaseMaking>> case_making_of(Reading& tx, const std::string& id);
/// Newest first.
core::Result<std::vector<CaseMaking>> case_makings(Reading& tx, std::int64_t limit);

core::Result<void> note_making(Writing& tx, const std::string& id, double share,
                               const std::string& phase, std::int64_t now_utc_us);
core::Result<void> finish_making(Writing& tx, const std::string& id, const std::string& case_id,
                                 std::int64_t now_utc_us);
core::Result<void> fail_making(Writing& tx, const std::string& id, const std::string& why,
                               std::int64_t now_utc_us);

}  // namespace tractus::store
