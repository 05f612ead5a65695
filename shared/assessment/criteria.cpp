#include "assessment/criteria.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/try.hpp"
#include "metrics/metric.hpp"
#include "statistics/distributions/proportions.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using core::name;

constexpr const char* kFormat = "tractus-criteria/1";
constexpr std::size_t kMostRequirements = 12;
constexpr long kMostLooked = 1000;
constexpr double kLargest = 1e12;
constexpr double kRelapse = 1.25;

const metrics::MetricInfo* metric_of(const std::string& id) {
  static const auto known = metrics::all();
  const auto at = std::ranges::find(known, id, &metrics::MetricInfo::id);
  return at == known.end() ? nullptr : &*at;
}

/// Lengths in millimetres, as a surgeon reads them; the rest in its own unit.
std::string value_text(double value, const std::string& unit) {
  if (unit == "m") return fmt::format("{:.4g} mm", 1000.0 * value);
  if (unit == "m/s") return fmt::format("{:.4g} mm/s", 1000.0 * value);
  return unit == "1" ? fmt::format("{:.4g}", value) : fmt::format("{:.4g} {}", value, unit);
}

void read_metric(core::Fields& fields, Requirement& out) {
  out.metric = fields.text("metric", 64);
  if (!metric_of(out.metric)) fields.wrong("metric", "there is no such metric");
  out.side = fields.word<Side>("side");
  out.bound = fields.number("bound", -kLargest, kLargest);
  out.times = std::size_t(fields.integer_or("times", 1, 1, kMostLooked));
  out.last = std::size_t(fields.integer_or("last", long(out.times), 0, kMostLooked));
  if (out.last != 0 && out.last < out.times)
    fields.wrong("last", "at least as many trials as must keep the bound are expected");
}

void read_recognition(core::Fields& fields, Requirement& out) {
  out.share = fields.number("share", 0.01, 0.999);
  out.level = fields.number_or("level", 0.95, 0.5, 0.999);
  out.last = std::size_t(fields.integer_or("last", 0, 0, kMostLooked));
}

void read_rates(core::Fields& fields, Requirement& out) {
  const statistics::Rates usual;
  const auto rates =
      statistics::Rates::make(fields.number_or("adequate", usual.adequate, 0.001, 0.999),
                              fields.number_or("inadequate", usual.inadequate, 0.001, 0.999));
  if (rates)
    out.rates = *rates;
  else
    fields.wrong("inadequate", rates.error().what);
}

core::Result<Requirement> requirement_from(const Json& json, const std::string& where) {
  core::Fields fields(json, where);
  Requirement out;
  out.kind = fields.word<RequirementKind>("kind");
  if (out.kind == RequirementKind::metric) read_metric(fields, out);
  if (out.kind == RequirementKind::recognition) read_recognition(fields, out);
  if (out.kind == RequirementKind::lc_cusum) read_rates(fields, out);
  out.basis = fields.text_or("basis", "", 400);
  TRY(fields.done());
  return out;
}

Json json_of(const Requirement& of) {
  Json out{{"kind", name(of.kind)}};
  switch (of.kind) {
    case RequirementKind::metric:
      out.update(Json{{"metric", of.metric},
                      {"side", name(of.side)},
                      {"bound", of.bound},
                      {"times", of.times},
                      {"last", of.last}});
      break;
    case RequirementKind::recognition:
      out.update(Json{{"share", of.share}, {"level", of.level}, {"last", of.last}});
      break;
    case RequirementKind::lc_cusum:
      out.update(Json{{"adequate", of.rates.adequate}, {"inadequate", of.rates.inadequate}});
      break;
  }
  out["basis"] = of.basis;
  return out;
}

/// The last `most` values, or all for 0.
template <class T>
std::span<const T> last_of(const std::vector<T>& values, std::size_t most) {
  const std::span<const T> all(values);
  return most == 0 || most >= all.size() ? all : all.last(most);
}

RequirementVerdict judge_metric(const Requirement& of, std::span<const JudgedTrial> trials) {
  std::vector<double> values;
  for (const JudgedTrial& trial : trials)
    if (const auto at = trial.metrics.find(of.metric); at != trial.metrics.end())
      values.push_back(at->second);
  const auto last = last_of(values, of.last);
  const auto kept = std::size_t(std::ranges::count_if(last, [&](double value) {
    return of.side == Side::at_most ? value <= of.bound : value >= of.bound;
  }));
  return {kept >= of.times, text_of(of), fmt::format("{} of {}", kept, last.size())};
}

std::vector<char> answers_in(std::span<const JudgedTrial> trials) {
  std::vector<char> out;
  for (const JudgedTrial& trial : trials)
    if (trial.right) out.push_back(*trial.right);
  return out;
}

RequirementVerdict judge_recognition(const Requirement& of, std::span<const JudgedTrial> trials) {
  const auto answers = answers_in(trials);
  const auto last = last_of(answers, of.last);
  if (last.empty()) return {false, text_of(of), "no answer yet"};
  const double right = double(std::ranges::count(last, char(true)));
  const double low = statistics::wilson({right, double(last.size())}, of.level).low;
  return {low >= of.share, text_of(of),
          fmt::format("{:.0f} of {} right, low end {:.1f} %", right, last.size(), 100.0 * low)};
}

