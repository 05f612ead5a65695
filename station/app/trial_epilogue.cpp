#include "station/app/trial_epilogue.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>

#include "station/app/exchange.hpp"

namespace tractus::app {
using session::TrialReport;

core::Result<std::optional<trial::Answer>> answer_of(
    const Options& options, const std::optional<trial::Answer>& simulated) {
  std::string wall = options.answer;
  if (wall.empty()) {
    if (simulated) return simulated;
    if (!::isatty(STDIN_FILENO)) return std::optional<trial::Answer>();
    fmt::print(stderr, "Breach? none, medial, lateral, superior, inferior, anterior: ");
    if (!(std::cin >> wall)) return std::optional<trial::Answer>();
  }
  if (wall == "none") return std::optional(trial::Answer{});
  if (core::from_name<volume::Wall>(wall))
    return std::optional(trial::Answer{.breach = true, .wall = wall, .confidence = std::nullopt});
  return core::Error{core::Errc::bad_input, fmt::format("{}: no such wall", wall)};
}

std::string answer_text(const TrialReport& report) {
  if (!report.answer) return "no answer";
  const std::string wall =
      report.answer->breach ? report.answer->wall.value_or("breach") : "no breach";
  if (!report.answer->confidence) return wall;
  return fmt::format("{}, confidence {:.2f}", wall, *report.answer->confidence);
}

std::string headset_text(const core::Json& figures) {
  const std::string ended = figures.at("ended").get<std::string>();
  return fmt::format(
      "headset{}: {} frames at {:.0f} Hz, {} dropped, {} without tracking, frame p50 {:.1f} ms, "
      "p99 "
      "{:.1f} ms{}{}",
      figures.at("simulated").get<bool>() ? " (SIMULATED runtime)" : "",
      figures.at("frames").get<std::uint64_t>(), figures.at("rate_Hz").get<double>(),
      figures.at("dropped_frames").get<std::uint64_t>(),
      figures.at("untracked_frames").get<std::uint64_t>(), figures.at("frame_p50_ms").get<double>(),
      figures.at("frame_p99_ms").get<double>(),
      figures.at("aligned").get<bool>() ? "" : ", room not aligned",
      ended.empty() ? "" : "; ended before the trial: " + ended);
}

void print_scores(const session::Scores& scores) {
  for (const auto& [info, score] : scores)
    if (score.value) fmt::print("  {:<34} {:>10.4g} {}\n", info.label, *score.value, info.unit);
}

core::Json json_of(const TrialReport& report, const session::Scores& scores) {
  core::Json out = report.to_json();
  out["metrics"] = core::Json::array();
  for (const auto& [info, score] : scores) out["metrics"].push_back(metrics::to_json(info, score));
  return out;
}

void say_recovered(const session::Recovered& recovered) {
  for (const auto& one : recovered.trials)
    std::fprintf(stderr, "an interrupted trial was kept: %s, %llu samples\n", one.trial_id.c_str(),
                 static_cast<unsigned long long>(one.samples));
  for (const auto& line : recovered.damaged)
    std::fprintf(stderr, "warning: a trial cannot be read and stays as it is: %s\n", line.c_str());
}

core::Json hand_over_after(const Options& options, const session::StationFolder& folder) {
  if (options.server_url.empty()) return nullptr;
  auto report = hand_over(options, folder);
  if (!report) {
    std::fprintf(stderr, "warning: nothing was handed over: %s\n", report.error().what.c_str());
    return {{"why", report.error().what}};
  }
  if (!options.json) fmt::print("{}\n", text_of(*report));
  return report->to_json();
}
}  // namespace tractus::app
