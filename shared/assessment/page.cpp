#include "assessment/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plot/text.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using plot::escaped;

constexpr std::size_t kMostRows = 400;

constexpr const char* kStyle =
    "body{font:15px/1.45 system-ui,sans-serif;color:#1d2329;max-width:62rem;margin:2rem auto;"
    "padding:0 1rem}h1{font-size:1.6rem}h2{font-size:1.2rem;margin:2rem 0 .4rem;border-bottom:1px "
    "solid #d5dae0}h3{font-size:1rem;margin:1.2rem 0 .3rem}table{border-collapse:collapse;margin:"
    ".4rem 0 1rem;font-variant-numeric:tabular-nums;font-size:13px}th,td{padding:.15rem .6rem;"
    "text-align:right;border-bottom:1px solid "
    "#e5e9ed}th:first-child,td:first-child{text-align:left}"
    "td.l{text-align:left}th{color:#5b6470;font-weight:600}.w{border:1px solid "
    "#b3261e;background:#fdf3f2;padding:.5rem "
    ".8rem;border-radius:4px}.s{color:#5b6470;font-size:12px;overflow-wrap:anywhere}"
    "svg{max-width:100%;height:auto}.t{overflow-x:auto}@media print{body{margin:0;max-width:none}"
    "h2,h3{break-after:avoid}tr,svg{break-inside:avoid}}";

std::string title_of(const std::string& key) {
  std::string out = key;
  std::ranges::replace(out, '_', ' ');
  return out;
}

/// A row of cells; numbers keep every digit in their title.
std::string cell(const Json& value) {
  if (value.is_number_float() && std::isfinite(value.get<double>()))
    return fmt::format("<td title=\"{}\">{}</td>", value.dump(), readable(value));
  return (value.is_string() ? "<td class=\"l\">" : "<td>") + escaped(readable(value)) + "</td>";
}

}  // namespace

std::string readable(const Json& value) {
  if (value.is_null()) return "–";
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_integer()) return value.dump();
  if (!value.is_number()) return value.dump();
  const double number = value.get<double>();
  if (!std::isfinite(number)) return "–";
  return fmt::format("{:.5g}", number);
}

void Page::heading(std::string_view text) { body_ += "<h2>" + escaped(text) + "</h2>\n"; }
void Page::subheading(std::string_view text) { body_ += "<h3>" + escaped(text) + "</h3>\n"; }
void Page::paragraph(std::string_view text) { body_ += "<p>" + escaped(text) + "</p>\n"; }
void Page::warning(std::string_view text) { body_ += "<p class=\"w\">" + escaped(text) + "</p>\n"; }
void Page::small(std::string_view text) { body_ += "<p class=\"s\">" + escaped(text) + "</p>\n"; }

void Page::list(const Json& sentences) {
  if (sentences.empty()) return;
  body_ += "<ul>\n";
  for (const auto& one : sentences)
    body_ += "<li>" + escaped(one.get_ref<const std::string&>()) + "</li>\n";
  body_ += "</ul>\n";
}

void Page::table(const Json& values) {
  if (values.empty()) return;
  body_ += "<div class=\"t\"><table>\n";
  if (values.is_object()) {
    for (const auto& [key, value] : values.items())
      body_ += "<tr><th>" + escaped(title_of(key)) + "</th>" + cell(value) + "</tr>\n";
    body_ += "</table></div>\n";
    return;
  }
  std::vector<std::string> keys;
  for (const auto& row : values)
    for (const auto& [key, _] : row.items())
      if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
  body_ += "<tr>";
  for (const auto& key : keys) body_ += "<th>" + escaped(title_of(key)) + "</th>";
  body_ += "</tr>\n";
  const std::size_t shown = std::min(values.size(), kMostRows);
  for (std::size_t i = 0; i < shown; ++i) {
    body_ += "<tr>";
    for (const auto& key : keys)
      body_ += values[i].contains(key) ? cell(values[i][key]) : std::string("<td></td>");
    body_ += "</tr>\n";
  }
  body_ += "</table></div>\n";
  if (shown < values.size())
    small(fmt::format("… and {} more rows, in result.json", values.size() - shown));
}

void Page::figure(const plot::Figure& figure) {
  std::string svg = plot::svg(figure);
  // Inside a page the document is an element: no XML declaration before it.
  if (const auto at = svg.find("<svg"); at != std::string::npos) svg.erase(0, at);
  body_ += "<div>" + svg + "</div>\n";
}

std::string Page::html() const {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width,initial-scale=1\">\n<title>{0}</title>\n<style>{1}</style>"
      "</head><body>\n<h1>{0}</h1>\n{2}</body></html>\n",
      escaped(title_), kStyle, body_);
}

}  // namespace assessment
}  // namespace tractus
