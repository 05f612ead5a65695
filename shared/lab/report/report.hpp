/// The lab's report: one page that stands alone.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lab/compare/comparison.hpp"
#include "lab/compare/samples.hpp"
#include "lab/identify/diagnosis.hpp"
#include "lab/identify/fit.hpp"
#include "lab/rigs/palpation/tract_map.hpp"

namespace tractus::lab {

/// A model beside the measurements, and what came of the comparison.
struct Side {
  Samples samples;
  Comparison comparison;
};

/// What a diagnosis comes to: of all channels that were judged, the torque about the axis beside the force.
struct StatedVerdict {
  Verdict verdict = Verdict::complete;
  double probability = 0.0;
  std::string headline, detail;
};

/// What a report may hold; what is absent is left out of the page.
struct ReportContent {
  std::string model_name, set_name;
  bool simulated = false;                ///< the measurements are simulated themselves
  double given_rmse = 0.0;               ///< of the model as it was given, of what is judged
  Side before;                           ///< the model to improve
  std::string before_name = "as given";  ///< or "refitted", where its own numbers were fitted first
  std::optional<Side> better;            ///< refitted, with the effects that were found or added
  std::optional<Diagnosis> diagnosis;
  std::optional<StatedVerdict> stated;  ///< with a diagnosis
  std::optional<Fit> fit;               ///< of the better model, when nothing was diagnosed
  std::vector<Parameter> start;      ///< the better model's parameters as they were before the fit
  std::vector<Candidate> catalogue;  ///< for equations and units
  std::vector<std::string> notes;    ///< on the recording
  std::optional<TractMap> map;       ///< of the error before, for palpation
};

/// A complete HTML document: no script, nothing fetched; light and dark by the reader's setting,
/// light on paper. Verdict first, then the figures behind it. Texts of the model and the set are
/// escaped.
std::string report(const ReportContent& content);

}  // namespace tractus::lab
