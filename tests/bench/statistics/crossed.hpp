/// Mixed models of surgeons crossed with scenarios, linear and logistic, against lme4 in the same run.
#pragma once

#include <filesystem>

#include "bench/support/report.hpp"

namespace tractus::bench {

/// 10⁶ rows, 10⁴ surgeons, 10³ scenarios; `small`: a tenth of each. Simulated data, written to
/// `folder` for R.
void crossed(Report& report, const std::filesystem::path& folder, bool small);

/// The same of yes-or-no answers, first of a tenth of each; of the whole lme4 does its rougher
/// approximation alone.
void crossed_answers(Report& report, const std::filesystem::path& folder, bool small);

}  // namespace tractus::bench
