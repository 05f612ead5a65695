#include "assessment/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "assessment/method.hpp"
#include "assessment/report.hpp"
#include "core/bytes.hpp"
#include "core/try.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Fields;
using core::Json;

constexpr std::size_t kMostEntries = 1000;

/// The elements of an array member, each an object. Nothing when it is not there.
std::vector<const Json*> elements(Fields& fields, const char* key) {
  std::vector<const Json*> out;
  const Json* array = fields.member(key, false);
  if (!array) return out;
  if (!array->is_array() || array->size() > kMostEntries) {
    fields.wrong(key, fmt::format("should be an array of at most {} objects", kMostEntries));
    return out;
  }
  for (const auto& element : *array) {
    if (!element.is_object()) {
      fields.wrong(key, "should hold objects alone");
      return {};
    }
    out.push_back(&element);
  }
  return out;
}

core::Result<Exclusion> exclusion_of(const Json& json, const std::string& where) {
  Fields fields(json, where);
  const std::string condition = fields.text("where"), reason = fields.text("reason");
  if (reason.empty() && fields.has("reason")) fields.wrong("reason", "should say why");
  TRY(fields.done());
  auto filter = Filter::parse(condition);
  if (!filter) return core::bad_input(where + "/where: " + filter.error().what);
  return Exclusion{std::move(*filter), condition, reason};
}

core::Result<std::map<std::string, std::string>> options_of(const Json* json,
                                                            const std::string& where) {
  std::map<std::string, std::string> out;
  if (!json) return out;
  if (!json->is_object()) return core::bad_input(where + "/options: should be an object");
  for (const auto& [key, value] : json->items()) {
    if (!value.is_string() && !value.is_number())
      return core::bad_input(where + "/options/" + key + ": should be a text or a number");
    out.emplace(key, value.is_string() ? value.get<std::string>() : value.dump());
  }
  return out;
}

bool is_name(const std::string& id) {
  return !id.empty() && id.size() <= 60 && std::ranges::all_of(id, [](unsigned char c) {
    return std::isalnum(c) || c == '-' || c == '_';
  });
}

/// Method, options, formula and condition are what they should be.
core::Result<void> check_analysis(PlannedAnalysis& one, const std::string& where) {
  if (!is_name(one.id))
    return core::bad_input(where + "/id: letters, digits, '-' and '_' are expected");
  const auto method = method_named(one.method);
  if (!method) return core::bad_input(where + "/method: " + method.error().what);
  const auto complete_options = complete(*method, one.options);
  if (!complete_options)
    return core::bad_input(where + "/options: " + complete_options.error().what);
  if (!method->formula.empty()) {
    const auto formula = parse_formula(one.formula);
    if (!formula) return core::bad_input(where + "/formula: " + formula.error().what);
  }
  if (one.where.empty()) return {};
  auto filter = Filter::parse(one.where);
  if (!filter) return core::bad_input(where + "/where: " + filter.error().what);
  one.filter = std::move(*filter);
  return {};
}

core::Result<PlannedAnalysis> analysis_of(const Json& json, const std::string& where) {
  Fields fields(json, where);
  PlannedAnalysis out;
  out.id = fields.text("id");
  out.question = fields.text_or("question", "");
  out.family = fields.text_or("family", "");
  out.method = fields.text("method");
  out.formula = fields.text_or("formula", "");
  out.term = fields.text_or("term", "");
  out.where = fields.text_or("where", "");
  auto options = TRY(options_of(fields.member("options", false), where));
  out.options = std::move(options);
  TRY(fields.done());
  TRY(check_analysis(out, where));
  return out;
}

core::Result<Published> published_of(const Json& json, const std::string& where) {
  Fields fields(json, where);
  Published out;
  out.where = fields.text("where");
  out.says = fields.text_or("says", "");
  out.remark = fields.text_or("remark", "");
  out.analysis = fields.text_or("analysis", "");
  out.at = fields.text_or("at", "");
  out.within = fields.number_or("within", 0.0, 0.0, 1e300);
  if (fields.has("printed")) out.printed = fields.number("printed", -1e300, 1e300);
  if (out.printed && out.at.empty()) fields.wrong("printed", "needs 'analysis' and 'at'");
  for (const auto* number : elements(fields, "numbers")) {
    Fields one(*number, where + "/numbers");
    const std::string analysis = one.text("analysis"), at = one.text("at");
    out.numbers.emplace_back(analysis, at);
    TRY(one.done());
  }
  TRY(fields.done());
  return out;
}

core::Result<std::optional<Lock>> lock_of(const Json* json, const std::string& where) {
  if (!json) return std::optional<Lock>();
  if (!json->is_object()) return core::bad_input(where + "/lock: should be an object");
  Fields fields(*json, where + "/lock");
  Lock out{fields.text("who"), fields.text("utc"), false, fields.text("sha256")};
  const Json* seen = fields.member("data_seen");
  if (seen && !seen->is_boolean()) fields.wrong("data_seen", "should be true or false");
  TRY(fields.done());
  out.data_seen = seen->get<bool>();
  return std::optional<Lock>(out);
}

/// Reads every element by `read`; errors name the place.
template <class T>
core::Result<void> read_all(const std::vector<const Json*>& from, const std::string& where,
                            core::Result<T> (*read)(const Json&, const std::string&),
                            std::vector<T>& out) {
  for (std::size_t i = 0; i < from.size(); ++i) {
    auto one = TRY(read(*from[i], fmt::format("{}/{}", where, i)));
    out.push_back(std::move(one));
  }
  return {};
}

