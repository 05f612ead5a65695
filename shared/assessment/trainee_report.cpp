#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assessment/page.hpp"
#include "assessment/pictures.hpp"
#include "assessment/trainee.hpp"
#include "statistics/distributions/distributions.hpp"
#include "statistics/distributions/proportions.hpp"
#include "statistics/learning/learning_curve.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using statistics::Vector;

std::vector<Tally> tallies(const Cohort& cohort, const std::vector<Attempt>& attempts) {
  std::vector<Tally> out(cohort.scenarios.size());
  for (std::size_t t = 0; t < attempts.size(); ++t) {
    Tally& own = out[attempts[t].scenario];
    own.trials += 1.0;
    own.right += attempts[t].right ? 1.0 : 0.0;
    own.last = t + 1;
  }
  return out;
}

/// What an interval says against the rates of adequate and inadequate performance.
const char* verdict(const statistics::Interval& share, const statistics::Rates& rates) {
  if (share.low >= 1.0 - rates.inadequate) return "strength";
  if (share.high < 1.0 - rates.adequate) return "weakness";
  return "not known yet";
}

Json scenario_table(const Cohort& cohort, const std::vector<Tally>& of,
                    const statistics::Rates& rates) {
  Json out = Json::array();
  for (std::size_t s = 0; s < of.size(); ++s) {
    Json row = {{"scenario", cohort.scenarios[s]},
                {"trials", static_cast<long>(of[s].trials)},
                {"right", static_cast<long>(of[s].right)}};
    if (of[s].trials > 0.0) {
      const auto share = statistics::wilson({of[s].right, of[s].trials});
      row["share"] = of[s].right / of[s].trials;
      row["wilson_low"] = share.low;
      row["wilson_high"] = share.high;
      row["verdict"] = verdict(share, rates);
      row["last_trial"] = of[s].last;
    } else {
      row["verdict"] = "never done";
    }
    row["may_fail"] = may_fail(of[s]);
    out.push_back(std::move(row));
  }
  return out;
}

Json next_case(const Cohort& cohort, const std::vector<Tally>& of) {
  const std::size_t best = next_of(of);
  return {{"scenario", cohort.scenarios[best]},
          {"why",
           fmt::format("{:.0f} of {:.0f} right so far: the failure rate may be as high as {:.0f} % "
                       "(90 % point), higher than of any other scenario",
                       of[best].right, of[best].trials, 100.0 * may_fail(of[best]))}};
}

/// The score of a trainee over trials, as a share of the cohort's mean of each trial's scenario,
/// with the power curve where one can be laid through.
Json score_learning(const Cohort& cohort, const std::vector<Attempt>& attempts, std::size_t k,
                    std::vector<plot::Figure>& figures) {
  const std::string& name = cohort.scores[k];
  std::vector<double> n, y;
  for (std::size_t t = 0; t < attempts.size(); ++t) {
    const double share = attempts[t].scores[k] / cohort.means[k][attempts[t].scenario];
    if (!std::isfinite(share)) continue;
    n.push_back(static_cast<double>(t + 1));
    y.push_back(share);
  }
  Json out = {{"score", name}, {"trials", n.size()}};
  if (n.empty()) return out;
  const Vector trial = Eigen::Map<Vector>(n.data(), std::ssize(n));
  const Vector score = Eigen::Map<Vector>(y.data(), std::ssize(y));
  plot::Panel panel{name,  "trial", "share of the scenario's mean", "", {}, {}, {}, {}, {},
                    false, 220};
  panel.lines.push_back(crosses("", trial, score));
  const auto fit = statistics::learning_curve(trial, score, statistics::CurveShape::power);
  if (fit) {
    out["first"] = fit->coefficients[0];
    out["rate"] = fit->coefficients[1];
    out["rate_p"] = fit->p[1];
    out["share_left_when_trials_double"] = statistics::share_per_doubling(*fit);
    plot::Line line{"y = a n^-b", {}, {}, "#b3261e", 1.5};
    for (double t = 1.0; t <= n.back(); t += std::max(0.1, n.back() / 200.0)) {
      line.x.push_back(t);
      line.y.push_back(fit->coefficients[0] * std::pow(t, -fit->coefficients[1]));
    }
    panel.lines.push_back(std::move(line));
  } else {
    out["note"] = fit.error().what;
  }
  figures.push_back({"", 620, 1, {panel}, ""});
  return out;
}

