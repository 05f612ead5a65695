#include "server/jobs/cohort_table.hpp"

#include <fmt/format.h>
#include <sodium.h>

#include <algorithm>
#include <set>

#include "core/bytes.hpp"
#include "db/store/cohort.hpp"
#include "metrics/metric.hpp"

namespace jobs {
namespace {

using core::Errc;
using core::Error;
using core::Result;

/// Without what would end a cell or a row, or be a formula to a spreadsheet; in quotes where it has
/// a comma.
std::string cell(std::string text) {
  if (!text.empty() && std::string("=+-@").find(text.front()) != std::string::npos)
    text.insert(text.begin(), '\'');
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = ' ';
    if (c == '"') c = '\'';
  }
  return text.find(',') == std::string::npos ? text : '"' + text + '"';
}

std::string cell(const std::optional<double>& number) {
  return number ? fmt::format("{}", *number) : "";
}

/// Of somebody in no study: the same for the same name, and nobody without the server's key can say
/// whose.
std::string pseudonym(const store::AuditKey& key, const std::string& name) {
  const std::string message = "participant of the cohort's table: " + name;
  std::array<std::byte, 16> hash{};
  crypto_generichash(reinterpret_cast<unsigned char*>(hash.data()), hash.size(),
                     reinterpret_cast<const unsigned char*>(message.data()), message.size(),
                     reinterpret_cast<const unsigned char*>(key.data()), key.size());
  return "P" + core::hex(hash).substr(0, 16);
}

std::string row_of(const store::CohortTrial& trial, const std::vector<std::string>& metrics,
                   const store::AuditKey& key) {
  const auto& s = trial.summary;
  const bool in_study = !trial.study.empty();
  std::string out =
      fmt::format("{},{},{},{},{},{},{},{},{},{}", cell(s.id),
                  cell(in_study ? trial.participant : pseudonym(key, s.operator_name)),
                  cell(trial.study), in_study ? std::to_string(trial.number) : "",
                  cell(trial.level), cell(trial.experience_years), cell(s.case_title),
                  cell(trial.rig), s.simulated ? 1 : 0, s.correct ? (*s.correct ? "1" : "0") : "");
  for (const auto& id : metrics) {
    const auto at = trial.metrics.find(id);
    out += ',' + (at == trial.metrics.end() ? "" : cell(std::optional(at->second)));
  }
  return out + '\n';
}

/// Metrics that any trial has, in the order of a trial's page; those of another version last.
std::vector<std::string> metrics_of(const std::vector<store::CohortTrial>& trials) {
  std::set<std::string> there;
  for (const auto& trial : trials)
    for (const auto& [id, _] : trial.metrics) there.insert(id);
  std::vector<std::string> out;
  for (const auto& info : metrics::all())
    if (there.erase(info.id) > 0) out.push_back(info.id);
  out.insert(out.end(), there.begin(), there.end());
  return out;
}

/// The trials that make a row; the others are counted.
std::vector<store::CohortTrial> counting(std::vector<store::CohortTrial> trials, CohortTable& out) {
  std::erase_if(trials, [&](const store::CohortTrial& trial) {
    const bool counts = trial.complete && (trial.study.empty() || trial.place == "counts");
    const bool scored = trial.summary.state == "assessed";
    if (!counts) ++out.invalid;
    if (counts && !scored) ++out.unscored;
    return !counts || !scored;
  });
  return trials;
}

std::map<std::string, std::string> meanings_of(const std::vector<std::string>& metrics) {
  std::map<std::string, std::string> out = {
      {"trial", "its id on the server"},
      {"participant", "the study's pseudonym, else one of the server's; no name"},
      {"study", "empty: of no study"},
      {"number", "of the trial among the participant's in the study, from 1"},
      {"level", "of training, as the study states it"},
      {"experience_years", "as the study states it"},
      {"case", "the case's title"},
      {"rig", "palpation or probing"},
      {"simulated", "1: by a simulated hand or machine"},
      {"correct", "1: the answer about the breach was right"}};
  for (const auto& info : metrics::all())
    if (std::ranges::find(metrics, info.id) != metrics.end())
      out[info.id] =
          fmt::format("{}, {}: {} {}", info.label, info.unit, info.definition, info.source);
  return out;
}

}  // namespace

Result<CohortTable> cohort_table(store::Store& store, const std::string& study, std::int64_t most) {
  using Trials = std::vector<store::CohortTrial>;
  auto found = store.read([&](store::Reading& tx) -> Result<Trials> {
    if (!study.empty()) {
      auto known = store::series_exists(tx, study);
      if (!known) return known.error();
      if (!*known) return Error{Errc::bad_input, "study: there is no study " + study.substr(0, 32)};
    }
    return store::cohort_trials(tx, study, most);
  });
  if (!found) return found.error();
  CohortTable out;
  const auto trials = counting(std::move(*found), out);
  const auto metrics = metrics_of(trials);
  out.csv = "trial,participant,study,number,level,experience_years,case,rig,simulated,correct";
  for (const auto& id : metrics) out.csv += ',' + cell(id);
  out.csv += '\n';
  for (const auto& trial : trials) out.csv += row_of(trial, metrics, store.audit_key());
  out.rows = trials.size();
  out.simulated = static_cast<std::size_t>(
      std::ranges::count_if(trials, [](const auto& trial) { return trial.summary.simulated; }));
  out.sha256 = core::sha256(core::bytes_of(out.csv));
  out.meanings = meanings_of(metrics);
  return out;
}

}  // namespace jobs
