#include "bench/statistics/r_peer.hpp"

#include <algorithm>
#include <checkout.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace tractus::bench {
namespace {
const std::string kSource = checkout::kSource;
}

Answers r_answers(const std::string& script, const std::filesystem::path& folder, long rows) {
  Answers out;
  const std::string command = "Rscript --vanilla '" + kSource + "/tests/bench/statistics/" +
                              script + "' '" + folder.string() + "' " + std::to_string(rows) +
                              " '" + kSource +
                              "/tests/golden/statistics-reference/nist' 2>/dev/null";
  FILE* pipe = ::popen(command.c_str(), "r");
  if (!pipe) return out;
  std::string text;
  char buffer[4096];
  while (const std::size_t got = std::fread(buffer, 1, sizeof buffer, pipe))
    text.append(buffer, got);
  ::pclose(pipe);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name, word;
    words >> name;
    while (words >> word) out[name].push_back(std::strtod(word.c_str(), nullptr));
  }
  return out;
}

std::vector<std::vector<double>> nist_rows(const std::string& path, std::size_t first) {
  std::ifstream file(kSource + "/tests/golden/statistics-reference/nist/" + path);
  std::vector<std::vector<double>> out;
  std::string line;
  for (std::size_t n = 1; std::getline(file, line); ++n) {
    std::istringstream words(line);
    std::vector<double> row;
    for (double value = 0.0; n >= first && words >> value;) row.push_back(value);
    if (!row.empty()) out.push_back(row);
  }
  return out;
}

std::vector<double> nist_line(const std::string& path, const std::string& label) {
  std::ifstream file(kSource + "/tests/golden/statistics-reference/nist/" + path);
  std::vector<double> out;
  for (std::string line; std::getline(file, line) && out.empty();) {
    const auto at = line.find(label);
    if (at == std::string::npos) continue;
    std::istringstream words(line.substr(at + label.size()));
    for (std::string word; words >> word;) {
      char* end = nullptr;
      const double value = std::strtod(word.c_str(), &end);
      if (end != word.c_str() && *end == '\0') out.push_back(value);
    }
  }
  return out;
}

double digits(double got, double want) {
  if (got == want) return 15.0;
  const double error = want == 0.0 ? std::abs(got) : std::abs(got - want) / std::abs(want);
  return std::isfinite(error) ? std::clamp(-std::log10(error), 0.0, 15.0) : 0.0;
}

}  // namespace tractus::bench
