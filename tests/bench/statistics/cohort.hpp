/// A simulated cohort and all standard analyses of it.
#pragma once

#include <string>

namespace tractus::bench {

/// `trainees` × `trials` rows as CSV: simulated answers and times with learning.
std::string simulated_cohort(int trainees, int trials);

/// Every standard analysis on it; false, naming the first that failed.
bool analyse_cohort(const std::string& csv, std::string& failed);

}  // namespace tractus::bench
