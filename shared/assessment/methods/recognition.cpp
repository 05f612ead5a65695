/// Signal detection: hits and false alarms, pooled and by person.
#include <fmt/format.h>

#include <cmath>

#include "assessment/counts.hpp"
#include "assessment/report.hpp"
#include "core/try.hpp"
#include "statistics/agreement/signal_detection.hpp"
#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using statistics::Proportion;
using statistics::SignalDetection;

/// Answers about trials with a breach, and without.
struct Answers {
  Proportion hits, false_alarms;
};

Answers answers_of(const std::vector<std::size_t>& rows, const std::vector<bool>& said,
                   const std::vector<bool>& truth) {
  Answers out;
  for (const std::size_t i : rows) {
    Proportion& of = truth[i] ? out.hits : out.false_alarms;
    of.trials += 1.0;
    of.successes += said[i] ? 1.0 : 0.0;
  }
  return out;
}

statistics::RateCorrection correction_of(const std::string& name) {
  if (name == "none") return statistics::RateCorrection::none;
  return name == "extremes" ? statistics::RateCorrection::extremes
                            : statistics::RateCorrection::log_linear;
}

Json block(const Answers& of, const SignalDetection& fit) {
  return {{"hits", of.hits.successes},
          {"signals", of.hits.trials},
          {"false_alarms", of.false_alarms.successes},
          {"blanks", of.false_alarms.trials},
          {"hit_rate", fit.hit_rate},
          {"false_alarm_rate", fit.false_alarm_rate},
          {"d_prime", fit.d_prime},
          {"d_prime_ci95_low", fit.d_prime_95.low},
          {"d_prime_ci95_high", fit.d_prime_95.high},
          {"criterion", fit.criterion},
          {"ln_beta", fit.ln_beta},
          {"a_prime", fit.a_prime},
          {"auc", fit.auc}};
}

/// A t test of the persons' d′: what answers of the same person do to the pooled interval.
void add_mean(const std::vector<double>& each, Json& out) {
  if (each.size() < 2) return;
  const auto n = static_cast<double>(each.size());
  const statistics::Vector v = Eigen::Map<const statistics::Vector>(each.data(), std::ssize(each));
  const double mean = v.mean();
  const double se = std::sqrt((v.array() - mean).square().sum() / (n - 1.0) / n);
  const double reach = statistics::student_t_quantile(0.975, n - 1.0) * se;
  out["mean_over_persons"] = {{"persons", each.size()},
                              {"d_prime", mean},
                              {"ci95_low", mean - reach},
                              {"ci95_high", mean + reach}};
  if (!(se > 0.0)) return;
  out["tests"].push_back(Test{"d' over persons", "t", mean / se, 0, n - 1.0,
                              statistics::student_t_two_sided(mean / se, n - 1.0), "d'", mean,
                              mean - reach, mean + reach}
                             .to_json());
}

core::Result<void> add_persons(const Analysis& of, const std::vector<bool>& said,
                               const std::vector<bool>& truth,
                               statistics::RateCorrection correction, Json& out) {
  const Parts parts = parts_of(of.table, of.formula.group);
  std::vector<double> each;
  Json rows = Json::array();
  for (std::size_t j = 0; j < parts.names.size(); ++j) {
    const Answers own = answers_of(parts.rows[j], said, truth);
    if (own.hits.trials == 0.0 || own.false_alarms.trials == 0.0) {
      out["notes"].push_back(fmt::format(
          "{} '{}' has no trial {} a breach and is left out of the mean", of.formula.group,
          parts.names[j], own.hits.trials == 0.0 ? "with" : "without"));
      continue;
    }
    const auto fit = statistics::signal_detection(own.hits, own.false_alarms, correction);
    if (!fit) return located(of, {fit.error().code, parts.names[j] + ": " + fit.error().what});
    each.push_back(fit->d_prime);
    rows.push_back({{"person", parts.names[j]},
                    {"hits", own.hits.successes},
                    {"signals", own.hits.trials},
                    {"false_alarms", own.false_alarms.successes},
                    {"blanks", own.false_alarms.trials},
                    {"d_prime", fit->d_prime},
                    {"criterion", fit->criterion}});
  }
  out["persons"] = rows;
  add_mean(each, out);
  return {};
}

core::Result<Findings> run_recognition(const Analysis& of) {
  if (of.formula.terms.size() != 1 || of.formula.terms[0].variables.size() != 1)
    return core::bad_input("recognition compares an answer with the truth: write said ~ breach");
  const auto said = TRY(yes_no(of.table, of.formula.response));
  const auto truth = TRY(yes_no(of.table, of.formula.terms[0].variables[0].column));
  const auto correction = correction_of(of.text("correction"));
  std::vector<std::size_t> all(of.table.rows());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  const Answers answers = answers_of(all, said, truth);
  if (answers.hits.trials == 0.0 || answers.false_alarms.trials == 0.0)
    return core::bad_input(fmt::format("{}: there is no row {} a breach: d' needs both",
                                       of.table.name(),
                                       answers.hits.trials == 0.0 ? "with" : "without"));
  const auto fit = statistics::signal_detection(answers.hits, answers.false_alarms, correction);
  if (!fit) return located(of, fit.error());
  Json out = report_head(of, "signal detection, equal variances");
  out["pooled"] = block(answers, *fit);
  const double z = fit->d_prime / std::sqrt(fit->variance);
  out["tests"] =
      Json::array({Test{"d' pooled", "z", z, 0, 0, 2.0 * statistics::normal_upper(std::abs(z)),
                        "d'", fit->d_prime, fit->d_prime_95.low, fit->d_prime_95.high}
                       .to_json()});
  out["notes"] = {fmt::format(
      "with {:.0f} signals and {:.0f} blanks d' cannot exceed {:.2f} after the log-linear "
      "correction",
      answers.hits.trials, answers.false_alarms.trials,
      statistics::normal_quantile((answers.hits.trials + 0.5) / (answers.hits.trials + 1.0)) +
          statistics::normal_quantile((answers.false_alarms.trials + 0.5) /
                                      (answers.false_alarms.trials + 1.0)))};
  if (of.formula.group.empty()) return Findings{std::move(out), {}};
  TRY(add_persons(of, said, truth, correction, out));
  return Findings{std::move(out), {}};
}

}  // namespace

namespace methods {
Method recognition_method() {
  return {"recognition",
          "Signal detection: d', criterion, AUC of said against true breaches",
          "said_breach ~ true_breach + (1|surgeon)",
          "signal detection theory with equal variances and Hautus' log-linear correction; the "
          "variance of d' after Gourevitch and Galanter 1967",
          {{"correction", "of rates of 0 and 1", "log-linear", {"log-linear", "extremes", "none"}}},
          run_recognition};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
