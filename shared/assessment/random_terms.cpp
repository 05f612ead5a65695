#include "assessment/random_terms.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/try.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using statistics::RandomPart;

constexpr std::size_t kMostLevelsListed = 200;

/// The level of each row: its cells of the grouping's columns, joined.
std::vector<std::string> labels_of(const Table& table, const RandomEffects& effects) {
  std::vector<std::string> out(table.texts(effects.columns[0]).size());
  for (const auto& column : effects.columns) {
    const auto& cells = table.texts(column);
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] += (&column == &effects.columns[0] ? "" : ":") + std::string(cells[i]);
  }
  return out;
}

core::Result<statistics::RandomTerm> random_term(const Analysis& of, const RandomEffects& effects) {
  statistics::RandomTerm out{
      .group = effects.group(), .labels = labels_of(of.table, effects), .columns = {}, .names = {}};
  const auto rows = std::ssize(out.labels);
  out.columns.resize(rows, std::ssize(effects.slopes) + (effects.intercept ? 1 : 0));
  if (effects.intercept) {
    out.columns.col(0).setOnes();
    out.names.push_back("(Intercept)");
  }
  for (const auto& slope : effects.slopes) {
    TRY(of.table.holds_numbers(slope));
    out.columns.col(std::ssize(out.names)) = TRY(of.table.numbers(slope));
    out.names.push_back(slope);
  }
  return out;
}

Json spread_table(const std::vector<RandomPart>& parts) {
  Json out = Json::array();
  for (const auto& part : parts)
    for (Eigen::Index r = 0; r < part.covariance.rows(); ++r)
      for (Eigen::Index c = 0; c <= r; ++c) {
        const double own = part.covariance(r, c);
        const double scale = std::sqrt(part.covariance(r, r) * part.covariance(c, c));
        const auto& names = part.names;
        out.push_back(
            {{"group", part.group},
             {"effect", r == c ? names[std::size_t(r)]
                               : names[std::size_t(c)] + " with " + names[std::size_t(r)]},
             {"levels", part.levels.size()},
             {"covariance", own},
             {"standard_deviation", r == c ? Json(std::sqrt(own)) : Json()},
             {"correlation", r != c && scale > 0.0 ? Json(own / scale) : Json()}});
      }
  return out;
}

Json prediction_table(const std::vector<RandomPart>& parts) {
  Json out = Json::array();
  for (const auto& part : parts) {
    if (part.levels.size() > kMostLevelsListed) continue;
    for (std::size_t level = 0; level < part.levels.size(); ++level)
      for (std::size_t e = 0; e < part.names.size(); ++e)
        out.push_back({{"name", part.levels[level]},
                       {"group", part.group},
                       {"of", part.names[e]},
                       {"effect", part.effects(Eigen::Index(level), Eigen::Index(e))}});
  }
  return out;
}

}  // namespace

core::Result<std::vector<statistics::RandomTerm>> random_terms(const Analysis& of) {
  std::vector<statistics::RandomTerm> out;
  for (const auto& effects : of.formula.random) {
    auto term = TRY(random_term(of, effects));
    out.push_back(std::move(term));
  }
  return out;
}

void add_random_effects(const std::vector<RandomPart>& parts, Json& out) {
  out["random_effects"] = spread_table(parts);
  out["group_effects"] = prediction_table(parts);
}

Json random_notes(const std::vector<RandomPart>& parts, bool converged) {
  Json out = Json::array();
  for (const auto& part : parts) {
    if (part.singular)
      out.push_back(
          fmt::format("singular: the data do not support all random effects of {} (a "
                      "variance of 0, or a correlation of 1); a simpler term says the "
                      "same",
                      part.group));
    if (part.levels.size() < 6)
      out.push_back(fmt::format("{} levels of {} say little about the spread between them",
                                part.levels.size(), part.group));
  }
  if (!converged) out.push_back("the criterion's minimum was not reached to all digits");
  return out;
}

}  // namespace assessment
}  // namespace tractus
