/// What a station is told of a blind study.
#pragma once

#include <optional>
#include <vector>

#include "core/json.hpp"

namespace tractus::wire {

/// One trial to be done. Nothing of it tells which scenario it is.
struct SealedTrial {
  std::string slot;          ///< 64 hexadecimal characters: the trial's case_id in file and upload
  std::uint64_t number = 0;  ///< of the participant's trials, from 1
  std::string sealed;        ///< the law's numbers, for this station alone (study/sealed_law.hpp)

  core::Json to_json() const;
  static core::Result<SealedTrial> from_json(const core::Json& json, const std::string& where);
};

/// The next trials of a participant.
struct StudyWork {
  std::string study, participant;
  bool simulated = false;                  ///< the participant is a simulated surgeon
  std::optional<double> experience_years;  ///< of the participant
  std::uint64_t unfinished = 0;            ///< still to be done; 0: the participant is through
  std::uint64_t planned = 0;               ///< in all
  std::vector<SealedTrial> trials;         ///< in the order to be done

  core::Json to_json() const;
  static core::Result<StudyWork> from_json(const core::Json& json, const std::string& where);
};

/// Is it a study's id or a participant's pseudonym: 1 to 32 letters, digits, - and _?
bool is_study_name(std::string_view text) noexcept;

}  // namespace tractus::wire
