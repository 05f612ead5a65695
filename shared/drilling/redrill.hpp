/// A recorded drilling done again: from the trial's samples to the same voxels.
#pragma once

#include <filesystem>
#include <optional>

#include "drilling/drilled.hpp"
#include "trial/trial_file.hpp"

namespace tractus::drilling {

/// What a trial's header says of its drilling, `extra.drilling`: {"law", "chunk_ticks", "burr",
/// "transfer": [[value, opacity], …]}. With the samples and the case's volume that is everything.
struct Setup {
  static constexpr std::string_view kLaw = "tractus-drilling/1";
  Burr burr;
  volume::TransferFunction transfer = volume::TransferFunction::bone();

  core::Json to_json() const;
  /// Errors: bad_input: the header is of a trial that drilled nothing, or a field.
  static core::Result<Setup> of(const trial::Header& header);
};

/// A trial drilled again.
struct Redrilled {
  trial::Header header;
  Erosion erosion;
  core::Json said;  ///< detail of the trial's own "drilled" event; null when it was cut short

  /// Does the trial's own word agree? Nothing when it gave none.
  std::optional<bool> agrees() const;
};

/// @param bone       the case's volume; must outlive the result
/// @param on_sample  may be empty: called with each sample before it wears the bone, and
/// @param changed    with each change, so that a field can follow
/// Errors: those of reading the trial, of Setup and of Erosion; bad_input for a probe that has no
/// length.
core::Result<Redrilled> redrill(
    const std::filesystem::path& trial_file, const volume::Volume& bone,
    const std::function<void(const trial::Sample&)>& on_sample = {},
    const std::function<void(const Change&, const volume::Volume&)>& changed = {});

}  // namespace tractus::drilling
