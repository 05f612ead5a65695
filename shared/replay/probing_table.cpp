#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>

#include "replay/cells.hpp"
#include "replay/probing_replay.hpp"

namespace tractus {
namespace replay {
namespace {

/// Sums over the samples of one channel.
struct Sums {
  std::size_t samples = 0;
  double measured = 0.0, measured2 = 0.0, simulated = 0.0, simulated2 = 0.0, error2 = 0.0;
  double most_measured = 0.0, most_simulated = 0.0;

  void add(const std::vector<double>& a, const std::vector<double>& b) {
    for (std::size_t k = 0; k < a.size(); ++k) {
      measured += a[k], measured2 += a[k] * a[k];
      simulated += b[k], simulated2 += b[k] * b[k];
      error2 += (a[k] - b[k]) * (a[k] - b[k]);
      most_measured = std::max(most_measured, std::abs(a[k]));
      most_simulated = std::max(most_simulated, std::abs(b[k]));
    }
    samples += a.size();
  }
  static double variance(double n, double sum, double sum2) {
    return std::max(0.0, sum2 / n - sum / n * (sum / n));
  }
  ProbingRow row(std::string scope, std::string name, std::string channel) const {
    const double n = double(samples);
    const double var_m = variance(n, measured, measured2),
                 var_s = variance(n, simulated, simulated2);
    ProbingRow out{std::move(scope),
                   std::move(name),
                   std::move(channel),
                   samples,
                   {measured / n, std::sqrt(var_m), most_measured},
                   {simulated / n, std::sqrt(var_s), most_simulated},
                   std::sqrt(error2 / n),
                   std::numeric_limits<double>::quiet_NaN()};
    if (var_m > 0.0) out.r2 = 1.0 - error2 / n / var_m;
    return out;
  }
};

using Channels = std::map<std::string, Sums>;

Channels sums_of(const trial::ProbingMeasurement& recording, const ProbingReplayed& replayed,
                 Channels into = {}) {
  if (!recording.fz_N.empty() && !replayed.forces.fz_N.empty())
    into["fz_N"].add(recording.fz_N, replayed.forces.fz_N);
  if (!recording.tz_Nm.empty() && !replayed.forces.tz_Nm.empty())
    into["tz_Nm"].add(recording.tz_Nm, replayed.forces.tz_Nm);
  if (!replayed.live_x_m.empty()) into["x_m"].add(recording.x_m, replayed.live_x_m);
  return into;
}

void add_rows(const std::string& scope, const std::string& name, const Channels& channels,
              std::vector<ProbingRow>& out) {
  for (const auto& [channel, sums] : channels) out.push_back(sums.row(scope, name, channel));
}

core::Json side(const ProbingRow::Side& side) {
  return {{"mean", number(side.mean)}, {"sd", number(side.sd)}, {"max", number(side.max)}};
}

}  // namespace

std::vector<ProbingRow> rows(const std::vector<trial::ProbingMeasurement>& recordings,
                             const std::vector<ProbingReplayed>& replayed) {
  Channels all;
  std::map<std::string, Channels> operators;
  std::vector<ProbingRow> out, trials;
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    const auto& recording = recordings[k];
    all = sums_of(recording, replayed[k], std::move(all));
    if (!recording.operator_name.empty()) {
      Channels& own = operators[recording.operator_name];
      own = sums_of(recording, replayed[k], std::move(own));
    }
    add_rows("trial", recording.id, sums_of(recording, replayed[k]), trials);
  }
  add_rows("all", "", all, out);
  for (const auto& [name, channels] : operators) add_rows("operator", name, channels, out);
  out.insert(out.end(), trials.begin(), trials.end());
  return out;
}

std::string csv(const std::vector<ProbingRow>& rows) {
  std::string out =
      "scope,name,channel,samples,measured_mean,measured_sd,measured_max,simulated_mean,"
      "simulated_sd,simulated_max,rmse,r2\n";
  for (const ProbingRow& r : rows) {
    out += fmt::format("{},{},{},{}", r.scope, r.name, r.channel, r.samples);
    for (const double v : {r.measured.mean, r.measured.sd, r.measured.max, r.simulated.mean,
                           r.simulated.sd, r.simulated.max, r.rmse, r.r2})
      out += "," + cell(v);
    out += "\n";
  }
  return out;
}

std::string printed(const std::vector<ProbingRow>& rows) {
  std::string out = fmt::format("  {:<22} {:<8} {:>11} {:>11} {:>11} {:>9}\n", "", "channel",
                                "measured", "simulated", "error", "R²");
  for (const ProbingRow& r : rows) {
    if (r.channel == "x_m") continue;
    const std::string who = r.scope == "all" ? "all trials" : fmt::format("{} {}", r.scope, r.name);
    out += fmt::format("  {:<22.22} {:<8} {:>11.4g} {:>11.4g} {:>11.4g} {:>9.4f}\n", who, r.channel,
                       r.measured.sd, r.simulated.sd, r.rmse, r.r2);
  }
  return out + "  measured and simulated: standard deviations; error: rms of their difference\n";
}

core::Json to_json(const ProbingRow& row) {
  return {{"scope", row.scope},
          {"name", row.name},
          {"channel", row.channel},
          {"samples", row.samples},
          {"measured", side(row.measured)},
          {"simulated", side(row.simulated)},
          {"rmse", number(row.rmse)},
          {"r2", number(row.r2)}};
}

namespace {

struct Column {
  const char* name;
  const std::vector<double>* values;
};

/// Columns without values are left out.
std::string csv(const std::vector<Column>& all, std::size_t rows) {
  std::string out;
  for (const Column& column : all)
    if (!column.values->empty()) out += (out.empty() ? "" : ",") + std::string(column.name);
  out += "\n";
  for (std::size_t k = 0; k < rows; ++k) {
    bool first = true;
    for (const Column& column : all) {
      if (column.values->empty()) continue;
      if (!first) out += ',';
      fmt::format_to(std::back_inserter(out), "{}", (*column.values)[k]);
      first = false;
    }
    out += "\n";
  }
  return out;
}

}  // namespace

std::string csv(const trial::ProbingMeasurement& recording, const ProbingReplayed& replayed) {
  return csv({{"t_s", &recording.t_s},
              {"x_m", &recording.x_m},
              {"theta_rad", &recording.theta_rad},
              {"fz_N", &replayed.forces.fz_N},
              {"tz_Nm", &replayed.forces.tz_Nm},
              {"measured_fz_N", &recording.fz_N},
              {"measured_tz_Nm", &recording.tz_Nm},
              {"speed_m_s", recording.x_m.empty() ? &recording.x_m : &replayed.motion.v_m_s},
              {"turning_rad_s", &replayed.motion.omega_rad_s},
              {"live_x_m", &replayed.live_x_m}},
             recording.t_s.size());
}

std::string motion_csv(const models::ProbingMotion& motion) {
  const std::vector<double> rest_m_s(motion.size(), motion.rest_m_s),
      rest_rad_s(motion.size(), motion.rest_rad_s);
  return csv({{"t_s", &motion.t_s},
              {"x_m", &motion.x_m},
              {"v_m_s", &motion.v_m_s},
              {"a_m_s2", &motion.a_m_s2},
              {"theta_rad", &motion.theta_rad},
              {"omega_rad_s", &motion.omega_rad_s},
              {"recorded_tz_Nm", &motion.tz_Nm},
              {"rest_m_s", &rest_m_s},
              {"rest_rad_s", &rest_rad_s}},
             motion.size());
}

}  // namespace replay
}  // namespace tractus