plot::Figure sums_picture(const Standing& of, double threshold, double relapse) {
  plot::Panel up{"Towards competence (LC-CUSUM)",       "trial", "sum", "", {}, {}, {}, {},
                 {{threshold, "competent", "#2e7d32"}}, false,   200};
  plot::Line line{"", {0.0}, {0.0}, "#1b4f8f", 1.6};
  for (std::size_t t = 0; t < of.sums.size(); ++t) {
    line.x.push_back(static_cast<double>(t + 1));
    line.y.push_back(of.sums[t]);
  }
  up.lines.push_back(line);
  plot::Figure out{"", 700, 1, {up}, ""};
  if (of.signalled_at == 0) return out;
  plot::Panel down{"Watch for relapse (CUSUM from the signal on)",
                   "trial",
                   "sum",
                   "",
                   {},
                   {},
                   {},
                   {},
                   {{relapse, "relapse", "#b3261e"}},
                   false,
                   200};
  plot::Line after{"", {static_cast<double>(of.signalled_at)}, {0.0}, "#1b4f8f", 1.6};
  for (std::size_t t = 0; t < of.relapse_sums.size(); ++t) {
    after.x.push_back(static_cast<double>(of.signalled_at + t + 1));
    after.y.push_back(of.relapse_sums[t]);
  }
  down.lines.push_back(after);
  out.panels.push_back(down);
  return out;
}

Json relapses_json(const std::vector<Relapse>& relapses) {
  Json out = Json::array();
  for (const auto& [at, recovered_at] : relapses)
    out.push_back({{"at_trial", at},
                   {"recovered_at_trial", recovered_at ? Json(recovered_at) : Json(nullptr)}});
  return out;
}

/// Chance that somebody inadequate is declared competent within so many trials.
double risk_within(std::size_t trials, double threshold, const Certification& rule) {
  if (threshold == rule.threshold && trials >= 1 && trials <= rule.passes_if_inadequate.size())
    return rule.passes_if_inadequate[trials - 1];
  return statistics::lc_cusum_characteristic(
             rule.rates, threshold, rule.rates.inadequate,
             static_cast<int>(std::clamp<std::size_t>(trials, 1, 1000)))
      .signalled_by.back();
}

/// Why too few trials certify nobody.
std::string too_few(std::size_t trials, const Certification& rule) {
  const auto shown = std::max<std::size_t>(trials, 1);
  return fmt::format(
      "{} trials are too few to certify anybody: {} are needed (h = {:.2f}: passed by {:.0f} % of "
      "those who fail {:.0f} %, by {:.0f} % of those who fail {:.0f} %); a laxer h = 1.25 would "
      "pass {:.0f} % of the latter within {} trials",
      trials, rule.trials, rule.threshold,
      100.0 * rule.passes_if_adequate[static_cast<std::size_t>(rule.trials - 1)],
      100.0 * rule.rates.adequate,
      100.0 * rule.passes_if_inadequate[static_cast<std::size_t>(rule.trials - 1)],
      100.0 * rule.rates.inadequate, 100.0 * risk_within(shown, 1.25, rule), shown);
}

}  // namespace

double may_fail(const Tally& of) {
  return statistics::beta_quantile(0.9, 0.5 + of.trials - of.right, 0.5 + of.right);
}

std::size_t next_of(const std::vector<Tally>& of) {
  std::size_t best = 0;
  for (std::size_t s = 1; s < of.size(); ++s) {
    const double here = may_fail(of[s]), there = may_fail(of[best]);
    if (here > there + 1e-12 || (here > there - 1e-12 && of[s].last < of[best].last)) best = s;
  }
  return best;
}

