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
  double d_prime = 0.0;
  bool passes = true;
  int trials = 0, right = 0;
  std::vector<std::string> said = {};  ///< [trial]: a wall or "whole"

  double rate() const { return double(right) / trials; }
};

/// Share of right answers that d′ foretells where one of six answers is right, by the greatest of
/// six independent normal evidences, one of them higher by d′ [Hacker1979]:
///
///     P = ∫ φ(x − d′) Φ(x)⁵ dx
///
/// It is a prediction of an ideal chooser that looks once: K and B are maxima, so an upper bound;
/// a hand that looks again can be better.
double foretold_rate(double d_prime);

/// Pearson's r of rate and foretold rate over forms with a breach.
double correlation(const std::vector<Tried>& tried);

/// Rates by wall with Wilson intervals, false alarms of whole forms, confusions.
void print_table(const std::vector<Tried>& tried);

/// Rate against d′ of each form with a breach, and the foretold curve, as SVG. Ends the program
/// when it cannot be written.
void write_scatter(const std::filesystem::path& path, const std::vector<Tried>& tried);

}  // namespace tractus::bench
