/// The lab's three questions asked of a case, each answered whole: figures, JSON, report, model.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "lab/discover/discovery.hpp"
#include "lab/experiments/preposterior.hpp"
#include "lab/identify/diagnosis.hpp"
#include "lab/io/case.hpp"
#include "lab/report/report.hpp"

namespace tractus::lab_io {

struct LabResult {
  core::Json json;                          ///< as design and formats say
  lab::ReportContent content;               ///< filled as far as it was asked for
  std::optional<core::Json> model;          ///< the better model, as a model file
  std::optional<lab::Discovery> discovery;  ///< where formulas were asked for
  std::vector<lab::ProgramValue>
      programs;  ///< recordings that would decide, where these were asked for, best first
};

/// The model as it is given, beside the measurements.
LabResult compared(const Case& opened);

struct DiagnoseRequest {
  lab::DiagnoseOptions options;
  bool report = false;      ///< also compare before and after, for the page
  std::size_t propose = 0;  ///< formulas for what no catalogue explains, at most
  /// Simulates recordings that would decide between the structures left; of the probing rig, opened with its recordings kept.
  enum class Weigh { never, if_undecided, always } programs = Weigh::never;
};
/// Which effect is missing. Errors: those of lab::diagnose.
core::Result<LabResult> diagnosed(const Case& opened, const DiagnoseRequest& wish,
                                  const core::Progress& progress = {});

/// Refits with effects added by hand and the user's own. Errors: those of lab::fit; not_found for
/// an id that is not in this rig's catalogue, with its reason if the recording cannot show it.
core::Result<LabResult> fitted(const Case& opened, std::vector<std::string> effects, int threads,
                               const core::Progress& progress = {});

}  // namespace tractus::lab_io
