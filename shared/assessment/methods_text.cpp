#include "assessment/methods_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tractus {
namespace assessment {
namespace {

using core::Json;

std::string number(const Json& value, const char* format = "{:.3g}") {
  if (!value.is_number()) return "undefined";
  return fmt::format(fmt::runtime(format), value.get<double>());
}

/// 2 as "2", 1.9420 as "1.94".
std::string df(const Json& value) {
  const double n = value.get<double>();
  return n == std::floor(n) ? fmt::format("{:.0f}", n) : fmt::format("{:.2f}", n);
}

std::string correction_named(const std::string& id) {
  if (id == "holm") return "Holm's step-down procedure";
  if (id == "hommel") return "Hommel's procedure";
  if (id == "hochberg") return "Hochberg's step-up procedure";
  if (id == "bonferroni") return "Bonferroni's correction";
  if (id == "benjamini-hochberg") return "the Benjamini-Hochberg procedure";
  if (id == "benjamini-yekutieli") return "the Benjamini-Yekutieli procedure";
  return "no correction";
}

std::string sample_sentence(const Json& data, const std::string& subject) {
  std::string out = fmt::format("{} row{} of {} were analysed", data["rows_used"].get<long>(),
                                data["rows_used"] == 1 ? "" : "s",
                                data["simulated"] == true ? "simulated data" : "data");
  if (data["subjects"].get<long>() > 0)
    out += fmt::format(", from {} {}s", data["subjects"].get<long>(), subject);
  std::string left;
  for (const auto& one : data["exclusions"])
    left += fmt::format("{}{} ({})", left.empty() ? "" : ", ", one["rows"].get<long>(),
                        one["reason"].get<std::string>());
  const long dropped = data["rows"].get<long>() - data["rows_used"].get<long>();
  if (!left.empty())
    out += fmt::format("; by the plan's exclusions {} of {} rows were left out: {}", dropped,
                       data["rows"].get<long>(), left);
  return out + ".";
}

std::string lock_sentence(const Json& plan, const Json& data) {
  if (!plan.contains("lock")) return "The plan was not locked: everything here is exploratory.";
  const auto& lock = plan["lock"];
  const std::string when = lock["utc"], frozen = data["frozen_utc"];
  std::string out = fmt::format("The plan (SHA-256 {}) was locked by {} on {}",
                                plan["sha256"].get<std::string>().substr(0, 12),
                                lock["who"].get<std::string>(), when);
  if (lock["data_seen"] == true)
    return out + ", who had seen the data: this is a reanalysis and confirms nothing.";
  if (!frozen.empty())
    out += when < frozen ? fmt::format(", before the data were frozen on {}", frozen)
                         : fmt::format(", after the data were frozen on {}", frozen);
  return out + ".";
}

/// What the study was planned for, beside what it has.
std::string power_sentence(const Json& one, const Json& data) {
  const auto& report = one["report"];
  const auto& answer = report["answer"];
  std::string out = fmt::format("'{}': planned for {} {} and an effect of {}, power {}",
                                one["id"].get<std::string>(), number(answer["n"], "{:.0f}"),
                                answer["counts"].get<std::string>(),
                                number(report["design"]["effect"]), number(answer["power"]));
  if (answer.contains("monte_carlo95_low"))
    out += fmt::format(" by simulation (95 % interval {} to {})",
                       number(answer["monte_carlo95_low"]), number(answer["monte_carlo95_high"]));
  if (const long subjects = data["subjects"].get<long>(); subjects > 0)
    out += fmt::format("; the data have {} subjects", subjects);
  return out + ".";
}

}  // namespace

std::string worded_p(double p) {
  if (!std::isfinite(p)) return "p undefined";
  if (p < 0.001) return "p < 0.001";
  return fmt::format("p = {:.3g}", p);
}

std::string worded(const Json& test) {
  std::string out;
  if (test.contains("statistic") && test["statistic"] != "exact") {
    std::string name = test["statistic"];
    if (name == "chi2") name = "χ²";
    std::string freedom;
    if (test.contains("df1") && test.contains("df2"))
      freedom = fmt::format("({}, {})", df(test["df1"]), df(test["df2"]));
    else if (test.contains("df1") || test.contains("df2"))
      freedom = fmt::format("({})", df(test.contains("df1") ? test["df1"] : test["df2"]));
    out = fmt::format("{}{} = {}, ", name, freedom, number(test["value"]));
  }
  out += worded_p(test["p"].is_number() ? test["p"].get<double>() : std::nan(""));
  if (!test.contains("effect")) return out;
  out += fmt::format(", {} {}", test["effect"].get<std::string>(), number(test["size"]));
  if (test.contains("ci95_low"))
    out += fmt::format(" (95 % interval {} to {})", number(test["ci95_low"]),
                       number(test["ci95_high"]));
  return out;
}

std::vector<std::string> methods_sentences(const Plan& plan, const Json& result) {
  std::vector<std::string> out{sample_sentence(result["data"], plan.subject)};
  std::vector<std::string> said;
  for (const auto& one : result["analyses"]) {
    const auto method = method_named(one["method"]);
    if (!method) continue;
    std::string sentence =
        fmt::format("Analysis '{}' used {}", one["id"].get<std::string>(), method->cites);
    if (const std::string formula = one["formula"]; !formula.empty())
      sentence += fmt::format(" ({})", formula);
    if (const std::string where = one["where"]; !where.empty())
      sentence += fmt::format(", on rows with {}", where);
    if (one.contains("report") && one["report"].contains("rows"))
      sentence += fmt::format("; n = {} rows", one["report"]["rows"].get<long>());
    if (one.contains("report"))
      if (const long left = one["report"].value("rows_left_out", 0L); left > 0)
        sentence += fmt::format(", {} left out for missing values", left);
    out.push_back(sentence + ".");
  }
  for (const auto& family : result["families"])
    out.push_back(
        fmt::format("The p-values of the {} test{} of the family '{}' were adjusted by {}.",
                    family["tests"].size(), family["tests"].size() == 1 ? "" : "s",
                    family["name"].get<std::string>(), correction_named(family["correction"])));
  out.push_back(fmt::format("The level of significance is {}.", number(result["plan"]["alpha"])));
  out.push_back(lock_sentence(result["plan"], result["data"]));
  return out;
}

std::vector<std::string> results_sentences(const Json& result) {
  std::vector<std::string> out;
  for (const auto& family : result["families"])
    for (const auto& test : family["tests"]) {
      if (test.contains("note")) {
        out.push_back(fmt::format("{}: '{}' {}.", family["name"].get<std::string>(),
                                  test["analysis"].get<std::string>(),
                                  test["note"].get<std::string>()));
        continue;
      }
      const double p = test["p_adjusted"].get<double>();
      out.push_back(fmt::format("{}: {} ({}): {}; adjusted {}: {}.",
                                family["name"].get<std::string>(), test["term"].get<std::string>(),
                                test["analysis"].get<std::string>(), worded(test), worded_p(p),
                                test["holds"] == true
                                    ? "the null hypothesis is rejected"
                                    : "no evidence against the null hypothesis, which is not shown "
                                      "to be true"));
    }
  for (const auto& one : result["analyses"])
    if (one["method"] == "power" && one.contains("report"))
      out.push_back(power_sentence(one, result["data"]));
  for (const auto& one : result["analyses"])
    if (one.contains("error"))
      out.push_back(fmt::format("'{}' could not be done: {}.", one["id"].get<std::string>(),
                                one["error"].get<std::string>()));
  return out;
}

}  // namespace assessment
}  // namespace tractus
