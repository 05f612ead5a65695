/// What of a study nobody sees yet: a participant's trials, until the participant is through.
#pragma once

#include "db/store/store.hpp"

namespace tractus::store {

/// SQL, true of a row `t` of `trials` that is of a study of research whose participant still has
/// trials to do.
std::string blinded_sql();
/// Is this trial one? Not where there is no such trial.
core::Result<bool> is_blinded(Reading& tx, const std::string& trial_id);
/// Is every participant of this study through? Not where there is no such study, or nobody in it.
core::Result<bool> is_study_through(Reading& tx, const std::string& study_id);

}  // namespace tractus::store
