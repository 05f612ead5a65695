#include "lab/report/report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "effects/catalogues.hpp"
#include "lab/identify/verdict_text.hpp"
#include "lab/report/report_parts.hpp"
#include "plot/text.hpp"

namespace tractus {
namespace lab {
namespace page {

std::string section(const std::string& title, const std::string& lead, const std::string& body) {
  if (body.empty()) return {};
  return fmt::format("<section>\n<h2>{}</h2>\n{}{}</section>\n", title,
                     lead.empty() ? "" : "<p class=\"lead\">" + lead + "</p>\n", body);
}

std::string bar(double share, const std::string& kind) {
  const double width = std::isfinite(share) ? 100.0 * std::min(1.0, std::max(0.0, share)) : 0.0;
  return fmt::format(R"(<div class="bar {}"><i style="width:{:.1f}%"></i></div>)", kind, width);
}

std::string percent(double share) {
  if (!std::isfinite(share)) return "–";
  const double hundred = 100.0 * share;
  if (hundred > 0.0 && hundred < 0.1) return "&lt; 0.1 %";
  if (hundred > 99.0 && hundred < 99.95) return fmt::format("{:.1f} %", hundred);
  return hundred < 1.0 && hundred > 0.0 ? fmt::format("{:.1f} %", hundred)
                                        : fmt::format("{:.0f} %", hundred);
}

std::string unbroken(std::string text, const std::string& unit) {
  const std::string loose = " " + unit;
  for (auto at = text.find(loose); at != std::string::npos; at = text.find(loose, at + 1))
    if (at > 0 && text[at - 1] >= '0' && text[at - 1] <= '9') text.replace(at, 1, "&nbsp;");
  return text;
}

std::string better_name(const ReportContent& content) {
  if (!content.diagnosis) return "fitted";
  const auto& effects = content.diagnosis->effects;
  if (effects.empty()) return "refitted";
  return effects.size() == 1 ? "with " + effects::label_of(effects[0].id) : "with what was found";
}

}  // namespace page

std::string report(const ReportContent& content) {
  const std::string title = fmt::format("{} against {}", plot::escaped(content.model_name),
                                        plot::escaped(content.set_name));
  std::string out = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
      "<title>Model lab: {}</title>\n<link rel=\"icon\" href=\"data:,\">\n"
      "<style>{}</style>\n</head>\n<body>\n<main>\n",
      title, page::kStyle);
  out += fmt::format(
      "<header><h1>Model lab</h1><p>{}{}</p></header>\n", title,
      content.simulated ? " · <strong>these measurements are simulated themselves</strong>" : "");
  for (const auto part :
       {page::verdict, page::falling_error, page::overlays, page::places, page::ranking,
        page::parameters, page::undecided, page::distributions, page::trials, page::assumptions})
    out += part(content);
  return out +
         "<footer>Made by Tractus. For training and research; not a medical device.</footer>\n"
         "</main>\n</body>\n</html>\n";
}

}  // namespace lab
}  // namespace tractus