Competence competence(const Standing& of, std::size_t trials, double threshold,
                      const Certification& rule) {
  if (rule.trials == 0)
    return {false,
            fmt::format("no number of trials up to 400 tells failure rates of {:.0f} % and {:.0f} "
                        "% apart well enough to certify",
                        100.0 * rule.rates.adequate, 100.0 * rule.rates.inadequate)};
  const bool few = static_cast<int>(trials) < rule.trials;
  if (few && (of.state == Standing::State::learning || threshold < rule.threshold))
    return {false, too_few(trials, rule)};
  if (of.state == Standing::State::relapsed)
    return {false, fmt::format("competent at trial {}, relapsed at trial {}", of.signalled_at,
                               of.relapses.back().at)};
  if (of.state == Standing::State::learning)
    return {false, fmt::format("no signal of competence in {} trials", trials)};
  const double risk = risk_within(of.signalled_at, threshold, rule);
  const std::string chance = fmt::format(
      "somebody who fails {:.0f} % reaches h = {:.2f} within {} trials with a chance of "
      "{:.3f}",
      100.0 * rule.rates.inadequate, threshold, of.signalled_at, risk);
  if (risk > rule.risk) return {false, chance + fmt::format(", more than {:.2f}", rule.risk)};
  const std::string recovered =
      of.relapses.empty() ? ""
                          : fmt::format("; relapsed at trial {}, recovered at trial {}",
                                        of.relapses.back().at, of.relapses.back().recovered_at);
  return {true, fmt::format("signal at trial {}{}; {}", of.signalled_at, recovered, chance)};
}

TraineeReport trainee_report(const Cohort& cohort, std::size_t trainee, const Certification& rule,
                             const TraineeRules& rules) {
  const auto& attempts = cohort.attempts[trainee];
  const double threshold = rules.threshold.value_or(rule.trials > 0 ? rule.threshold : 2.0);
  const Standing of = standing(attempts, rules.rates, threshold, rules.relapse);
  const auto counts = tallies(cohort, attempts);
  double right = 0.0;
  for (const auto& own : counts) right += own.right;
  const auto trials = static_cast<double>(attempts.size());
  const auto share = statistics::wilson({right, trials});
  const auto [sure, why] = competence(of, attempts.size(), threshold, rule);
  TraineeReport out;
  out.report = {{"format", "tractus-trainee/1"},
                {"trainee", cohort.trainees[trainee]},
                {"trials", attempts.size()},
                {"right", static_cast<long>(right)},
                {"share", right / trials},
                {"wilson_low", share.low},
                {"wilson_high", share.high},
                {"state", name_of(of.state)},
                {"certified", sure},
                {"why", why},
                {"trials_needed", rule.trials == 0 ? Json(nullptr) : Json(rule.trials)},
                {"threshold", threshold},
                {"competent_at_trial", of.signalled_at ? Json(of.signalled_at) : Json(nullptr)},
                {"relapses", relapses_json(of.relapses)},
                {"lc_cusum", of.sums},
                {"scenarios", scenario_table(cohort, counts, rules.rates)},
                {"next", next_case(cohort, counts)},
                {"scores", Json::array()}};
  out.figures.push_back(sums_picture(of, threshold, rules.relapse));
  for (std::size_t k = 0; k < cohort.scores.size(); ++k)
    out.report["scores"].push_back(score_learning(cohort, attempts, k, out.figures));
  return out;
}

std::string trainee_page(const TraineeReport& of, bool simulated) {
  const Json& r = of.report;
  Page page(r["trainee"].get<std::string>());
  if (simulated) page.warning("These trials are simulated.");
  page.paragraph(
      fmt::format("{} of {} trials right ({:.0f} %, 95 % interval {:.0f} to {:.0f} %). "
                  "State: {}.",
                  r["right"].get<long>(), r["trials"].get<long>(), 100.0 * r["share"].get<double>(),
                  100.0 * r["wilson_low"].get<double>(), 100.0 * r["wilson_high"].get<double>(),
                  r["state"].get<std::string>()));
  const std::string why = r["why"];
  if (r["certified"] == true)
    page.paragraph("Competence can be certified: " + why + ".");
  else
    page.warning("Competence cannot be certified: " + why + ".");
  page.heading("Next case");
  page.paragraph(r["next"]["scenario"].get<std::string>() + ": " +
                 r["next"]["why"].get<std::string>() + ".");
  page.heading("Competence over trials");
  page.figure(of.figures[0]);
  page.heading("Scenarios");
  page.table(r["scenarios"]);
  page.small(
      "strength: the interval's low end is above the share of inadequate performance; weakness: "
      "its "
      "high end is below that of adequate performance; may fail: 90 % point of the failure rate.");
  if (!r["scores"].empty()) {
    page.heading("Learning");
    for (std::size_t k = 1; k < of.figures.size(); ++k) page.figure(of.figures[k]);
    page.table(r["scores"]);
  }
  return page.html();
}

}  // namespace assessment
}  // namespace tractus
