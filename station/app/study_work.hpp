/// A participant's next trials of a blind study, for the terminal (`study`) and the kiosk.
#pragma once

#include "station/app/options.hpp"
#include "station/session/study_plan.hpp"
#include "wire/assigned_work.hpp"

namespace tractus::app {

struct StudyPart {
  wire::StudyWork work;
  bool away = false;  ///< from the disk: the server does not answer
};
/// All that is left, from the server; from the disk when it does not answer. Errors: the server's,
/// bad_input when person and device do not fit each other.
core::Result<StudyPart> study_part(const Options& options, const session::StationFolder& folder,
                                   const std::string& participant, const std::string& device);

/// The next of them that was not recorded here yet, in the form of an assigned trial. Errors: those
/// of study_part, of the outbox.
core::Result<wire::AssignedWork> next_of_study(const Options& options,
                                               const session::StationFolder& folder,
                                               const std::string& participant);

}  // namespace tractus::app
