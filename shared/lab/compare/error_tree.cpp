#include "lab/compare/error_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tractus {
namespace lab {
namespace {

/// One leaf's worth in nats: what knowing its shares and its mean tells (see `find_error_regions`).
double worth(const Sums& sums, const Sums& all) {
  if (!(sums.weight > 0.0) || !(sums.capped > 0.0) || !(all.capped > 0.0)) return 0.0;
  const double of_error = sums.capped / all.capped, of_time = sums.weight / all.weight;
  double mean_squares = 0.0;
  for (const double r : sums.residual) mean_squares += r * r / (sums.weight * sums.weight);
  return of_error * std::log(of_error / of_time) + sums.weight * mean_squares / all.capped;
}

Sums difference(const Sums& a, const Sums& b) {
  Sums out = a;
  out.weight -= b.weight;
  out.capped = std::max(0.0, out.capped - b.capped);
  for (std::size_t c = 0; c < out.residual.size(); ++c) out.residual[c] -= b.residual[c];
  return out;
}

/// Sums and trials seen in the growing half, by bin of one feature.
struct ByBin {
  std::vector<Sums> sums;
  std::vector<std::vector<bool>> blocks;  // [bin][block]
};

class Grower {
 public:
  Grower(const Samples& samples, const Rows& rows, const ErrorRegionOptions& options)
      : samples_(samples), rows_(rows), options_(options) {}

  std::unique_ptr<Node> tree() {
    auto root = std::make_unique<Node>();
    root->rows.resize(rows_.count);
    std::iota(root->rows.begin(), root->rows.end(), 0u);
    fill(*root);
    all_grown_ = root->grown;
    all_filled_ = root->filled;
    std::vector<bool> seen(rows_.blocks);
    for (std::size_t k = 0; k < rows_.count; ++k)
      if (!rows_.fills[k]) seen[rows_.block[k]] = true;
    least_blocks_ =
        std::min(options_.leaf_trials, std::size_t(std::count(seen.begin(), seen.end(), true)));
    grow(*root, options_.depth);
    prune(*root);
    return root;
  }

 private:
  void fill(Node& node) const {
    node.grown.residual.assign(rows_.residual.size(), 0.0);
    node.filled = node.grown;
    for (const auto row : node.rows) (rows_.fills[row] ? node.filled : node.grown).take(rows_, row);
  }

  ByBin by_bin(const Node& node, std::size_t feature) const {
    const auto& words = samples_.features[feature].words;
    const std::size_t bins = words.empty() ? rows_.edges[feature].size() + 1 : words.size();
    ByBin out{std::vector<Sums>(bins), std::vector(bins, std::vector<bool>(rows_.blocks))};
    for (Sums& sums : out.sums) sums.residual.assign(rows_.residual.size(), 0.0);
    for (const auto row : node.rows) {
      if (rows_.fills[row]) continue;
      out.sums[rows_.bins[feature][row]].take(rows_, row);
      out.blocks[rows_.bins[feature][row]][rows_.block[row]] = true;
    }
    return out;
  }

  bool may_stand(const Sums& sums, const std::vector<bool>& blocks) const {
    return sums.weight >= options_.leaf_share * all_grown_.weight &&
           std::size_t(std::count(blocks.begin(), blocks.end(), true)) >= least_blocks_;
  }

  /// Tries "some bins against the rest" as the node's split.
  void consider(Node& node, const ByBin& table, const std::vector<bool>& taken,
                const Condition& split) const {
    Sums in;
    in.residual.assign(rows_.residual.size(), 0.0);
    std::vector<bool> in_blocks(rows_.blocks), out_blocks(rows_.blocks);
    for (std::size_t bin = 0; bin < taken.size(); ++bin) {
      if (taken[bin]) in.add(table.sums[bin]);
      auto& blocks = taken[bin] ? in_blocks : out_blocks;
      for (std::size_t b = 0; b < blocks.size(); ++b)
        if (table.blocks[bin][b]) blocks[b] = true;
    }
    const Sums rest = difference(node.grown, in);
    if (!may_stand(in, in_blocks) || !may_stand(rest, out_blocks)) return;
    const double gain =
        worth(in, all_grown_) + worth(rest, all_grown_) - worth(node.grown, all_grown_);
    if (gain > node.gain) node.gain = gain, node.split = split;
  }

  void find_split(Node& node) const {
    for (std::size_t f = 0; f < samples_.features.size(); ++f) {
      const ByBin table = by_bin(node, f);
      const std::size_t bins = table.sums.size();
      std::vector<bool> taken(bins, true);
      if (samples_.features[f].words.empty())
        for (std::size_t b = 0; b + 1 < bins; ++b) {
          taken[b] = false;
          consider(node, table, taken, {f, Condition::Op::above, rows_.edges[f][b], 0});
        }
      else
        for (std::size_t b = 0; b < bins; ++b) {
          taken.assign(bins, false);
          taken[b] = true;
          consider(node, table, taken, {f, Condition::Op::equals, 0.0, b});
        }
    }
  }

  bool fulfils(const Condition& split, std::size_t row) const {
    const std::size_t bin = rows_.bins[split.feature][row];
    if (split.op == Condition::Op::equals) return bin == split.word;
    return bin > 0 && rows_.edges[split.feature][bin - 1] >= split.bound;
  }

  void grow(Node& node, int depth) const {
    if (depth == 0) return;
    find_split(node);
    if (node.gain < options_.least_gain) return;
    node.first = std::make_unique<Node>();
    node.second = std::make_unique<Node>();
    for (const auto row : node.rows)
      (fulfils(node.split, row) ? node.first : node.second)->rows.push_back(row);
    for (Node* child : {node.first.get(), node.second.get()}) {
      fill(*child);
      grow(*child, depth - 1);
    }
    node.confirmed = worth(node.first->filled, all_filled_) +
                     worth(node.second->filled, all_filled_) - worth(node.filled, all_filled_);
  }

  /// Takes back what the other half does not confirm; returns what the subtree brings there.
  double prune(Node& node) const {
    if (!node.first) return 0.0;
    const double below = prune(*node.first) + prune(*node.second);
    const double least = options_.least_gain *
                         (1.0 + (node.first->first ? 1.0 : 0.0) + (node.second->first ? 1.0 : 0.0));
    if (node.confirmed + below >= least) return node.confirmed + below;
    node.first.reset();
    node.second.reset();
    return 0.0;
  }

  const Samples& samples_;
  const Rows& rows_;
  const ErrorRegionOptions& options_;
  Sums all_grown_, all_filled_;
  std::size_t least_blocks_ = 1;
};

}  // namespace

void Sums::take(const Rows& rows, std::size_t row) {
  weight += rows.weight[row];
  error += rows.weight[row] * rows.error[row];
  capped += rows.weight[row] * rows.capped[row];
  for (std::size_t c = 0; c < residual.size(); ++c)
    residual[c] += rows.weight[row] * rows.residual[c][row];
}

void Sums::add(const Sums& other) {
  weight += other.weight;
  error += other.error;
  capped += other.capped;
  for (std::size_t c = 0; c < residual.size(); ++c) residual[c] += other.residual[c];
}

std::unique_ptr<Node> grown_tree(const Samples& samples, const Rows& rows,
                                 const ErrorRegionOptions& options) {
  return Grower(samples, rows, options).tree();
}

}  // namespace lab
}  // namespace tractus
