/// What a published case says of itself.
#pragma once

#include "cases/case.hpp"
#include "db/store/store.hpp"
#include "db/store/volumes/objects.hpp"
#include "trial/trial.hpp"

namespace tractus::jobs {

struct CaseFacts {
  cases::Case definition;
  std::optional<cases::Truth> truth;   ///< absent when the bundle came without it
  std::optional<double> d_prime = {};  ///< of its breach, by its certificate
};

/// Errors: not_found (no such case), those of reading.
core::Result<CaseFacts> case_facts(store::Store& store, const store::Objects& objects,
                                   const std::string& case_id);

/// Of a trial's case, with the truth about what it felt: that of the case, or, where another trial
/// drilled the channel (`header` names it in extra.drilled), where that one left the bone; no truth
/// while that is not known here. Errors: those of case_facts.
core::Result<CaseFacts> facts_of_trial(store::Store& store, const store::Objects& objects,
                                       const std::string& case_id, const trial::Header& header);

/// A part's JSON; nothing when the case has no part of that name.
core::Result<std::optional<core::Json>> case_json_part(store::Store& store,
                                                       const store::Objects& objects,
                                                       const std::string& case_id,
                                                       const std::string& name);

}  // namespace tractus::jobs
