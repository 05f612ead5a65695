/// Blinded trials of a study: nobody sees a participant's trials until the participant has
/// finished.
#pragma once

#include "db/store/store.hpp"

namespace tractus::store {

/// SQL, true of a row `t` of `trials` that is of a study of research whose participant still has
/// trials to do.
std::string blinded_sql();
/// Whether this trial is blinded; false for an unknown trial.
core::Result<bool> is_blinded(Reading& tx, const std::string& trial_id);
/// Whether every participant of this study has finished; false for an unknown study or without
/// participants.
core::Result<bool> is_study_through(Reading& tx, const std::string& study_id);

}  // namespace tractus::store
