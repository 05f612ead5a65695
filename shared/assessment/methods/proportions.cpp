/// Proportions with intervals, by group; differences of pairs.
#include "statistics/distributions/proportions.hpp"

#include <fmt/format.h>

#include "assessment/counts.hpp"
#include "assessment/report.hpp"
#include "core/try.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using statistics::Proportion;

constexpr std::size_t kMostPairs = 20;

Json row_of(const std::string& name, const Proportion& of, double level) {
  const auto w = statistics::wilson(of, level), exact = statistics::clopper_pearson(of, level);
  return {{"group", name},
          {"successes", of.successes},
          {"trials", of.trials},
          {"share", of.share()},
          {"wilson_low", w.low},
          {"wilson_high", w.high},
          {"clopper_pearson_low", exact.low},
          {"clopper_pearson_high", exact.high}};
}

Json pair_row(const Counted& a, const Counted& b, double level) {
  const auto d = statistics::newcombe_difference(b.of, a.of, level);
  return {{"pair", b.name + "-" + a.name},
          {"difference", b.of.share() - a.of.share()},
          {"newcombe_low", d.low},
          {"newcombe_high", d.high},
          {"fisher_p", statistics::fisher_exact(b.of, a.of)}};
}

void add_pairs(const std::vector<Counted>& groups, double level, Json& out) {
  out["pairs"] = Json::array();
  for (std::size_t a = 0; a < groups.size(); ++a)
    for (std::size_t b = a + 1; b < groups.size(); ++b) {
      const Json row = pair_row(groups[a], groups[b], level);
      out["tests"].push_back(Test{
          row["pair"], "exact", row["difference"].get<double>(), 0, 0,
          row["fisher_p"].get<double>(), "difference of shares", row["difference"].get<double>(),
          row["newcombe_low"].get<double>(), row["newcombe_high"].get<double>()}
                                 .to_json());
      out["pairs"].push_back(row);
    }
}

core::Result<Findings> run_proportions(const Analysis& of) {
  const auto groups = TRY(counted_groups(of));
  const double level = of.number("level");
  Json out = report_head(of, "proportions with intervals");
  out["proportions"] = Json::array();
  Proportion all;
  for (const auto& group : groups) {
    out["proportions"].push_back(row_of(group.name, group.of, level));
    all.successes += group.of.successes;
    all.trials += group.of.trials;
  }
  if (groups.size() > 1) out["proportions"].push_back(row_of("all", all, level));
  const double chance = of.number("chance");
  const double p = statistics::binomial_test(all, chance);
  const auto w = statistics::wilson(all);
  out["against_chance"] = {{"chance", chance}, {"p_exact_binomial", p}};
  out["tests"] = Json::array(
      {Test{"all", "exact", all.share(), 0, 0, p, "share", all.share(), w.low, w.high}.to_json()});
  out["notes"] = {
      "intervals take answers as independent; with several answers of each person they are too "
      "narrow: logistic with (1|person) does not"};
  if (groups.size() > 1 && groups.size() <= kMostPairs) add_pairs(groups, level, out);
  return Findings{std::move(out), {}};
}

}  // namespace

namespace methods {
Method proportions_method() {
  return {
      "proportions",
      "Shares of right answers with Wilson, exact and Newcombe intervals",
      "correct ~ scenario   (or wrong/trials ~ 1)",
      "proportions with Wilson intervals (Clopper-Pearson beside them), differences with "
      "Newcombe's interval and Fisher's exact test, the whole against chance by the exact "
      "binomial test",
      {{"level", "confidence level of the intervals", "0.95", {}, 0.5, 0.9999},
       {"chance", "share expected by guessing, for the exact binomial test", "0.5", {}, 0.0, 1.0}},
      run_proportions};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
