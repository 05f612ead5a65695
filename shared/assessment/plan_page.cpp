#include "assessment/plan_page.hpp"

#include <fmt/format.h>

#include "assessment/page.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;

std::string joined(const Json& sentences) {
  std::string out;
  for (const auto& one : sentences)
    out += (out.empty() ? "" : " ") + one.get_ref<const std::string&>();
  return out;
}

void add_head(const Json& result, Page& page) {
  const auto& plan = result["plan"];
  const auto& data = result["data"];
  page.paragraph(plan["question"].get_ref<const std::string&>());
  if (const std::string endpoint = plan["endpoint"]; !endpoint.empty())
    page.paragraph("Endpoint: " + endpoint);
  if (data["simulated"] == true)
    page.warning("These data are simulated. Nothing here is a finding about people.");
  if (plan.contains("lock") && plan["lock"]["data_seen"] == true)
    page.warning(
        "The data were known when this plan was locked: a reanalysis, which can raise questions "
        "and confirm nothing.");
}

void add_families(const Json& result, Page& page) {
  page.heading("Results");
  page.list(result["results"]);
  for (const auto& family : result["families"]) {
    page.subheading(
        fmt::format("Family '{}': correction {}, level {}", family["name"].get<std::string>(),
                    family["correction"].get<std::string>(), readable(family["alpha"])));
    page.table(family["tests"]);
  }
}

/// The tables of one report: blocks and arrays, what is said about them last.
void add_report(const Json& report, Page& page) {
  for (const auto& [key, value] : report.items()) {
    if (key == "tests" || key == "notes" || key == "checks") continue;
    if (!value.is_array() && !value.is_object()) continue;
    if (value.empty()) continue;
    std::string title = key;
    for (char& c : title)
      if (c == '_') c = ' ';
    page.subheading(title);
    page.table(value);
  }
  if (report.contains("checks") && !report["checks"].empty()) {
    page.subheading("assumptions");
    page.table(report["checks"]);
  }
  if (report.contains("notes")) page.list(report["notes"]);
}

void add_analysis(const Json& one, const std::vector<plot::Figure>& figures, Page& page) {
  page.heading(fmt::format("{}: {}", one["id"].get<std::string>(),
                           one["question"].get_ref<const std::string&>()));
  std::string how = one["method"].get<std::string>();
  if (const std::string formula = one["formula"]; !formula.empty()) how += ": " + formula;
  if (const std::string where = one["where"]; !where.empty()) how += ", rows with " + where;
  page.small(how);
  if (one.contains("error")) return page.warning(one["error"].get_ref<const std::string&>());
  for (const auto& figure : figures) page.figure(figure);
  add_report(one["report"], page);
}

void add_published(const Json& published, Page& page) {
  if (published.empty()) return;
  page.heading("What was published, beside what is computed here");
  Json numbers = Json::array(), remarks = Json::array();
  for (const auto& one : published) {
    if (one.contains("printed"))
      numbers.push_back({{"where", one["where"]},
                         {"says", one["says"]},
                         {"printed", one["printed"]},
                         {"computed", one["computed"]},
                         {"agrees", one["agrees"]}});
    if (const std::string remark = one["remark"]; !remark.empty())
      remarks.push_back(one["where"].get<std::string>() + ": " + remark);
  }
  page.table(numbers);
  if (remarks.empty()) return;
  page.subheading("Slips in the publication, and what is to be known");
  page.list(remarks);
}

}  // namespace

std::string report_page(const Analysed& analysed) {
  const Json& result = analysed.result;
  Page page(result["plan"]["title"]);
  add_head(result, page);
  add_families(result, page);
  add_published(result["published"], page);
  for (std::size_t i = 0; i < result["analyses"].size(); ++i)
    add_analysis(result["analyses"][i], analysed.figures[i], page);
  page.heading("Methods");
  page.paragraph(joined(result["methods"]));
  page.heading("Data");
  page.table(Json(result["data"]["exclusions"]));
  page.small(fmt::format("Plan {} · data {} · every number of this page is in result.json.",
                         result["plan"]["sha256"].get<std::string>(),
                         result["data"]["sha256"].get<std::string>()));
  return page.html();
}

}  // namespace assessment
}  // namespace tractus
