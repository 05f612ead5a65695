#include "app/lab_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/file.hpp"
#include "core/progress.hpp"
#include "core/try.hpp"
#include "core/words.hpp"
#include "effects/catalogues.hpp"
#include "lab/identify/verdict_text.hpp"

namespace tractus {
namespace commands {
namespace {

using core::Result;
using lab::figure;

std::string percent(double share) {
  if (share > 0.0 && share < 0.0005) return "< 0.1 %";
  return std::isfinite(share) ? fmt::format("{:.3g} %", 100.0 * share) : "–";
}

/// `text` in a column of `width` characters.
std::string left(std::string_view text, std::size_t width) {
  const std::size_t seen = core::characters(text);
  return std::string(text) + std::string(seen < width ? width - seen : 1, ' ');
}

std::string right(std::string_view text, std::size_t width) {
  const std::size_t seen = core::characters(text);
  return std::string(seen < width ? width - seen : 1, ' ') + std::string(text);
}

std::string estimate(const lab::Estimate& e) {
  const auto [name, unit] = lab::name_and_unit(e.pointer);
  std::string out = "  " + left(e.pointer, 44) + right(figure(e.value), 10);
  out += e.informed ? fmt::format(" ± {}", figure(e.sd)) : "  (not informed by these recordings)";
  if (!unit.empty() && e.informed) out += " " + unit;
  return out + (e.at_bound ? "  (at the edge of its range)" : "") + "\n";
}

/// "83 %", or how little it is.
std::string explained(double share) {
  return share < 0.0 ? "less than its mean does" : percent(share);
}

std::string notes(const std::vector<std::string>& said) {
  std::string out;
  for (const std::string& note : said) out += "- " + note + "\n";
  return out.empty() ? "" : "\n" + out;
}

std::string ranking(const lab::Diagnosis& d, const std::string& unit) {
  std::string out =
      "\n  " + left("effect", 30) + right("probability", 12) + right("held out", 13) + "\n";
  std::size_t n = 0;
  for (const lab::Ranked& r : d.ranking) {
    if (++n > 8 && r.probability < 0.005) continue;
    out += "  " + left(effects::label_of(r.id), 30) + right(percent(r.probability), 12) +
           right(r.held_out_rmse ? figure(*r.held_out_rmse, unit) : "–", 13) +
           (r.note.empty() ? "" : "  " + r.note) + "\n";
  }
  return out;
}

}  // namespace

void add_lab_options(CLI::App& app, LabOptions& options) {
  app.add_option("--model", options.sources.model, "model file in the format tractus-model/1")
      ->required();
  app.add_option("--measurements", options.sources.measurements,
                 "measurement set in the format tractus-measurements/1: a folder with set.json, or "
                 "a zip of such a folder")
      ->required();
  app.add_option("--report", options.report,
                 "also write the report as one self-contained HTML page, FILE.html");
  app.add_option("--threads", options.sources.threads, "number of threads")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_flag("--json", options.json, "print the result as JSON");
}

void add_own_option(CLI::App& app, LabOptions& options) {
  app.add_option("--effect", options.own,
                 "file of a user effect in the format tractus-effect/1; may be repeated")
      ->expected(1, 64)
      ->allow_extra_args(false);
}

Result<lab_io::Case> opened(const LabOptions& options) {
  lab_io::Sources sources = options.sources;
  for (const auto& file : options.own) {
    auto own = TRY(lab_io::read_own(file));
    sources.own.push_back(std::move(own));
  }
  return lab_io::open_case(sources, core::terminal_progress("reading"));
}

Result<void> writable(const std::filesystem::path& file) {
  if (file.empty()) return {};
  std::error_code ignored;
  const auto folder = file.has_parent_path() ? file.parent_path() : ".";
  if (!std::filesystem::is_directory(folder, ignored))
    return core::Error{core::Errc::bad_input,
                       fmt::format("{}: there is no folder {}", file.string(), folder.string())};
  return core::may_be_replaced(file);
}

Result<void> write_files(const lab_io::LabResult& answer, const std::filesystem::path& model,
                         const std::filesystem::path& report) {
  if (!report.empty()) TRY(core::write_file(report, core::bytes_of(lab::report(answer.content))));
  if (!model.empty() && answer.model) return core::write_json(model, *answer.model);
  return {};
}

std::string printed_comparison(const lab_io::LabResult& answer) {
  const lab::Comparison& c = answer.content.before.comparison;
  std::string out = fmt::format(
      "The model is off by {} in {}; the noise floor is {}. Of what could be explained it explains "
      "{}.\n\n  {}{}{}{}{}\n",
      figure(c.rmse, c.judged_unit), c.judged_name, figure(c.noise_floor, c.judged_unit),
      explained(c.explained), left("channel", 12), right("error", 10), right("R²", 9),
      right("noise", 10), right("explained", 11));
  for (const auto& channel : c.channels)
    out += "  " + left(channel.name, 12) + right(figure(channel.rmse), 10) +
           right(fmt::format("{:.4f}", channel.r2), 9) + right(figure(channel.noise_floor), 10) +
           right(channel.explained < 0.0 ? "< 0 %" : percent(channel.explained), 11) + "\n";
  if (const auto judged = lab::judged_text(c); !judged.empty()) out += "\n  " + judged + "\n";
  out += "\n  " + left("where it fails", 44) + right("of error", 9) + right("of time", 9) +
         right("error", 12) + "\n";
  for (const lab::Region& r : c.error_regions.regions)
    out += "  " + left(r.words, 44) + right(percent(r.share_of_error), 9) +
           right(percent(r.share_of_time), 9) + right(figure(r.rmse, c.judged_unit), 12) + "\n";
  out += "\n  " + left("phase", 44) + right("of error", 9) + right("of time", 9) +
         right("error", 12) + "\n";
  for (const auto& p : c.phases)
    out += "  " + left(p.phase, 44) + right(percent(p.share_of_error), 9) +
           right(percent(p.share_of_time), 9) + right(figure(p.rmse, c.judged_unit), 12) + "\n";
  return out + notes(answer.content.notes);
}

std::string printed_diagnosis(const lab_io::LabResult& answer) {
  const lab::Diagnosis& d = *answer.content.diagnosis;
  const std::string unit = lab::name_and_unit(answer.json.value("primary", std::string())).unit;
  const lab::StatedVerdict& stated = *answer.content.stated;
  const std::string probability =
      std::isfinite(stated.probability)
          ? fmt::format("Probability that this is right: {}.\n", percent(stated.probability))
          : "";
  std::string out =
      fmt::format("{}\n{}\n{}\n  {}{}{}\n", stated.headline, stated.detail, probability,
                  left("model", 30), right("error", 12), right("held out", 13));
  for (const lab::Step& step : d.steps)
    out += "  " +
           left(step.model.starts_with("+ ") ? "+ " + effects::label_of(step.model.substr(2))
                                             : step.model,
                30) +
           right(figure(step.rmse, unit), 12) + right(figure(step.held_out_rmse, unit), 13) + "\n";
  out += ranking(d, unit);
  if (!d.effects.empty()) out += "\n";
  for (const lab::Estimate& e : d.final_fit.estimates)
    if (!e.pointer.starts_with("/")) out += estimate(e);
  for (const auto& [a, b] : d.confounded)
    out += fmt::format("\nThese measurements hardly distinguish {} and {}.", effects::label_of(a),
                       effects::label_of(b));
  if (!d.confounded.empty()) out += "\n";
  if (answer.discovery) out += "\n" + lab::sentences(*answer.discovery, unit);
  if (d.discriminating_experiment)
    out +=
        fmt::format("\nRecommended next recording: {}.\n", d.discriminating_experiment->recording);
  for (const lab::ProgramValue& value : answer.programs)
    out += fmt::format(
        "  {:24}{:4.0f} s   expected gain in the probability of the true answer {:.2f}\n",
        value.program.name, value.seconds, value.expected_gain);
  return out + notes(d.notes);
}

std::string printed_fit(const lab_io::LabResult& answer) {
  const lab::Fit& fit = *answer.content.fit;
  const lab::Comparison& given = answer.content.before.comparison;
  std::string out = fmt::format(
      "Fitted: the error falls from {} to {}, on held-out measurements {}; the noise floor is "
      "{}.\n\n",
      figure(given.rmse, given.judged_unit), figure(fit.rmse, given.judged_unit),
      figure(fit.held_out_rmse, given.judged_unit), figure(fit.noise_floor, given.judged_unit));
  for (const lab::Estimate& e : fit.estimates) out += estimate(e);
  if (!fit.converged) out += "\nThe fit did not converge; its values are uncertain.\n";
  return out + notes(fit.remarks);
}

}  // namespace commands
}  // namespace tractus
