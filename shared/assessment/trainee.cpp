#include "assessment/trainee.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assessment/counts.hpp"
#include "assessment/formula.hpp"
#include "assessment/report.hpp"
#include "core/try.hpp"

namespace tractus {
namespace assessment {
namespace {

core::Result<std::vector<std::vector<double>>> scores_of(const Table& table,
                                                         const std::vector<std::string>& columns) {
  std::vector<std::vector<double>> out;
  for (const auto& column : columns) {
    const auto& cells = table.texts(column);
    std::vector<double> values(cells.size(), std::nan(""));
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (is_missing(cells[i])) continue;
      const auto number = number_in(cells[i]);
      if (!number)
        return core::bad_input(fmt::format("{}:{}: column '{}' should be a number and is '{}'",
                                           table.name(), table.line(i), column,
                                           cells[i].substr(0, 40)));
      values[i] = *number;
    }
    out.push_back(std::move(values));
  }
  return out;
}

/// [score][scenario]
std::vector<std::vector<double>> means_of(const Cohort& cohort) {
  const std::size_t k = cohort.scores.size(), m = cohort.scenarios.size();
  std::vector<std::vector<double>> sums(k, std::vector<double>(m, 0.0)), counts = sums;
  for (const auto& attempts : cohort.attempts)
    for (const auto& one : attempts)
      for (std::size_t j = 0; j < k; ++j) {
        if (!std::isfinite(one.scores[j])) continue;
        sums[j][one.scenario] += one.scores[j];
        counts[j][one.scenario] += 1.0;
      }
  for (std::size_t j = 0; j < k; ++j)
    for (std::size_t s = 0; s < m; ++s)
      sums[j][s] = counts[j][s] > 0.0 ? sums[j][s] / counts[j][s] : std::nan("");
  return sums;
}

}  // namespace

std::vector<std::string> TraineeColumns::all() const {
  std::vector<std::string> out{trainee, order, scenario, right};
  out.insert(out.end(), scores.begin(), scores.end());
  return out;
}

const char* name_of(Standing::State state) {
  if (state == Standing::State::learning) return "learning";
  return state == Standing::State::competent ? "competent" : "relapsed";
}

core::Result<Cohort> cohort_of(const Table& table, const TraineeColumns& columns) {
  const auto right = TRY(yes_no(table, columns.right));
  const auto order = TRY(table.numbers(columns.order));
  const auto scores = TRY(scores_of(table, columns.scores));
  Cohort out;
  out.scores = columns.scores;
  out.scenarios = levels_of(table, columns.scenario);
  const auto scenario = places_of(table, columns.scenario, out.scenarios);
  const Parts parts = parts_of(table, columns.trainee);
  out.trainees = parts.names;
  for (std::size_t j = 0; j < parts.names.size(); ++j) {
    auto rows = parts.rows[j];
    const auto when = [&](std::size_t i) { return order[static_cast<Eigen::Index>(i)]; };
    std::ranges::stable_sort(rows, {}, when);
    std::vector<Attempt> attempts;
    for (const std::size_t i : rows) {
      if (!attempts.empty() && attempts.back().order == when(i))
        return core::bad_input(
            fmt::format("{}:{}: '{}' is {} twice for '{}': the order of trials is not "
                        "known",
                        table.name(), table.line(i), columns.order, when(i), parts.names[j]));
      Attempt one{when(i), right[i], scenario[i], {}};
      for (const auto& values : scores) one.scores.push_back(values[i]);
      attempts.push_back(std::move(one));
    }
    out.attempts.push_back(std::move(attempts));
  }
  out.means = means_of(out);
  return out;
}

std::vector<Relapse> relapses_in(const std::vector<double>& sums, double threshold,
                                 std::size_t before) {
  std::vector<Relapse> out;
  bool relapsed = false;
  for (std::size_t t = 0; t < sums.size(); ++t) {
    if (!relapsed && sums[t] >= threshold) {
      relapsed = true;
      out.push_back({before + t + 1, 0});
    } else if (relapsed && sums[t] == 0.0) {
      relapsed = false;
      out.back().recovered_at = before + t + 1;
    }
  }
  return out;
}

Standing standing(const std::vector<Attempt>& attempts, const statistics::Rates& rates,
                  double threshold, double relapse) {
  std::vector<bool> failures;
  for (const auto& one : attempts) failures.push_back(!one.right);
  Standing out;
  out.sums = statistics::lc_cusum(failures, rates);
  out.signalled_at = statistics::first_at(out.sums, threshold);
  if (out.signalled_at == 0) return out;
  out.state = Standing::State::competent;
  failures.erase(failures.begin(),
                 failures.begin() + static_cast<std::ptrdiff_t>(out.signalled_at));
  out.relapse_sums = statistics::deterioration_cusum(failures, rates);
  out.relapses = relapses_in(out.relapse_sums, relapse, out.signalled_at);
  if (!out.relapses.empty() && out.relapses.back().recovered_at == 0)
    out.state = Standing::State::relapsed;
  return out;
}

}  // namespace assessment
}  // namespace tractus
