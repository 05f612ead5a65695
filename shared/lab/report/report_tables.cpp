/// The report's tables: where it fails, parameters, trials, what was assumed.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "effects/catalogues.hpp"
#include "lab/identify/verdict_text.hpp"
#include "lab/report/report_parts.hpp"
#include "plot/text.hpp"

namespace tractus {
namespace lab::page {

namespace {

using plot::escaped;

const Fit* fit_of(const ReportContent& content) {
  if (content.diagnosis) return &content.diagnosis->final_fit;
  return content.fit ? &*content.fit : nullptr;
}

std::string regions(const Side& side) {
  const std::string& unit = side.comparison.judged_unit;
  std::string out =
      "<table>\n<tr><th>region</th><th>share of the error</th><th class=\"n\"></th>"
      "<th class=\"n\">of the time</th><th class=\"n\">error there</th>"
      "<th class=\"n\">mean residual</th></tr>\n";
  for (const Region& r : side.comparison.error_regions.regions)
    out += fmt::format(
        "<tr><td>{}</td><td class=\"wide\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>"
        "<td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
        escaped(r.words), bar(r.share_of_error, "given"), percent(r.share_of_error),
        percent(r.share_of_time), figure(r.rmse, unit),
        r.mean.size() == 1
            ? figure(r.mean[0], unit)
            : fmt::format("{:.2g}, {:.2g}, {:.2g} {}", r.mean[0], r.mean[1], r.mean[2], unit));
  return out + "</table>\n";
}

bool at_floor(const Side& side) {
  return side.comparison.rmse <= 1.1 * side.comparison.noise_floor;
}

std::string phase_table(const ReportContent& content) {
  const Comparison& given = content.before.comparison;
  if (given.phases.empty()) return {};
  std::string out = fmt::format(
      "<h3>By phase</h3>\n<table>\n<tr><th>phase</th><th>share of the error</th>"
      "<th class=\"n\"></th><th class=\"n\">of the time</th><th class=\"n\">error {}</th>{}"
      "</tr>\n",
      content.before_name,
      content.better ? "<th class=\"n\">" + escaped(better_name(content)) + "</th>" : "");
  for (std::size_t k = 0; k < given.phases.size(); ++k) {
    const PhaseComparison& p = given.phases[k];
    out += fmt::format(
        "<tr><td>{}</td><td class=\"wide\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>"
        "<td class=\"n\">{}</td>{}</tr>\n",
        escaped(p.phase), bar(p.share_of_error, "given"), percent(p.share_of_error),
        percent(p.share_of_time), figure(p.rmse, given.judged_unit),
        content.better && k < content.better->comparison.phases.size()
            ? "<td class=\"n\">" +
                  figure(content.better->comparison.phases[k].rmse, given.judged_unit) + "</td>"
            : "");
  }
  return out + "</table>\n";
}

/// "/base/layers/0/stiffness_N_per_m" → layer 1 · stiffness.
NameAndUnit parameter_name(const std::string& pointer) {
  std::vector<std::string> parts;
  for (std::size_t from = pointer.starts_with("/") ? 1 : 0; from <= pointer.size();) {
    const std::size_t end = std::min(pointer.find('/', from), pointer.size());
    parts.push_back(pointer.substr(from, end - from));
    from = end + 1;
  }
  std::string component;
  if (parts.size() > 1 && parts.back().size() == 1 && std::isdigit(parts.back()[0])) {
    component = fmt::format(" {}", parts.back()[0] - '0' + 1);
    parts.pop_back();
  }
  NameAndUnit out = name_and_unit(parts.back());
  out.name += component;
  if (parts.size() >= 4 && parts[1] == "layers")
    out.name = fmt::format("layer {} · {}", std::atoi(parts[2].c_str()) + 1, out.name);
  else if (parts.size() > 1 && parts[parts.size() - 2] != "base")
    out.name = effects::label_of(parts[parts.size() - 2]) + " · " + out.name;
  return out;
}

std::string remark(const Estimate& e) {
  if (!e.informed) return "not informed by these recordings; left where it was";
  if (e.at_bound) return "at the edge of its range";
  if (std::abs(e.value) > 0.0 && e.sd > std::abs(e.value)) return "not told from zero";
  return "";
}

std::string parameter_row(const ReportContent& content, const Estimate& e) {
  const auto [name, unit] = parameter_name(e.pointer);
  const auto start = std::ranges::find(content.start, e.pointer, &Parameter::pointer);
  const bool base = e.pointer.starts_with("/");
  const bool given = base && start != content.start.end();
  const double interval = 1.96 * e.sd;
  const double change = given && start->start != 0.0 ? e.value / start->start - 1.0 : std::nan("");
  return fmt::format(
      "<tr><td>{}{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>"
      "<td class=\"n\">{}</td></tr>\n",
      escaped(name), remark(e).empty() ? "" : "<small>" + remark(e) + "</small>",
      given ? figure(start->start, unit) : "–",
      figure_with_uncertainty(e.value, interval) + " " + unit,
      std::isfinite(interval) && e.informed
          ? fmt::format("{} … {}", figure_with_uncertainty(e.value - interval, interval),
                        figure_with_uncertainty(e.value + interval, interval))
          : "–",
      std::isfinite(change) ? fmt::format("{:+.1f} %", 100.0 * change) : "–");
}

}  // namespace

std::string places(const ReportContent& content) {
  std::string body = regions(content.before);
  if (content.map)
    body += "<h3>On the wall of the tract</h3>\n" +
            tract_picture(*content.map, content.before.comparison.judged_unit);
  if (const std::string judged = judged_text(content.before.comparison); !judged.empty())
    body += "<p>" + escaped(judged) + "</p>\n";
  body += phase_table(content);
  if (content.better)
    body += "<h3>What is left, " + escaped(better_name(content)) + "</h3>\n" +
            (at_floor(*content.better) ? "<p>At the noise floor: nothing stands out.</p>\n"
                                       : regions(*content.better));
  return section("Where the model fails",
                 "Moments of the recordings that hold more of the error than their time alone "
                 "would; " +
                     escaped(content.before.comparison.error_regions.honest) + ".",
                 body);
}

std::string parameters(const ReportContent& content) {
  const Fit* fit = fit_of(content);
  if (!fit || fit->estimates.empty()) return {};
  std::string body =
      "<table>\n<tr><th>parameter</th><th class=\"n\">as given</th><th class=\"n\">fitted</th>"
      "<th class=\"n\">95 % interval</th><th class=\"n\">change</th></tr>\n";
  for (const Estimate& e : fit->estimates)
    if (!e.pointer.starts_with("/")) body += parameter_row(content, e);
  for (const Estimate& e : fit->estimates)
    if (e.pointer.starts_with("/")) body += parameter_row(content, e);
  body += "</table>\n";
  if (!fit->remarks.empty()) {
    body += "<ul class=\"note\">\n";
    for (const std::string& said : fit->remarks) body += "<li>" + escaped(said) + "</li>\n";
    body += "</ul>\n";
  }
  return section("Parameters",
                 "Fitted together. The parameters of a model that lacks an effect take its part: "
                 "they move when it is added.",
                 body);
}

std::string trials(const ReportContent& content) {
  const Comparison& given = content.before.comparison;
  const Fit* fit = fit_of(content);
  std::string body = fmt::format(
      "<table>\n<tr><th>trial</th><th class=\"n\">length</th><th class=\"n\">error "
      "{}</th>{}{}</tr>\n",
      content.before_name,
      content.better ? "<th class=\"n\">" + escaped(better_name(content)) + "</th>" : "",
      fit ? "<th class=\"n\">held out</th>" : "");
  for (std::size_t k = 0; k < given.trials.size(); ++k) {
    const auto& t = given.trials[k];
    body += fmt::format("<tr><td>{}</td><td class=\"n\">{:.1f} s</td><td class=\"n\">{}</td>",
                        escaped(t.id), t.duration_s, figure(t.rmse, given.judged_unit));
    if (content.better)
      body += fmt::format("<td class=\"n\">{}</td>",
                          figure(content.better->comparison.trials[k].rmse, given.judged_unit));
    if (fit) {
      const auto held = std::ranges::find(fit->trials, t.id, &TrialError::id);
      body += fmt::format(
          "<td class=\"n\">{}</td>",
          held == fit->trials.end() ? "–" : figure(held->held_out_rmse, given.judged_unit));
    }
    body += "</tr>\n";
  }
  return section("Trial by trial", "", body + "</table>\n");
}

std::string assumptions(const ReportContent& content) {
  std::vector<std::string> said = content.notes;
  if (content.diagnosis)
    for (const std::string& note : content.diagnosis->notes)
      if (std::ranges::find(said, note) == said.end()) said.push_back(note);
  said.push_back(
      "The noise floor is estimated from the recordings, what the set states taken in: noise of "
      "the force and of the motion as it passes through the model.");
  said.push_back(
      "The hand is taken to have moved as recorded, whatever the model would have answered.");
  said.push_back(
      "“Explained” is the share of what could be explained: (variance − error²) / "
      "(variance − noise²), 100 % at the noise floor.");
  if (content.simulated) said.push_back("The set says that its measurements are simulated.");
  std::string body = "<ul>\n";
  for (const std::string& line : said) body += "<li>" + escaped(line) + "</li>\n";
  return section("What was taken for granted", "", body + "</ul>\n");
}

}  // namespace lab::page
}  // namespace tractus
