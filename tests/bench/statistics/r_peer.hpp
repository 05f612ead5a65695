/// R as a rival: a process of its own, on the same numbers.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tractus::bench {

using Answers = std::map<std::string, std::vector<double>>;

/// Runs an R script of this folder; its lines as name → numbers. Empty when there is no R.
Answers r_answers(const std::string& script, const std::filesystem::path& folder, long rows);

/// A NIST file: numbers of the lines from `first` on; the numbers after `label`.
std::vector<std::vector<double>> nist_rows(const std::string& path, std::size_t first);
std::vector<double> nist_line(const std::string& path, const std::string& label);
/// Correct digits of `got`, at most 15.
double digits(double got, double want);

}  // namespace tractus::bench
