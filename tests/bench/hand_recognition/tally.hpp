/// What a hand said against what was there, and against what the certificate foretold.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/support/report.hpp"
#include "volume/tract.hpp"

namespace tractus::bench {

/// The trials of one form of one case.
struct Tried {
  std::string where;  ///< "L3 left, filled"
  std::optional<volume::Wall> breach = {};
  bool chosen = true;  ///< Form::chosen
  double noise = 1.0;  ///< of the hand's senses, times that of people
  double at_m = 0.0, rim_m = 0.0;
  double foretold = 0.0;
  bool passes = true;
  int trials = 0, right = 0;
  std::vector<std::string> said = {};  ///< [trial]: a wall or "whole"

  double rate() const { return double(right) / trials; }
};

/// Pearson's r of rate and foretold rate over forms with a breach.
double correlation(const std::vector<Tried>& tried);
/// The greatest r that any prediction could have with rates of so few trials: the root of the share
/// of their variance that is not binomial, 1 − ⟨p(1 − p)/(n − 1)⟩/var p.
double highest_correlation(const std::vector<Tried>& tried);

/// Rates by wall with Wilson intervals, false alarms of whole forms, confusions.
void print_table(const std::vector<Tried>& tried);

/// Rate against foretold rate of each form with a breach, as SVG. Ends the program
/// when it cannot be written.
void write_scatter(const std::filesystem::path& path, const std::vector<Tried>& tried);

}  // namespace tractus::bench
