/// The decoded recording of a trial, from its file or from the cache.
#pragma once

#include "db/store/trials/trials.hpp"
#include "server/api/backend.hpp"
#include "trial/trial_file.hpp"

namespace tractus::api {

core::Result<trial::Header> header_of(const store::TrialRecord& trial);

/// Errors: not_found, those of reading.
core::Result<std::shared_ptr<const trial::Signals>> signals_of(Backend& backend,
                                                               const std::string& trial_id);

}  // namespace tractus::api
