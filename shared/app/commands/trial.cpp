/// `tractus trial`: looks at a recorded trial, scores it, ends one that a crash left open.
#include "trial/trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "app/command.hpp"
#include "app/trial_csv.hpp"
#include "app/trial_set.hpp"
#include "cases/case.hpp"
#include "core/clock.hpp"
#include "core/progress.hpp"
#include "core/try.hpp"
#include "metrics/metric.hpp"
#include "scenarios/scenario.hpp"
#include "trial/trial_file.hpp"

namespace tractus {
namespace commands {
namespace {
using core::Json;

struct TrialOptions {
  std::string file, csv, case_folder, scenario, out;
  std::vector<std::string> files;
  bool json = false;
};

/// What is gathered while the samples pass by.
struct Passed {
  double from_s = -1.0, to_s = 0.0;
  trial::TickCounts ticks;

  void add(const trial::Block& block) {
    block.each([this](const auto& sample) {
      if (from_s < 0.0) from_s = sample.t_s;
      to_s = sample.t_s;
    });
    ticks.add(block);
  }
  double duration_s() const { return from_s < 0.0 ? 0.0 : to_s - from_s; }
};

/// Text of a file on a terminal: no control characters.
std::string plain(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return text;
}

Json ticks_json(const trial::TickCounts& t) {
  return {{"skipped", t.skipped}, {"late", t.late},        {"not_converged", t.not_converged},
          {"limited", t.limited}, {"stale", t.stale},      {"saturated", t.saturated},
          {"missed", t.missed},   {"bus_lost", t.bus_lost}};
}

const char* state_of(const trial::Trial& trial) {
  if (!trial.sealed)
    return "not ended: the recording program still runs or was stopped (see tractus trial recover)";
  return trial.complete ? "complete" : "interrupted";
}

void print_text(const trial::Trial& trial, const Passed& passed) {
  const auto& h = trial.header;
  fmt::print("trial    {}, {}\n{} {}\nstation  {}, {}\noperator {}{}\nstarted  {}\n", h.id,
             trial::name(h.rig), h.rig == trial::Rig::probing ? "scenario" : "case    ", h.case_id,
             plain(h.station), plain(h.device), plain(h.operator_name),
             h.simulated ? " (simulated)" : "", core::utc_text(h.started_utc_us));
  fmt::print("state    {}\nsamples  {} in {:.3f} s at {} Hz\n", state_of(trial),
             passed.ticks.samples, passed.duration_s(), h.rate_Hz);
  const auto& t = passed.ticks;
  if (h.rig == trial::Rig::probing)
    fmt::print("periods  {} skipped, {} missed, {} late, {} limited, {} without an answer\n",
               t.skipped, t.missed, t.late, t.limited, t.bus_lost);
  else
    fmt::print(
        "ticks    {} skipped, {} late, {} not converged, {} limited, {} stale, {} saturated\n",
        t.skipped, t.late, t.not_converged, t.limited, t.stale, t.saturated);
  for (const auto& event : trial.events)
    fmt::print("event    {:10.4f} s  {} {}\n", event.t_s, plain(event.kind),
               event.detail.empty()
                   ? ""
                   : event.detail.dump(-1, ' ', true, Json::error_handler_t::replace));
}

void print_json(const trial::Trial& trial, const Passed& passed) {
  Json events = Json::array();
  for (const auto& event : trial.events) events.push_back(event.to_json());
  const auto answer = trial.answer();
  const Json out{{"header", trial.header.to_json()},
                 {"complete", trial.complete},
                 {"sealed", trial.sealed},
                 {"samples", passed.ticks.samples},
                 {"duration_s", passed.duration_s()},
                 {"ticks", ticks_json(passed.ticks)},
                 {"answer", answer ? answer->to_json() : Json(nullptr)},
                 {"events", events}};
  std::puts(out.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
}

Outcome show(const TrialOptions& o) {
  std::optional<TrialCsv> csv;
  if (!o.csv.empty()) {
    auto made = TrialCsv::create(o.csv);
    if (!made) return made.error();
    csv.emplace(std::move(made).value());
  }
  std::error_code unknown;
  const double bytes = double(std::filesystem::file_size(o.file, unknown));
  const auto progress = core::terminal_progress("reading");
  Passed passed;
  const auto trial = TRY(trial::scan_trial(o.file, [&](const trial::Block& block) {
    passed.add(block);
    if (csv) csv->add(block);
    const auto each = block.probing.empty() ? sizeof(trial::Sample) : sizeof(trial::ProbingSample);
    progress(double(passed.ticks.samples * each) / bytes);
  }));
  progress(1.0);
  if (csv) TRY(csv->finish(trial.header.rig));
  o.json ? print_json(trial, passed) : print_text(trial, passed);
  return 0;
}

core::Error of_another(const TrialOptions& o, const trial::Trial& trial, const std::string& id) {
  return {
      core::Errc::bad_input,
      fmt::format("{}: this trial is of {:.12}…, but {} contains {:.12}…", o.file,
                  trial.header.case_id, o.case_folder.empty() ? o.scenario : o.case_folder, id)};
}

/// The case of a palpation trial into `subject`. Errors: those of the case, bad_input.
core::Result<cases::OpenedCase> add_case(const TrialOptions& o, metrics::Subject& subject) {
  if (o.case_folder.empty())
    return core::Error{core::Errc::bad_input,
                       o.file + ": this is a palpation trial: --case FOLDER is expected"};
  auto opened = cases::open_case(o.case_folder);
  if (!opened) return opened;
  if (subject.trial.header.case_id != opened->id) return of_another(o, subject.trial, opened->id);
  if (std::filesystem::exists(opened->folder / cases::kTruthPart)) {
    const auto truth = TRY(cases::read_truth(*opened));
    subject.truth = metrics::Truth{.breached = truth.breached};
    const auto certificate = cases::read_certificate(*opened);
    if (certificate && truth.breached)
      subject.truth->d_prime = cases::d_prime_of(*certificate, *truth.breached);
  }
  return opened;
}

core::Result<void> add_scenario(const TrialOptions& o, metrics::Subject& subject) {
  if (o.scenario.empty()) return {};
  const auto scenario = TRY(scenarios::Scenario::read(o.scenario));
  if (subject.trial.header.case_id != scenario.id())
    return of_another(o, subject.trial, scenario.id());
  subject.truth = metrics::Truth{.breached = {}, .walls = int(scenario.walls_m.size())};
  return {};
}

Outcome score(const TrialOptions& o) {
  const auto trial = trial::read_trial(o.file);
  if (!trial) return trial.error();
  metrics::Subject subject{*trial};
  std::optional<cases::OpenedCase> opened;
  if (trial->header.rig == trial::Rig::probing) {
    TRY(add_scenario(o, subject));
  } else {
    auto added = TRY(add_case(o, subject));
    opened = std::move(added);
    subject.tract = &opened->definition.tract;
  }
  const auto scores = metrics::score_all(subject);
  if (o.json) {
    Json list = Json::array();
    for (const auto& [info, score] : scores) list.push_back(metrics::to_json(info, score));
    Json out{{"trial", trial->header.id}, {"case", trial->header.case_id}, {"metrics", list}};
    if (const auto covered = metrics::coverage(subject))
      out["coverage"] = {{"depth_bins", covered->depth_bins},
                         {"angle_bins", covered->angle_bins},
                         {"samples", covered->samples}};
    std::puts(out.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
    return 0;
  }
  for (const auto& [info, score] : scores)
    fmt::print("{:<36} {:>12} {:<4} {}\n", info.label,
               score.value ? fmt::format("{:.6g}", *score.value) : "–",
               info.unit == "1" ? "" : info.unit, score.note);
  return 0;
}

Outcome recover(const TrialOptions& o) {
  const auto kept = TRY(trial::recover_trial(o.file));
  if (o.json)
    std::puts(Json({{"samples", kept}}).dump(2).c_str());
  else
    fmt::print("{} samples, ended\n", kept);
  return 0;
}

Outcome measurements(const TrialOptions& o) {
  const auto samples = TRY(write_trial_set(o.files, o.out));
  if (o.json)
    std::puts(Json({{"trials", o.files.size()}, {"samples", samples}, {"folder", o.out}})
                  .dump(2)
                  .c_str());
  else
    fmt::print("{} trials, {} samples in {}\n", o.files.size(), samples, o.out);
  return 0;
}
}  // namespace

Command trial_command() {
  return {
      "trial",
      "Show or score a recorded trial, recover a trial file after a crash, or write trials as a "
      "measurement set",
      "tractus trial metrics 018f.ttrial --case l3-left-medial", [](CLI::App& app) {
        auto options = std::make_shared<TrialOptions>();
        app.require_subcommand(1);
        CLI::App* look =
            app.add_subcommand("show", "show person, time, samples, events and end of the trial");
        CLI::App* rate = app.add_subcommand("metrics", "compute every score of the trial");
        CLI::App* end =
            app.add_subcommand("recover",
                               "end a trial file that a crash left open: cut off an incomplete "
                               "last frame; a complete file stays unchanged");
        CLI::App* set = app.add_subcommand(
            "measurements",
            "write trials as a measurement set for tractus compare, fit and diagnose");
        set->add_option("FILES", options->files, "trial files of one rig")->required();
        set->add_option("--out", options->out, "new folder for the measurement set")->required();
        set->add_flag("--json", options->json, "print the result as JSON");
        set->footer("Example:\n  tractus trial measurements st/trials/*.ttrial --out recorded");
        for (CLI::App* each : {look, rate, end}) {
          each->add_option("FILE", options->file, "trial file")->required();
          each->add_flag("--json", options->json, "print the result as JSON");
        }
        look->footer("Example:\n  tractus trial show 018f.ttrial --csv 018f.csv");
        rate->footer("Example:\n  tractus trial metrics 018f.ttrial --case l3-left-medial");
        end->footer("Example:\n  tractus trial recover 018f.ttrial");
        look->add_option("--csv", options->csv, "CSV file for all samples, in SI units");
        rate->add_option("--case", options->case_folder,
                         "palpation: folder of the case of the trial");
        rate->add_option(
            "--scenario", options->scenario,
            "probing: file of the scenario of the trial, from which the truth is read");
        return [options, look, rate, set]() -> Outcome {
          if (set->parsed()) return measurements(*options);
          if (look->parsed()) return show(*options);
          return rate->parsed() ? score(*options) : recover(*options);
        };
      }};
}

}  // namespace commands
}  // namespace tractus
