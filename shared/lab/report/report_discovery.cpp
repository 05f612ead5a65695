/// The report's part on what no catalogue has: formulas that were found, and the function without a formula as a table.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "lab/identify/verdict_text.hpp"
#include "lab/report/report_parts.hpp"
#include "plot/figure.hpp"
#include "plot/text.hpp"

namespace tractus {
namespace lab::page {
namespace {

using plot::escaped;

std::string proposals(const Discovery& found, const std::string& unit) {
  if (found.proposals.empty()) return {};
  std::string out =
      "<table>\n<tr><th>formula</th><th>resembles</th><th class=\"n\">error held out</th>"
      "<th class=\"n\">probability</th></tr>\n";
  for (const Proposal& p : found.proposals) {
    std::vector<std::string> words;
    for (const ProposedTerm& term : p.terms) words.push_back(term.words);
    out += fmt::format(
        "<tr><td>{}</td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
        escaped(formula_text(p)), escaped(fmt::format("{}", fmt::join(words, "; "))),
        figure(p.held_out_rmse, unit), percent(p.probability));
  }
  return out + "</table>\n";
}

std::string heading(const UnknownFunction& function, std::size_t signal) {
  return fmt::format("{}, {}", function.signals[signal], function.units[signal]);
}

/// The force over one signal.
std::string drawn(const UnknownFunction& function) {
  plot::Figure figure;
  figure.width_px = 720;
  plot::Panel panel;
  panel.x_label = heading(function, 0);
  panel.y_label = "force, N";
  panel.height_px = 220;
  panel.lines.push_back({"", function.knots[0], function.force_N, kBetterColour, 1.6});
  figure.panels.push_back(std::move(panel));
  return plot::svg(figure);
}

std::string cells(const std::vector<double>& values) {
  std::string out;
  for (const double value : values) out += fmt::format("<td class=\"n\">{}</td>", figure(value));
  return out;
}

/// Of one signal two rows; of two, the first downwards and the second across.
std::string table_of(const UnknownFunction& function) {
  if (function.signals.size() == 1)
    return fmt::format("<table>\n<tr><th>{}</th>{}</tr>\n<tr><th>force, N</th>{}</tr>\n</table>\n",
                       escaped(heading(function, 0)), cells(function.knots[0]),
                       cells(function.force_N));
  const auto& down = function.knots[0];
  const auto& across = function.knots[1];
  std::string out =
      fmt::format("<table>\n<tr><th>force, N; down: {}, across: {}</th>{}</tr>\n",
                  escaped(heading(function, 0)), escaped(heading(function, 1)), cells(across));
  for (std::size_t row = 0; row < down.size(); ++row) {
    const auto from = function.force_N.begin() + std::ptrdiff_t(row * across.size());
    out += fmt::format("<tr><th>{}</th>{}</tr>\n", figure(down[row]),
                       cells({from, from + std::ptrdiff_t(across.size())}));
  }
  return out + "</table>\n";
}

std::string without_formula(const Discovery& found) {
  if (!found.unknown) return {};
  const UnknownFunction& function = *found.unknown;
  std::string out = fmt::format(
      "<h3>Without a formula</h3>\n<p>The function of {} that takes away most. It is a table, not "
      "a law. Probability that what is missing is in no formula that was tried: {}.</p>\n",
      escaped(fmt::format("{}", fmt::join(function.signals, " and "))),
      percent(found.unknown_probability));
  if (function.signals.size() == 1) out += drawn(function);
  return out + table_of(function);
}

}  // namespace

std::string discovery(const ReportContent& content) {
  if (!content.discovery) return {};
  const Discovery& found = *content.discovery;
  std::string body = proposals(found, content.before.comparison.judged_unit);
  if (!found.remark.empty())
    body += fmt::format("<p>No formula is proposed: {}.</p>\n", escaped(found.remark));
  body += without_formula(found);
  return section(
      "What no catalogue has",
      found.formulas_tried > 0
          ? fmt::format("Of {} formulas of place, speed, turning and memory.", found.formulas_tried)
          : "",
      body);
}

}  // namespace lab::page
}  // namespace tractus
