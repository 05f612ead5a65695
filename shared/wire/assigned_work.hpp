/// What a station is told of a trainee's assignments: the next trial, and nothing of those after
/// it.
#pragma once

#include <optional>

#include "core/json.hpp"
#include "trial/tool.hpp"
#include "trial/trial.hpp"

namespace tractus::wire {

/// One trial to be done now. Of a scenario, nothing tells which it is; of a palpation case, its id
/// alone, so that the station finds it on its disk.
struct AssignedTrial {
  std::string slot;  ///< 64 hexadecimal characters: the trial's case_id in file and upload
  trial::Rig rig = trial::Rig::palpation;
  std::string name;          ///< what the trainee is shown
  std::string assignment;    ///< its title
  std::uint64_t number = 0;  ///< of the assignment's trials of this trainee, from 1
  std::uint64_t planned = 0;
  std::string case_id;  ///< of a palpation case; empty for a scenario
  std::string sealed;   ///< of a scenario: the law's numbers, for this station alone; else empty
  // Of a case whose bone is whole. Not on the wire elsewhere: stations that know no drilling go on.
  bool drills = false;       ///< the channel is made now, with the burr
  std::string drilled = {};  ///< trial of this station that made the channel, which is felt now

  core::Json to_json() const;
  static core::Result<AssignedTrial> from_json(const core::Json& json, const std::string& where);
};

/// The answer to "what next?".
struct AssignedWork {
  std::string participant;  ///< the trainee's pseudonym: the operator in the trial's file
  std::uint64_t left = 0;   ///< trials still to be done, this one included
  std::optional<AssignedTrial> trial;

  core::Json to_json() const;
  static core::Result<AssignedWork> from_json(const core::Json& json, const std::string& where);
};

}  // namespace tractus::wire
