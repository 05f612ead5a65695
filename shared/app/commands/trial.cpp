/// `tractus trial`: looks at a recorded trial, scores it, ends one that a crash left open.
#include "trial/trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "app/command.hpp"
#include "app/trial_csv.hpp"
#include "cases/case.hpp"
#include "core/clock.hpp"
#include "core/progress.hpp"
#include "metrics/metric.hpp"
#include "trial/trial_file.hpp"

namespace commands {
namespace {
using core::Json;

struct Options {
  std::string file, csv, case_folder;
  bool json = false;
};

/// What is gathered while the samples pass by.
struct Passed {
  std::uint64_t samples = 0;
  double from_s = 0.0, to_s = 0.0;
  trial::TickCounts ticks;

  void add(std::span<const trial::Sample> block) {
    const auto counts = trial::count_ticks(block);
    if (samples == 0) from_s = block.front().t_s;
    to_s = block.back().t_s;
    samples += block.size();
    ticks.not_converged += counts.not_converged;
    ticks.limited += counts.limited;
    ticks.late += counts.late;
    ticks.stale += counts.stale;
    ticks.saturated += counts.saturated;
    ticks.skipped = std::uint64_t{block.back().tick} + 1 - samples;
  }
};

/// Text of a file on a terminal: no control characters.
std::string plain(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return text;
}

Json ticks_json(const trial::TickCounts& t) {
  return {{"skipped", t.skipped}, {"late", t.late},   {"not_converged", t.not_converged},
          {"limited", t.limited}, {"stale", t.stale}, {"saturated", t.saturated}};
}

const char* state_of(const trial::Trial& trial) {
  if (!trial.sealed) return "not ended: its writer is at work or was stopped (see trial recover)";
  return trial.complete ? "complete" : "interrupted";
}

void print_text(const trial::Trial& trial, const Passed& passed) {
  const auto& h = trial.header;
  fmt::print("trial    {}\ncase     {}\nstation  {}, {}\noperator {}{}\nstarted  {}\n", h.id,
             h.case_id, plain(h.station), plain(h.device), plain(h.operator_name),
             h.simulated ? " (simulated)" : "", core::utc_text(h.started_utc_us));
  fmt::print("state    {}\nsamples  {} in {:.3f} s at {} Hz\n", state_of(trial), passed.samples,
             passed.to_s - passed.from_s, h.rate_Hz);
  const auto& t = passed.ticks;
  fmt::print("ticks    {} skipped, {} late, {} not converged, {} limited, {} stale, {} saturated\n",
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
                 {"samples", passed.samples},
                 {"duration_s", passed.to_s - passed.from_s},
                 {"ticks", ticks_json(passed.ticks)},
                 {"answer", answer ? answer->to_json() : Json(nullptr)},
                 {"events", events}};
  std::puts(out.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
}

Outcome show(const Options& o) {
  std::optional<TrialCsv> csv;
  if (!o.csv.empty()) {
    auto made = TrialCsv::create(o.csv);
    if (!made) return made.error();
    csv.emplace(std::move(made).value());
  }
  std::error_code unknown;
  const double expected =
      double(std::filesystem::file_size(o.file, unknown)) / sizeof(trial::Sample);
  const auto progress = core::terminal_progress("reading");
  Passed passed;
  const auto trial = trial::scan_trial(o.file, [&](std::span<const trial::Sample> block) {
    passed.add(block);
    if (csv) csv->add(block);
    progress(double(passed.samples) / expected);
  });
  if (!trial) return trial.error();
  progress(1.0);
  if (csv)
    if (auto done = csv->finish(); !done) return done.error();
  o.json ? print_json(*trial, passed) : print_text(*trial, passed);
  return 0;
}

Outcome score(const Options& o) {
  const auto opened = cases::open_case(o.case_folder);
  if (!opened) return opened.error();
  const auto trial = trial::read_trial(o.file);
  if (!trial) return trial.error();
  if (trial->header.case_id != opened->id)
    return core::Error{core::Errc::bad_input,
                       fmt::format("{}: is a trial of case {:.12}…, {} holds case {:.12}…", o.file,
                                   trial->header.case_id, o.case_folder, opened->id)};
  metrics::Subject subject{*trial, opened->definition.tract, {}};
  if (std::filesystem::exists(opened->folder / cases::kTruthPart)) {
    const auto truth = cases::read_truth(*opened);
    if (!truth) return truth.error();
    subject.truth = metrics::Truth{truth->breached};
  }
  const auto scores = metrics::score_all(subject);
  if (o.json) {
    Json list = Json::array();
    for (const auto& [info, score] : scores) list.push_back(metrics::to_json(info, score));
    Json out{{"trial", trial->header.id}, {"case", opened->id}, {"metrics", list}};
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

Outcome recover(const Options& o) {
  const auto kept = trial::recover_trial(o.file);
  if (!kept) return kept.error();
  if (o.json)
    std::puts(Json({{"samples", *kept}}).dump(2).c_str());
  else
    fmt::print("{} samples, ended\n", *kept);
  return 0;
}
}  // namespace

Command trial_command() {
  return {"trial", "Shows a recorded trial, scores it, or ends one that a crash left open",
          "tractus trial metrics 018f.ttrial --case l3-left-medial", [](CLI::App& app) {
            auto options = std::make_shared<Options>();
            app.require_subcommand(1);
            CLI::App* look = app.add_subcommand("show", "who, when, samples, events, how it ended");
            CLI::App* rate = app.add_subcommand("metrics", "every score of the trial on its case");
            CLI::App* end = app.add_subcommand(
                "recover", "cut an unfinished last frame and end the file; a finished one stays");
            for (CLI::App* each : {look, rate, end}) {
              each->add_option("FILE", options->file, "a tractus-trial/1 file")->required();
              each->add_flag("--json", options->json, "print as JSON");
            }
            look->footer("Example:\n  tractus trial show 018f.ttrial --csv 018f.csv");
            rate->footer("Example:\n  tractus trial metrics 018f.ttrial --case l3-left-medial");
            end->footer("Example:\n  tractus trial recover 018f.ttrial");
            look->add_option("--csv", options->csv, "write every sample to this table, SI units");
            rate->add_option("--case", options->case_folder, "folder of the case it was made on")
                ->required();
            return [options, look, rate]() -> Outcome {
              if (look->parsed()) return show(*options);
              return rate->parsed() ? score(*options) : recover(*options);
            };
          }};
}

}  // namespace commands
