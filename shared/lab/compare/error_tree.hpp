/// The regression tree behind `find_error_regions`: grown on one half of the rows, checked and
/// filled on the other.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "lab/compare/error_regions.hpp"

namespace tractus::lab {

/// The rows of a set as the tree sees them.
struct Rows {
  std::size_t count = 0;
  std::vector<std::vector<std::uint8_t>> bins;  // [feature][row]; a word's index is its bin
  std::vector<std::vector<double>> edges;     ///< of each feature with numbers: bin b holds values
                                              ///< in [edges[b − 1], edges[b])
  std::vector<double> weight;                 // [row] samples stood for
  std::vector<double> error, capped;          // [row] squared residual; as the tree counts it
  std::vector<std::vector<double>> residual;  // [judged channel][row]
  std::vector<std::uint32_t> block;           // [row] trial, or stretch of time
  std::vector<std::uint8_t> fills;            // [row] 1: the half that checks and fills
  std::size_t blocks = 0;
};

/// Sums over some rows.
struct Sums {
  double weight = 0.0, error = 0.0, capped = 0.0;
  std::vector<double> residual;  // [judged channel]
  void take(const Rows& rows, std::size_t row);
  void add(const Sums& other);
};

struct Node {
  Condition split;  ///< its first child holds what fulfils it
  std::unique_ptr<Node> first, second;
  std::vector<std::uint32_t> rows;
  Sums grown, filled;                  ///< of its rows in each half
  double gain = 0.0, confirmed = 0.0;  ///< of its split on each half
};

/// Grows and prunes. The features' words say which bins are words.
std::unique_ptr<Node> grown_tree(const Samples& samples, const Rows& rows,
                                 const ErrorRegionOptions& options);

}  // namespace tractus::lab
