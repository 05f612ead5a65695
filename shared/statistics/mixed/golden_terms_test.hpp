/// Random terms and designs of the reference files, and how their estimates are compared.
#pragma once

#include <set>

#include "statistics/golden_test.hpp"
#include "statistics/mixed/random_term.hpp"

namespace tractus::statistics::golden {

/// (1 + slope | columns); no slope where it is empty.
struct Term {
  std::vector<std::string> columns;
  std::string slope = {};
  bool intercept = true;
};

inline RandomTerm random_term(const Csv& csv, const Term& term) {
  RandomTerm out;
  for (const auto& column : term.columns) {
    const auto cells = csv.texts(column);
    out.labels.resize(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
      out.labels[i] += (out.group.empty() ? "" : ":") + cells[i];
    out.group += (out.group.empty() ? "" : ":") + column;
  }
  const auto n = Eigen::Index(out.labels.size());
  std::vector<Vector> columns;
  if (term.intercept) columns.push_back(Vector::Ones(n));
  if (!term.slope.empty()) columns.push_back(csv.numbers(term.slope));
  out.columns.resize(n, std::ssize(columns));
  for (std::size_t c = 0; c < columns.size(); ++c) {
    out.columns.col(Eigen::Index(c)) = columns[c];
    out.names.push_back(std::to_string(c));
  }
  return out;
}

/// trial, and the scenario's levels against the first, as the formula says.
inline Design design_of(const Csv& csv, const std::string& formula, Eigen::Index rows) {
  std::vector<Vector> columns;
  if (formula.find("~ trial") != std::string::npos) columns.push_back(csv.numbers("trial"));
  if (formula.find("+ scenario") != std::string::npos) {
    const auto cells = csv.texts("scenario");
    const std::set<std::string> levels(cells.begin(), cells.end());
    for (auto level = std::next(levels.begin()); level != levels.end(); ++level) {
      columns.push_back(Vector::Zero(rows));
      for (std::size_t i = 0; i < cells.size(); ++i)
        if (cells[i] == *level) columns.back()[Eigen::Index(i)] = 1.0;
    }
  }
  Matrix all(rows, std::ssize(columns));
  std::vector<std::string> names;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    all.col(Eigen::Index(c)) = columns[c];
    names.push_back("x" + std::to_string(c));
  }
  return with_intercept(all, names);
}

inline void expect_random(const RandomPart& part, const core::Json& want, const std::string& what) {
  const double largest = matrix_of(want).cwiseAbs().maxCoeff();
  for (Eigen::Index r = 0; r < part.covariance.rows(); ++r)
    for (Eigen::Index c = 0; c < part.covariance.cols(); ++c)
      EXPECT_NEAR(part.covariance(r, c), want[std::size_t(r)][std::size_t(c)].get<double>(),
                  1e-6 * largest + 1e-9)
          << what << " " << part.group;
}

/// A random term's key in lme4's answer: "surgeon", and "surgeon.1" for the second of that group.
inline std::string key_of(const std::vector<RandomPart>& parts, std::size_t term) {
  int before = 0;
  for (std::size_t t = 0; t < term; ++t) before += parts[t].group == parts[term].group;
  return parts[term].group + (before ? "." + std::to_string(before) : "");
}

}  // namespace tractus::statistics::golden
