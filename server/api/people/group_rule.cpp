#include "server/api/people/group_rule.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/try.hpp"
#include "server/api/people/people_json.hpp"

namespace tractus {
namespace api {
namespace {
using core::Json;
using core::Result;
using store::Role;

constexpr const char* kGroupRuleFormat = "tractus-groups/1";
constexpr std::size_t kMostLines = 100, kMostCohorts = 20, kMaxGroup = 200, kMaxCohortId = 64;
constexpr long kMostAbsent_days = 3650;

std::vector<std::string> cohorts_in(core::Fields& fields) {
  std::vector<std::string> out;
  const Json* list = fields.member("cohorts", false);
  if (!list) return out;
  const bool texts =
      list->is_array() && std::ranges::all_of(*list, [](const Json& one) {
        return one.is_string() && one.get_ref<const std::string&>().size() <= kMaxCohortId;
      });
  if (!texts || list->size() > kMostCohorts)
    return fields.wrong("cohorts", "at most 20 ids of cohorts are expected"), out;
  for (const Json& one : *list) out.push_back(one.get<std::string>());
  return out;
}

Result<GroupLine> line_from(const Json& json, const std::string& where) {
  core::Fields fields(json, where);
  GroupLine out;
  out.group = fields.text("group", kMaxGroup);
  if (out.group.find_first_not_of(" \t\r\n") == std::string::npos)
    fields.wrong("group", "the provider's name of a group is expected");
  out.role = fields.word<Role>("role");
  if (out.role == Role::admin || out.role == Role::station)
    fields.wrong("role",
                 "director, faculty, researcher, technician or trainee is expected: "
                 "administrators are made by hand");
  out.cohorts = cohorts_in(fields);
  if (!out.cohorts.empty() && out.role != Role::trainee && out.role != Role::faculty)
    fields.wrong("cohorts", "only trainees and faculty can join a cohort");
  out.level = level_field(fields);
  TRY(fields.done());
  return out;
}

bool fits(const GroupLine& line, const std::vector<std::string>& groups) {
  return std::ranges::find(groups, line.group) != groups.end();
}
}  // namespace

Result<GroupRule> GroupRule::from_json(const Json& json, const std::string& where) {
  core::Fields fields(json, where);
  if (fields.text("format", 40) != kGroupRuleFormat)
    fields.wrong("format", std::string(kGroupRuleFormat) + " is expected");
  const Json* lines = fields.member("lines");
  if (lines && (!lines->is_array() || lines->size() > kMostLines))
    fields.wrong("lines", "an array of at most 100 lines is expected");
  GroupRule out;
  if (fields.has("absent_days"))
    out.absent_days = fields.integer("absent_days", 1, kMostAbsent_days);
  TRY(fields.done());
  for (std::size_t i = 0; i < lines->size(); ++i) {
    auto line = TRY(line_from((*lines)[i], fmt::format("{}: /lines/{}", where, i)));
    const auto same = [&](const GroupLine& other) {
      return other.group == line.group && other.role == line.role;
    };
    if (std::ranges::any_of(out.lines, same))
      return core::bad_input(
          fmt::format("{}: /lines/{}: a line above has the group {} and the role "
                      "{}; name its cohorts in one line",
                      where, i, line.group, name(line.role)));
    out.lines.push_back(std::move(line));
  }
  return out;
}

Json GroupRule::to_json() const {
  Json list = Json::array();
  for (const GroupLine& line : lines)
    list.push_back({{"group", line.group},
                    {"role", name(line.role)},
                    {"cohorts", line.cohorts},
                    {"level", line.level}});
  Json out{{"format", kGroupRuleFormat}, {"lines", list}};
  if (absent_days) out["absent_days"] = *absent_days;
  return out;
}

std::optional<GroupGrant> GroupRule::grant(const std::vector<std::string>& groups) const {
  std::optional<GroupGrant> out;
  for (const GroupLine& line : lines) {
    if (!fits(line, groups)) continue;
    if (!out) out = GroupGrant{.role = line.role, .cohorts = {}, .level = line.level};
    if (line.role == out->role) out->cohorts.insert(line.cohorts.begin(), line.cohorts.end());
  }
  return out;
}

std::set<std::string> GroupRule::cohorts() const {
  std::set<std::string> out;
  for (const GroupLine& line : lines) out.insert(line.cohorts.begin(), line.cohorts.end());
  return out;
}

}  // namespace api
}  // namespace tractus
