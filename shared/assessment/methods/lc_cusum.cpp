/// When is a trainee competent, and has it lapsed? LC-CUSUM and CUSUM over the order of trials.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assessment/report.hpp"
#include "assessment/sequences.hpp"
#include "core/try.hpp"
#include "statistics/learning/cusum.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using statistics::Vector;

/// The first trial (1-based) at which `sums` reach `threshold`; 0: none.
Json person_row(const Sequence& person, const statistics::Rates& rates, double h, double relapse) {
  const auto up = statistics::lc_cusum(person.failures, rates);
  const std::size_t signal = statistics::first_at(up, h);
  // Watched for relapse from the signal on, from 0.
  const std::vector<bool> after(person.failures.begin() + static_cast<std::ptrdiff_t>(signal),
                                person.failures.end());
  const std::size_t alarm =
      signal == 0 ? 0
                  : statistics::first_at(statistics::deterioration_cusum(after, rates), relapse);
  return {{"person", person.name},
          {"trials", person.failures.size()},
          {"failures", std::ranges::count(person.failures, true)},
          {"lc_cusum", up.empty() ? 0.0 : up.back()},
          {"competent_at_trial", signal == 0 ? Json(nullptr) : Json(signal)},
          {"relapse_at_trial", alarm == 0 ? Json(nullptr) : Json(signal + alarm)}};
}

plot::Figure picture(const std::vector<Sequence>& persons, const statistics::Rates& rates,
                     double h) {
  plot::Panel panel{"",    "trial", "LC-CUSUM", "", {}, {}, {}, {}, {{h, "competent", "#2e7d32"}},
                    false, 300};
  for (std::size_t j = 0; j < std::min<std::size_t>(persons.size(), 12); ++j) {
    plot::Line line{persons[j].name, {0.0}, {0.0}, ""};
    for (const double s : statistics::lc_cusum(persons[j].failures, rates)) {
      line.x.push_back(static_cast<double>(line.x.size()));
      line.y.push_back(s);
    }
    panel.lines.push_back(std::move(line));
  }
  return {"", 700, 1, {panel}, ""};
}

core::Result<Findings> run_lc_cusum(const Analysis& of) {
  const auto order = TRY(single_column(of, "lc-cusum"));
  const auto rates = TRY(statistics::Rates::make(of.number("adequate"), of.number("inadequate")));
  const auto persons = TRY(sequences_of(of, order));
  const double h = of.number("threshold"), relapse = of.number("relapse");
  Json out = report_head(of, "learning-curve CUSUM");
  std::size_t longest = 1;
  out["persons"] = Json::array();
  for (const auto& person : persons) {
    out["persons"].push_back(person_row(person, rates, h, relapse));
    longest = std::max(longest, person.failures.size());
  }
  const int trials = static_cast<int>(std::min<std::size_t>(longest, 1000));
  const auto at = [&](double rate) {
    return statistics::lc_cusum_characteristic(rates, h, rate, trials);
  };
  const auto good = at(rates.adequate), bad = at(rates.inadequate);
  out["operating_characteristic"] = {{"trials", trials},
                                     {"threshold", h},
                                     {"declared_competent_if_adequate", good.signalled_by.back()},
                                     {"declared_competent_if_inadequate", bad.signalled_by.back()},
                                     {"mean_trials_to_signal_if_adequate", good.mean_run_length}};
  out["notes"] = Json::array();
  if (bad.signalled_by.back() > 0.05)
    out["notes"].push_back(fmt::format(
        "within {} trials somebody who fails {:.0f} % would be declared competent with probability "
        "{:.3f}: too high to certify by",
        trials, 100.0 * rates.inadequate, bad.signalled_by.back()));
  return Findings{std::move(out), {picture(persons, rates, h)}};
}

}  // namespace

namespace methods {
Method lc_cusum_method() {
  return {"lc-cusum",
          "When somebody became competent, and when it lapsed",
          "failed ~ trial_order + (1|surgeon)",
          "the learning-curve cumulative sum of Biau and Porcher 2010, with exact operating "
          "characteristics, and Page's cumulative sum for relapse after it",
          {{"response", "what 1 means", "failure", {"failure", "success"}},
           {"adequate", "failure rate of adequate performance", "0.10", {}, 1e-6, 0.999999},
           {"inadequate", "failure rate of inadequate performance", "0.25", {}, 1e-6, 0.999999},
           {"threshold", "h at which competence is signalled", "1.25", {}, 1e-3, 100},
           {"relapse", "sum at which relapse is signalled", "1.25", {}, 1e-3, 100}},
          run_lc_cusum};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
