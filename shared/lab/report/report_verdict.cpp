/// The report's answers: verdict, falling error, ranking, what is undecided.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "effects/catalogues.hpp"
#include "lab/identify/verdict_text.hpp"
#include "lab/report/report_parts.hpp"
#include "plot/text.hpp"

namespace tractus {
namespace lab::page {
namespace {

using plot::escaped;

std::string key_figure(const std::string& what, const std::string& value,
                       const std::string& small) {
  return fmt::format("<div><dt>{}</dt><dd>{}<small>{}</small></dd></div>\n", what, value, small);
}

std::string against_floor(double rmse, double floor) {
  return floor > 0.0 ? fmt::format("{:.3g} × the noise", rmse / floor) : "";
}

/// The sentences when nothing was diagnosed: a comparison or a fit alone.
VerdictText plain(const ReportContent& content) {
  const Comparison& given = content.before.comparison;
  const std::string& unit = given.judged_unit;
  if (content.better)
    return {fmt::format("Fitted: the error falls from {} to {}.", figure(given.rmse, unit),
                        figure(content.better->comparison.rmse, unit)),
            fmt::format("The noise floor of these measurements is {}.",
                        figure(given.noise_floor, unit))};
  return {
      fmt::format("The model is off by {}.", figure(given.rmse, unit)),
      fmt::format("Of what could be explained in {} it explains {}; the noise floor of these "
                  "measurements is {}.",
                  given.judged_name, percent(given.explained), figure(given.noise_floor, unit))};
}

const effects::EffectFacts* facts(const ReportContent& content, const std::string& id) {
  for (const Candidate& candidate : content.catalogue)
    if (candidate.facts.id == id) return &candidate.facts;
  return nullptr;
}

std::string ranked_row(const ReportContent& content, const Ranked& ranked) {
  const std::string& unit = content.before.comparison.judged_unit;
  const auto* known = facts(content, ranked.id);
  const bool found = std::ranges::any_of(content.diagnosis->effects,
                                         [&](const auto& e) { return e.id == ranked.id; });
  std::string small = known ? escaped(known->equation) : "";
  if (!ranked.note.empty()) small += (small.empty() ? "" : " · ") + escaped(ranked.note);
  for (const DetectionLimit& limit : ranked.detection_limits) {
    small += &limit == &ranked.detection_limits.front()
                 ? small.empty() ? "detectable from " : " · detectable from "
                 : ", ";
    small += escaped(text_of(limit));
  }
  return fmt::format(
      "<tr><td>{}{}{}<small>{}</small></td><td class=\"wide\">{}</td><td class=\"n\">{}</td>"
      "<td class=\"n\">{}</td></tr>\n",
      found ? "<strong>" : "", escaped(effects::label_of(ranked.id)), found ? "</strong>" : "",
      small, bar(ranked.probability, found ? "" : "quiet"), percent(ranked.probability),
      ranked.held_out_rmse ? figure(*ranked.held_out_rmse, unit) : "not tried");
}

/// "whether it is a or b", "whether b is missing too".
std::string what_it_tells(const DiscriminatingExperiment& experiment) {
  std::vector<std::string> effects;
  for (const std::string& id : experiment.between)
    if (id != "nothing") effects.push_back(effects::label_of(id));
  return effects.size() == 1 ? fmt::format("whether {} is there at all", effects[0])
                             : fmt::format("whether it is {}", fmt::join(effects, " or "));
}

std::string bars(const Step& step, const std::string& unit, double largest, double floor,
                 bool first) {
  const auto line = [&](double rmse, const char* kind) {
    return fmt::format(R"(<div class="line{}"><i style="width:{:.2f}%"></i><b>{}</b></div>)", kind,
                       std::isfinite(rmse) ? 100.0 * rmse / largest : 0.0, figure(rmse, unit));
  };
  const bool plus = step.model.starts_with("+ ");
  const std::string label =
      plus ? "+ " + effects::label_of(step.model.substr(2)) : step.model + " model, refitted";
  return fmt::format(
      "<div>{}</div><div class=\"track{}\"><div style=\"position:relative\">"
      "<div class=\"floor\" style=\"left:{:.2f}%\"></div>{}{}</div></div>\n",
      escaped(label), first ? " first" : "", 100.0 * floor / largest, line(step.rmse, ""),
      line(step.held_out_rmse, " held"));
}

}  // namespace

std::string verdict(const ReportContent& content) {
  const Comparison& given = content.before.comparison;
  const std::string& unit = given.judged_unit;
  const VerdictText said = content.stated
                               ? VerdictText{content.stated->headline, content.stated->detail}
                               : plain(content);
  std::string figures = key_figure("Error as given", figure(content.given_rmse, unit),
                                   against_floor(content.given_rmse, given.noise_floor));
  if (content.diagnosis && !content.diagnosis->effects.empty())
    figures += key_figure("Refitted, held out", figure(content.diagnosis->base.held_out_rmse, unit),
                          against_floor(content.diagnosis->base.held_out_rmse, given.noise_floor));
  if (content.diagnosis && !content.diagnosis->steps.empty()) {
    const Step& last = content.diagnosis->steps.back();
    figures += key_figure(
        content.diagnosis->effects.empty() ? "Refitted, held out" : "With it, held out",
        figure(last.held_out_rmse, unit), against_floor(last.held_out_rmse, given.noise_floor));
  } else if (content.better) {
    figures += key_figure("Fitted", figure(content.better->comparison.rmse, unit),
                          against_floor(content.better->comparison.rmse, given.noise_floor));
  }
  figures += key_figure("Noise floor", figure(given.noise_floor, unit), "of these measurements");
  if (content.stated && std::isfinite(content.stated->probability))
    figures += key_figure("Probability", percent(content.stated->probability),
                          "that this answer is right");
  return fmt::format(
      "<section class=\"verdict {}\">\n<h2>{}</h2>\n<p>{}</p>\n"
      "<dl class=\"figures\">\n{}</dl>\n</section>\n",
      content.stated ? name(content.stated->verdict) : "", escaped(said.headline),
      unbroken(escaped(said.detail), unit), figures);
}

std::string falling_error(const ReportContent& content) {
  if (!content.diagnosis || content.diagnosis->steps.empty()) return {};
  const std::string& unit = content.before.comparison.judged_unit;
  const double floor = content.diagnosis->base.noise_floor;
  double largest = floor;
  for (const Step& step : content.diagnosis->steps)
    for (const double rmse : {step.rmse, step.held_out_rmse})
      if (std::isfinite(rmse)) largest = std::max(largest, rmse);
  if (!(largest > 0.0)) return {};
  std::string body = "<div class=\"steps\">\n";
  for (const Step& step : content.diagnosis->steps)
    body += bars(step, unit, largest, floor, &step == &content.diagnosis->steps.front());
  body +=
      "</div>\n<div class=\"key\"><span><i></i>on the measurements it was fitted to</span>"
      "<span><i class=\"held\"></i>on held-out measurements</span>"
      "<span><i class=\"dash\"></i>noise floor, " +
      figure(floor, unit) + "</span></div>\n";
  return section("The error, step by step",
                 fmt::format("Held out were {}: each is predicted by a model fitted without it.",
                             escaped(content.diagnosis->final_fit.folds)),
                 body);
}

std::string ranking(const ReportContent& content) {
  if (!content.diagnosis || content.diagnosis->ranking.empty()) return {};
  const std::string head =
      "<table>\n<tr><th>effect</th><th>probability</th><th class=\"n\"></th>"
      "<th class=\"n\">held-out error</th></tr>\n";
  std::string shown, rest;
  std::size_t n = 0, others = 0;
  for (const Ranked& ranked : content.diagnosis->ranking) {
    const bool early = n++ < 6 || ranked.probability >= 0.01;
    (early ? shown : rest) += ranked_row(content, ranked);
    others += !early;
  }
  std::string body = head + shown + "</table>\n";
  if (others > 0)
    body += fmt::format(
        "<details><summary>The other {} of the catalogue</summary>\n{}{}</table>\n"
        "</details>\n",
        others, head, rest);
  return section("What could be missing",
                 "Every effect of the catalogue, fitted together with the model and judged on "
                 "measurements that the fit did not see.",
                 body);
}

std::string undecided(const ReportContent& content) {
  if (!content.diagnosis) return {};
  std::string body;
  for (const auto& [a, b] : content.diagnosis->confounded)
    body += fmt::format("<li>{} and {}</li>\n", escaped(effects::label_of(a)),
                        escaped(effects::label_of(b)));
  if (!body.empty())
    body = "<p>These recordings can hardly tell apart:</p><ul>\n" + body + "</ul>\n";
  if (const auto& experiment = content.diagnosis->discriminating_experiment) {
    body += fmt::format(
        "<div class=\"ask\"><b>Record next: {}</b>It would tell {}{}.</div>\n",
        escaped(experiment->recording), escaped(what_it_tells(*experiment)),
        experiment->expected_gain
            ? fmt::format(
                  "; in simulated recordings the probability of the true answer rises by {}",
                  percent(*experiment->expected_gain))
            : "");
  }
  return section("What these recordings cannot tell", "", body);
}

}  // namespace lab::page
}  // namespace tractus