core::Result<void> check_names(const Plan& plan, const std::string& name) {
  std::set<std::string> ids;
  for (const auto& one : plan.analyses)
    if (!ids.insert(one.id).second)
      return core::bad_input(
          fmt::format("{}: /analyses: the id '{}' stands there twice", name, one.id));
  for (const auto& one : plan.published) {
    if (!one.analysis.empty() && !ids.contains(one.analysis))
      return core::bad_input(
          fmt::format("{}: /published: there is no analysis '{}'", name, one.analysis));
    for (const auto& [analysis, _] : one.numbers)
      if (!ids.contains(analysis))
        return core::bad_input(
            fmt::format("{}: /published: there is no analysis '{}'", name, analysis));
  }
  return {};
}

}  // namespace

std::optional<statistics::Adjustment> adjustment_named(const std::string& name) {
  using statistics::Adjustment;
  static const std::map<std::string, Adjustment> kNames = {
      {"holm", Adjustment::holm},
      {"hommel", Adjustment::hommel},
      {"hochberg", Adjustment::hochberg},
      {"bonferroni", Adjustment::bonferroni},
      {"benjamini-hochberg", Adjustment::benjamini_hochberg},
      {"benjamini-yekutieli", Adjustment::benjamini_yekutieli}};
  const auto at = kNames.find(name);
  return at == kNames.end() ? std::nullopt : std::optional(at->second);
}

core::Result<Plan> Plan::from_json(const Json& json, const std::string& name) {
  if (!json.is_object()) return core::bad_input(name + ": should be a JSON object");
  Fields fields(json, name + ": ");
  Plan out;
  if (const auto format = fields.text("format"); format != "tractus-plan/1")
    fields.wrong("format", "should be \"tractus-plan/1\"");
  out.title = fields.text("title");
  out.question = fields.text("question");
  out.endpoint = fields.text_or("endpoint", "");
  out.subject = fields.text_or("subject", "");
  out.alpha = fields.number_or("alpha", 0.05, 1e-9, 0.5);
  out.correction = fields.text_or("correction", "holm");
  if (out.correction != "none" && !adjustment_named(out.correction))
    fields.wrong("correction",
                 "can be holm, hommel, hochberg, bonferroni, benjamini-hochberg, "
                 "benjamini-yekutieli or none");
  const auto exclusions = elements(fields, "exclusions"), analyses = elements(fields, "analyses"),
             published = elements(fields, "published");
  if (analyses.empty()) fields.wrong("analyses", "should hold one analysis at least");
  auto lock = lock_of(fields.member("lock", false), name + ": ");
  TRY(fields.done());
  if (!lock) return lock.error();
  out.lock = std::move(*lock);
  TRY(read_all(exclusions, name + ": /exclusions", exclusion_of, out.exclusions));
  TRY(read_all(analyses, name + ": /analyses", analysis_of, out.analyses));
  TRY(read_all(published, name + ": /published", published_of, out.published));
  TRY(check_names(out, name));
  out.sha256 = plan_sha256(json);
  return out;
}

std::string plan_sha256(Json plan) {
  plan.erase("lock");
  const std::string text = plan.dump(-1, ' ', false, Json::error_handler_t::replace);
  return core::sha256(core::bytes_of(text));
}

core::Result<Json> locked(const Json& plan, const std::string& name, const Lock& by) {
  const auto parsed = TRY(Plan::from_json(plan, name));
  if (parsed.lock)
    return core::Error{core::Errc::conflict,
                       fmt::format("{}: {} locked it on {}; a changed plan is a new plan", name,
                                   parsed.lock->who, parsed.lock->utc)};
  if (by.who.empty()) return core::bad_input("a lock needs the name of whoever makes it");
  Json out = plan;
  out["lock"] = {
      {"who", by.who}, {"utc", by.utc}, {"data_seen", by.data_seen}, {"sha256", parsed.sha256}};
  return out;
}

core::Result<void> check_lock(const Plan& plan, const std::string& name) {
  if (!plan.lock)
    return core::Error{core::Errc::conflict,
                       name +
                           ": the plan is not locked; 'tractus analyse lock' does that, before "
                           "the data are seen"};
  if (plan.lock->sha256 != plan.sha256)
    return core::Error{core::Errc::conflict,
                       fmt::format("{}: the plan was changed after {} locked it on {}", name,
                                   plan.lock->who, plan.lock->utc)};
  return {};
}

Json example_plan() {
  return {{"format", "tractus-plan/1"},
          {"title", "Does practice slow the breach?"},
          {"question",
           "Is the breach velocity lower in the third trial of a scenario than in the first?"},
          {"endpoint", "breach_velocity_peak_m_s: largest speed in the breach section"},
          {"subject", "participant"},
          {"alpha", 0.05},
          {"correction", "holm"},
          {"exclusions", {{{"where", "complete = 0"}, {"reason", "the trial was interrupted"}}}},
          {"analyses",
           {{{"id", "practice"},
             {"question", "Does the breach velocity change over the three repetitions?"},
             {"family", "primary"},
             {"method", "rm-anova"},
             {"formula", "breach_velocity_peak_m_s ~ repetition + (1|participant)"},
             {"where", "scenario = lateral"}},
            {{"id", "practice-mixed"},
             {"question", "The same on single trials, with the order of presentation"},
             {"family", "sensitivity"},
             {"method", "lmm"},
             {"formula", "breach_velocity_peak_m_s ~ repetition + order + (1|participant)"},
             {"where", "scenario = lateral"},
             {"term", "repetition"}}}}};
}

}  // namespace assessment
}  // namespace tractus
