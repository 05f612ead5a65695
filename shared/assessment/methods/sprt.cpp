/// Is a trainee adequate or not? Wald's sequential test over the order of trials.
#include <fmt/format.h>

#include <algorithm>

#include "assessment/report.hpp"
#include "assessment/sequences.hpp"
#include "core/try.hpp"
#include "statistics/learning/cusum.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using statistics::Sprt;

const char* name_of(Sprt::Verdict verdict) {
  if (verdict == Sprt::Verdict::undecided) return "not decided";
  return verdict == Sprt::Verdict::adequate ? "adequate" : "inadequate";
}

plot::Figure picture(const std::vector<Sequence>& persons, const statistics::Rates& rates,
                     const statistics::SprtBounds& bounds) {
  plot::Panel panel{
      "",
      "trial",
      "S",
      "",
      {},
      {},
      {},
      {},
      {{bounds.upper, "inadequate", "#b3261e"}, {bounds.lower, "adequate", "#2e7d32"}},
      false,
      300};
  for (std::size_t j = 0; j < std::min<std::size_t>(persons.size(), 12); ++j) {
    plot::Line line{persons[j].name, {0.0}, {0.0}, ""};
    for (const double s : statistics::sprt(persons[j].failures, rates, bounds).sums) {
      line.x.push_back(static_cast<double>(line.x.size()));
      line.y.push_back(s);
    }
    panel.lines.push_back(std::move(line));
  }
  return {"", 700, 1, {panel}, ""};
}

Json row_of(const Sequence& person, const Sprt& test) {
  return {{"person", person.name},
          {"trials", person.failures.size()},
          {"failures", std::ranges::count(person.failures, true)},
          {"sum", test.sums.empty() ? 0.0 : test.sums.back()},
          {"verdict", name_of(test.verdict)},
          {"at_trial", test.decided_at == 0 ? Json(nullptr) : Json(test.decided_at)}};
}

core::Result<Findings> run_sprt(const Analysis& of) {
  const auto order = TRY(single_column(of, "sprt"));
  const auto rates = TRY(statistics::Rates::make(of.number("adequate"), of.number("inadequate")));
  const auto persons = TRY(sequences_of(of, order));
  const auto bounds = statistics::sprt_bounds(of.number("alpha"), of.number("beta"));
  Json out = report_head(of, "sequential probability ratio test");
  std::size_t longest = 1, open = 0;
  out["persons"] = Json::array();
  for (const auto& person : persons) {
    const Sprt test = statistics::sprt(person.failures, rates, bounds);
    out["persons"].push_back(row_of(person, test));
    open += test.verdict == Sprt::Verdict::undecided ? 1u : 0u;
    longest = std::max(longest, person.failures.size());
  }
  const int trials = static_cast<int>(std::min<std::size_t>(longest, 1000));
  out["bounds"] = {{"inadequate_at", bounds.upper}, {"adequate_at", bounds.lower}};
  out["operating_characteristic"] = Json::array();
  for (const double rate : {rates.adequate, rates.inadequate}) {
    const auto at = statistics::sprt_characteristic(rates, bounds, rate, trials);
    out["operating_characteristic"].push_back({{"failure_rate", rate},
                                               {"trials", trials},
                                               {"called_adequate", at.adequate},
                                               {"called_inadequate", at.inadequate},
                                               {"mean_trials", at.mean_trials}});
  }
  out["notes"] = Json::array();
  if (open > 0)
    out["notes"].push_back(
        fmt::format("{} of {} are not decided within their trials", open, persons.size()));
  return Findings{std::move(out), {picture(persons, rates, bounds)}};
}

}  // namespace

namespace methods {
Method sprt_method() {
  return {"sprt",
          "Adequate or inadequate: Wald's sequential test over the order of trials",
          "failed ~ trial_order + (1|surgeon)",
          "Wald's sequential probability ratio test, with exact operating characteristics",
          {{"response", "what 1 means", "failure", {"failure", "success"}},
           {"adequate", "failure rate of adequate performance", "0.10", {}, 1e-6, 0.999999},
           {"inadequate", "failure rate of inadequate performance", "0.25", {}, 1e-6, 0.999999},
           {"alpha", "chance of calling adequate inadequate", "0.05", {}, 1e-6, 0.49},
           {"beta", "chance of calling inadequate adequate", "0.20", {}, 1e-6, 0.49}},
          run_sprt};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
