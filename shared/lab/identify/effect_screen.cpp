#include "lab/identify/effect_screen.hpp"

#include <algorithm>
#include <cmath>

#include "core/require.hpp"
#include "lab/identify/projection.hpp"
#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kScreen = kSettings.screen;

/// The numbers of one effect within a structure's parameters.
struct Block {
  std::size_t first = 0, count = 0;
};

Block block_of(const std::vector<Parameter>& parameters, std::string_view effect) {
  const std::string lead = std::string(effect) + "/";
  Block block;
  for (std::size_t k = 0; k < parameters.size(); ++k)
    if (parameters[k].pointer.starts_with(lead)) {
      if (block.count == 0) block.first = k;
      ++block.count;
    }
  return block;
}

/// Best coefficients of the columns, only those in `allowed` signs; the gain they bring.
double best(const Gram& rest, const std::vector<bool>& positive, Eigen::VectorXd& coefficients) {
  const auto n = std::size_t(rest.b.size());
  coefficients = Eigen::VectorXd::Zero(Eigen::Index(n));
  double gain = 0.0;
  const unsigned last = n <= 3 ? 1u << n : 2u;
  for (unsigned mask = 1; mask < last; ++mask) {
    std::vector<Eigen::Index> in;
    for (std::size_t k = 0; k < n; ++k)
      if (n > 3 || (mask >> k & 1u)) in.push_back(Eigen::Index(k));
    const Eigen::VectorXd x = -solve(rest.a(in, in), rest.b(in));
    bool fits = true;
    for (std::size_t k = 0; k < in.size(); ++k)
      fits = fits && (!positive[std::size_t(in[k])] || x(Eigen::Index(k)) > 0.0);
    const double now = -x.dot(rest.b(in));
    if (!fits || !(now > gain)) continue;
    gain = now;
    coefficients.setZero();
    for (std::size_t k = 0; k < in.size(); ++k) coefficients(in[k]) = x(Eigen::Index(k));
  }
  return gain;
}

/// One start of an effect looked at.
void look_at(const Residual& residual, const Solution& at, const Projection& base,
             const Structure& structure, const std::vector<Parameter>& parameters,
             const std::vector<double>& carried_values, const Block& block,
             const std::vector<double>& start, LinearScreen& out) {
  std::vector<double> off = carried_values;
  std::vector<std::size_t> strengths;
  bool elsewhere = false;
  for (std::size_t k = 0; k < block.count; ++k) {
    const Parameter& p = parameters[block.first + k];
    off[block.first + k] = std::clamp(p.shape ? start[k] : p.off, p.low, p.high);
    if (!p.shape) strengths.push_back(k);
    // What is searched in its logarithm takes the place of a number of the base: off is not here.
    elsewhere = elsewhere || (!p.shape && p.logarithmic);
  }
  std::vector<std::vector<double>> points;
  std::vector<bool> positive;
  for (const std::size_t k : strengths) {
    const Parameter& p = parameters[block.first + k];
    points.push_back(off);
    points.back()[block.first + k] = std::clamp(start[k], p.low, p.high);
    positive.push_back(p.low >= off[block.first + k]);
  }
  Eigen::MatrixXd columns = residual.near(structure, off, points);
  columns.colwise() -= elsewhere ? residual(structure, off) : at.residual;
  Eigen::VectorXd norms, coefficients;
  const Gram rest = base.without_fitted(columns, norms);
  LinearScreen::Start found{off, best(rest, positive, coefficients), {}};
  const double n = double(at.residual.size());
  for (std::size_t i = 0; i < strengths.size(); ++i) {
    const auto k = Eigen::Index(i);
    const double share = norms(k) > kScreen.no_response * n ? rest.a(k, k) / norms(k) : 0.0;
    out.independent_share = std::max(out.independent_share, share);
    if (share > kScreen.no_share) out.excited = true;
    const std::size_t at_value = block.first + strengths[i];
    const Parameter& p = parameters[at_value];
    double c = coefficients(k);
    if (c == 0.0) c = kScreen.first_strength;
    const double unit = points[i][at_value] - off[at_value];
    found.values[at_value] = std::clamp(off[at_value] + c * unit, p.low, p.high);
    found.strengths.push_back({at_value, unit, rest.a(k, k)});
  }
  out.starts.push_back(std::move(found));
}

}  // namespace

Structure plus(const Structure& structure, std::string_view effect) {
  Structure out = structure;
  out.effects.emplace_back(effect);
  std::ranges::sort(out.effects);
  return out;
}

Structure minus(const Structure& structure, std::string_view effect) {
  Structure out = structure;
  std::erase(out.effects, effect);
  return out;
}

bool contains(const Structure& structure, std::string_view effect) {
  return std::ranges::find(structure.effects, effect) != structure.effects.end();
}

std::vector<double> carried(const std::vector<Parameter>& to, const Solution& from) {
  std::vector<double> out;
  for (const Parameter& p : to) {
    const auto same = std::ranges::find(from.parameters, p.pointer, &Parameter::pointer);
    out.push_back(same == from.parameters.end()
                      ? p.start
                      : from.values[std::size_t(same - from.parameters.begin())]);
  }
  return out;
}

LinearScreen linear_screen(const Residual& residual, const Solution& at, std::string_view effect) {
  const Structure structure = plus(at.structure, effect);
  const auto parameters = residual.problem().parameters(structure);
  const auto values = carried(parameters, at);
  const Block block = block_of(parameters, effect);
  LinearScreen out;
  if (block.count == 0) {  // free per trial: the problem eliminates it
    const Eigen::VectorXd there = residual(structure, values);
    const double gain = robust_loss(at.residual, at.scale) - robust_loss(there, at.scale);
    out.starts.push_back({values, gain, {}});
    out.excited = true;
    out.independent_share = 1.0;
    return out;
  }
  const Projection base(at);
  for (const auto& start : residual.problem().starts(effect, at.residual))
    look_at(residual, at, base, structure, parameters, values, block, start, out);
  std::ranges::stable_sort(out.starts, std::greater<>(), &LinearScreen::Start::gain);
  return out;
}

Solution extend(const Residual& residual, const Solution& at, const LinearScreen& linear_screen,
                std::string_view effect, int tries) {
  core::require(!linear_screen.starts.empty(), "an effect has at least one start");
  Solution found;
  for (std::size_t k = 0; k < linear_screen.starts.size() && int(k) < tries; ++k) {
    Solution now =
        search(residual, plus(at.structure, effect), linear_screen.starts[k].values, &at);
    if (k == 0 || now.loss / now.scale < found.loss / found.scale) found = std::move(now);
  }
  return found;
}

}  // namespace lab
}  // namespace tractus
