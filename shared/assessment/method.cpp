#include "assessment/method.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/try.hpp"

namespace tractus {
namespace assessment {
namespace {

/// What is wrong with a value of an option; empty if nothing.
std::string fault_of(const Option& option, const std::string& value) {
  if (option.text || value.empty()) return "";
  if (!option.choices.empty()) {
    if (std::ranges::find(option.choices, value) != option.choices.end()) return "";
    return fmt::format("option '{}' is '{}'; it can be {}", option.name, value,
                       fmt::join(option.choices, ", "));
  }
  const auto number = number_in(value);
  if (number && *number >= option.low && *number <= option.high) return "";
  return fmt::format("option '{}' is '{}'; it takes a number from {} to {}", option.name, value,
                     option.low, option.high);
}

}  // namespace

double Analysis::number(const std::string& option) const {
  const auto value = number_in(text(option));
  core::require(value.has_value(), "a numeric option has a checked value");
  return *value;
}

const std::string& Analysis::text(const std::string& option) const {
  const auto at = options.find(option);
  core::require(at != options.end(), "a method asks for its own options alone");
  return at->second;
}

core::Result<Method> method_named(const std::string& id) {
  std::vector<std::string> ids;
  for (auto& method : methods::all()) {
    if (method.id == id) return method;
    ids.push_back(method.id);
  }
  return core::Error{core::Errc::not_found, fmt::format("there is no method '{}'; there are {}", id,
                                                        fmt::join(ids, ", "))};
}

core::Result<std::map<std::string, std::string>> complete(
    const Method& method, const std::map<std::string, std::string>& given) {
  std::map<std::string, std::string> out;
  for (const auto& option : method.options) {
    const auto at = given.find(option.name);
    const std::string& value = at == given.end() ? option.fallback : at->second;
    if (const auto why = fault_of(option, value); !why.empty())
      return core::bad_input(fmt::format("{}: {}", method.id, why));
    out.emplace(option.name, value.empty() ? option.fallback : value);
  }
  for (const auto& [name, _] : given)
    if (!out.contains(name))
      return core::bad_input(fmt::format("{}: there is no option '{}'", method.id, name));
  return out;
}

core::Result<Findings> run(const Method& method, const Table& table, const std::string& formula,
                           const std::map<std::string, std::string>& options, Missing missing,
                           const core::Progress& progress) {
  const auto parsed = TRY(parse_formula(formula));
  if (!parsed.random.empty() && !method.random_terms)
    return core::bad_input(
        fmt::format("'{}' knows no random terms but one (1|column): 'lmm' and 'logistic' take "
                    "slopes, crossed and nested ones",
                    method.id));
  const auto completed = TRY(complete(method, options));
  const auto selected = TRY(table.selected(parsed.columns(), missing));
  return method.run({parsed, selected, formula, completed, progress});
}

core::Result<Findings> run(const Method& method, const std::map<std::string, std::string>& options,
                           const core::Progress& progress) {
  const auto completed = TRY(complete(method, options));
  return method.run({Formula{}, Table{}, "", completed, progress});
}

}  // namespace assessment
}  // namespace tractus
