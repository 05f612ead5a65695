/// A report as a page to print and to sign.
#include <fmt/format.h>

#include "core/clock.hpp"
#include "plot/text.hpp"
#include "station/check/findings.hpp"

namespace tractus {
namespace check {
namespace {
using plot::escaped;

constexpr const char* kStyle = R"(
@page{size:A4;margin:13mm}
body{font:14px/1.45 system-ui,"DejaVu Sans",sans-serif;max-width:48rem;margin:2rem auto;padding:0 1rem;
 color:#14181d;background:#fff}
h1{font-size:1.6rem;margin:0 0 .2rem}h2{font-size:1.1rem;margin:1.6rem 0 .4rem}
p{margin:.3rem 0}.quiet{color:#555}
.verdict{border:2px solid #1b6e3a;color:#1b6e3a;padding:.5rem .8rem;margin:1rem 0;font-weight:600}
.verdict.no{border-color:#a3161a;color:#a3161a}
.mark{border:1px solid #8a5a00;color:#8a5a00;padding:.1rem .4rem;font-weight:600}
table{border-collapse:collapse;width:100%;font-size:.92em}
th,td{text-align:left;padding:.35rem .5rem;border-bottom:1px solid #c9ced4;vertical-align:top}
.checks td:nth-child(1){width:27%}.checks td:nth-child(-n+4):not(:first-child){white-space:nowrap}
td{font-variant-numeric:tabular-nums}
thead{display:table-header-group}tr{break-inside:avoid}
.no td:nth-child(2){color:#a3161a;font-weight:700}
.sign{margin-top:3.5rem;display:flex;gap:2.5rem;break-inside:avoid}
.sign div{flex:1;border-top:1px solid #14181d;padding-top:.3rem;font-size:.9em}
@media print{body{margin:0;padding:0;max-width:none;font-size:8.5pt}
 td,th{padding:.2rem .4rem}.sign{margin-top:2rem}})";

constexpr const char* kMark = " <span class=mark>SIMULATED: no machine was tested</span>";

std::string verdict_of(const SelfTest& test) {
  std::size_t failed = 0;
  for (const Finding& f : test.findings) failed += f.passed ? 0 : 1;
  if (failed == 0 && !test.findings.empty())
    return fmt::format("<p class=verdict>All {} checks passed.</p>\n", test.findings.size());
  return fmt::format("<p class=\"verdict no\">{} of {} checks did not pass.</p>\n", failed,
                     test.findings.size());
}

std::string or_dash(const std::string& text) { return text.empty() ? "–" : escaped(text); }

std::string table_of(const std::vector<Finding>& findings) {
  std::string out =
      "<table class=checks><thead><tr><th>Check<th>Outcome<th>Found<th>Wanted<th>What was seen, "
      "what to do</tr></thead>\n<tbody>";
  for (const Finding& f : findings)
    out += fmt::format("<tr{}><td>{}<td>{}<td>{}<td>{}<td>{}</tr>\n", f.passed ? "" : " class=no",
                       escaped(f.name), f.passed ? "passed" : "NOT passed", or_dash(found_of(f)),
                       or_dash(wanted_of(f)), escaped(f.words));
  return out + "</tbody></table>\n";
}

/// "2026-03-01 12:00 UTC"
std::string minute_of(std::int64_t utc_us) {
  std::string text = core::utc_text(utc_us).substr(0, 16);
  return text.replace(10, 1, " ") + " UTC";
}

std::string section_of(const Calibration& calibration) {
  return fmt::format(
      "<p class=verdict>Calibrated. Due again on {}.</p>\n<table><tbody>"
      "<tr><td>Device<td>{}{}</tr><tr><td>Done<td>{}</tr><tr><td>By<td>{}</tr>"
      "<tr><td>Found<td>{}</tr></tbody></table>\n",
      day_of(calibration.due_utc_us), escaped(calibration.kind), calibration.simulated ? kMark : "",
      minute_of(calibration.at_utc_us), escaped(calibration.who), escaped(calibration.words));
}
}  // namespace

std::string Report::to_html(const std::string& station) const {
  const char* const kind = self_test ? "Self-test" : "Calibration";
  std::string out = fmt::format(
      "<!doctype html><html lang=en><meta charset=utf-8><meta name=color-scheme content=light>"
      "<title>{0}: {1}</title><style>{2}</style>\n<h1>{1} of {0}</h1>\n"
      "<p class=quiet>Tractus {3}; {4:.1f} GB free on its disk</p>\n",
      escaped(station), kind, kStyle, escaped(version), 1e-9 * double(free_disk_bytes));
  if (self_test) {
    out += fmt::format("<p>{}. Device: <b>{}</b>{}</p>\n", minute_of(self_test->at_utc_us),
                       escaped(self_test->device), self_test->simulated ? kMark : "");
    out += verdict_of(*self_test) + table_of(self_test->findings);
  }
  if (calibration) out += section_of(*calibration);
  if (calibration && !checks.empty()) out += "<h2>Checks</h2>\n" + table_of(checks);
  return out + "<div class=sign><div>Name</div><div>Date</div><div>Signature</div></div></html>\n";
}

}  // namespace check
}  // namespace tractus