/// @param explained  false: only whether it is met, which costs less.
RequirementVerdict judge_rates(const Requirement& of, std::span<const JudgedTrial> trials,
                               bool explained) {
  std::vector<Attempt> attempts;
  for (const char right : answers_in(trials)) attempts.push_back({0.0, right != 0, 0, {}});
  if (attempts.empty()) return {false, text_of(of), "no answer yet"};
  const Certification& rule = usual_certification(of.rates);
  const double threshold = rule.trials > 0 ? rule.threshold : 2.0;
  const Standing where = standing(attempts, of.rates, threshold, kRelapse);
  if (!explained && where.state != Standing::State::competent) return {};
  const Competence said = competence(where, attempts.size(), threshold, rule);
  return {said.certified, text_of(of), said.why};
}

RequirementVerdict judge_one(const Requirement& of, std::span<const JudgedTrial> trials,
                             bool explained) {
  switch (of.kind) {
    case RequirementKind::metric:
      return judge_metric(of, trials);
    case RequirementKind::recognition:
      return judge_recognition(of, trials);
    case RequirementKind::lc_cusum:
      return judge_rates(of, trials, explained);
  }
  return {};
}

std::vector<RequirementVerdict> judge_all(const Criteria& criteria,
                                          std::span<const JudgedTrial> trials, bool explained) {
  std::vector<RequirementVerdict> out;
  for (const Requirement& one : criteria.requirements)
    out.push_back(judge_one(one, trials, explained));
  return out;
}

bool all_met(const std::vector<RequirementVerdict>& of) {
  return !of.empty() && std::ranges::all_of(of, &RequirementVerdict::met);
}

Json requirements_json(const std::vector<RequirementVerdict>& of) {
  Json out = Json::array();
  for (const RequirementVerdict& one : of)
    out.push_back({{"met", one.met}, {"required", one.required}, {"found", one.found}});
  return out;
}

}  // namespace

std::string text_of(const Requirement& of) {
  switch (of.kind) {
    case RequirementKind::metric: {
      const auto* info = metric_of(of.metric);
      const std::string label = info ? info->label : of.metric;
      const std::string where =
          of.last == 0 ? "trials" : fmt::format("the last {} trials", of.last);
      return fmt::format("{} {} {} in {} of {}", label,
                         of.side == Side::at_most ? "at most" : "at least",
                         value_text(of.bound, info ? info->unit : "1"), of.times, where);
    }
    case RequirementKind::recognition:
      return fmt::format(
          "Correct answers at least {:.4g} % at the low end of the {:.4g} % interval, of {} "
          "answers",
          100.0 * of.share, 100.0 * of.level,
          of.last == 0 ? "all" : fmt::format("the last {}", of.last));
    case RequirementKind::lc_cusum:
      return fmt::format(
          "Competence by LC-CUSUM: failure rate {:.4g} % acceptable, {:.4g} % unacceptable",
          100.0 * of.rates.adequate, 100.0 * of.rates.inadequate);
  }
  return {};
}

core::Result<Criteria> Criteria::from_json(const Json& json, const std::string& where) {
  core::Fields fields(json, where);
  if (fields.text("format", 64) != kFormat)
    fields.wrong("format", std::string(kFormat) + " is expected");
  const Json* list = fields.member("requirements");
  if (list && (!list->is_array() || list->empty() || list->size() > kMostRequirements))
    fields.wrong("requirements",
                 fmt::format("an array of 1 to {} requirements is expected", kMostRequirements));
  TRY(fields.done());
  Criteria out;
  for (const Json& one : *list) {
    auto read = TRY(
        requirement_from(one, fmt::format("{}/requirements/{}", where, out.requirements.size())));
    out.requirements.push_back(std::move(read));
  }
  return out;
}

Json Criteria::to_json() const {
  Json list = Json::array();
  for (const Requirement& one : requirements) list.push_back(json_of(one));
  return {{"format", kFormat}, {"requirements", list}};
}

Criteria Criteria::usual() { return {{Requirement{}}}; }

bool Verdict::holds_now() const { return all_met(now); }

Verdict judge(const Criteria& criteria, std::span<const JudgedTrial> trials) {
  Verdict out;
  out.trials = trials.size();
  for (std::size_t n = 1; n <= trials.size() && !out.passed(); ++n) {
    if (!all_met(judge_all(criteria, trials.first(n), false))) continue;
    out.passed_at = n;
    out.then = judge_all(criteria, trials.first(n), true);
  }
  out.now = judge_all(criteria, trials, true);
  return out;
}

Json verdict_json(const Verdict& of) {
  return {{"passed", of.passed()},
          {"passed_at", of.passed() ? Json(of.passed_at) : Json()},
          {"holds_now", of.holds_now()},
          {"trials", of.trials},
          {"requirements", requirements_json(of.passed() ? of.then : of.now)}};
}

std::size_t version_for(std::span<const std::int64_t> made_utc_us,
                        std::optional<std::int64_t> began_utc_us) {
  if (!began_utc_us) return made_utc_us.size() - 1;
  const auto after = std::ranges::upper_bound(made_utc_us, *began_utc_us);
  return after == made_utc_us.begin() ? 0 : std::size_t(after - made_utc_us.begin()) - 1;
}

}  // namespace assessment
}  // namespace tractus
