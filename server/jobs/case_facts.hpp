/// What a published case says of itself.
#pragma once

#include "cases/case.hpp"
#include "db/store/objects.hpp"
#include "db/store/store.hpp"

namespace jobs {

struct CaseFacts {
  cases::Case definition;
  std::optional<cases::Truth> truth;  ///< absent when the bundle came without it
};

/// Errors: not_found (no such case), those of reading.
core::Result<CaseFacts> case_facts(store::Store& store, const store::Objects& objects,
                                   const std::string& case_id);

/// A part's JSON; nothing when the case has no part of that name.
core::Result<std::optional<core::Json>> case_json_part(store::Store& store,
                                                       const store::Objects& objects,
                                                       const std::string& case_id,
                                                       const std::string& name);

}  // namespace jobs
