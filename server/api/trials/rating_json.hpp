/// Rubrics and ratings as pages see them.
#pragma once

#include "assessment/rubric.hpp"
#include "db/store/trials/ratings.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"

namespace tractus::api {

/// The grants of those who rate: administrators, directors, and faculty for whom they teach.
std::vector<Grant> raters();

/// Whether the caller may see the trial at all, by its relation to the trainee and by blinding.
core::Result<bool> sees_trial(store::Reading& tx, const Call& call, const std::string& trial_id);

core::Result<assessment::Rubric> stored_rubric(const store::RubricVersion& of);
/// Of the version that is asked for. Errors: not_found.
core::Result<store::RubricVersion> rubric_version(store::Reading& tx, const std::string& id,
                                                  std::int64_t version);
/// {"id", "version", "title", "items", "reason", "made_utc_us", "made_by"}
core::Result<core::Json> rubric_version_json(const store::RubricVersion& of);
std::vector<NamedSchema> rubric_schemas();

}  // namespace tractus::api
