/// The report of a plan's run as a page: question, sample, results, each analysis with tables,
/// checks and pictures, what was published beside what is computed, a methods paragraph.
#pragma once

#include <string>

#include "assessment/analyse.hpp"

namespace tractus::assessment {

std::string report_page(const Analysed& analysed);

}  // namespace tractus::assessment
