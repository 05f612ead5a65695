#include "fmu/description.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "effects/dimension.hpp"
#include "plot/text.hpp"

namespace tractus {
namespace fmu {
namespace {

std::string attribute(std::string_view key, std::string_view text) {
  return fmt::format(" {}=\"{}\"", key, plot::escaped(text));
}

/// Our units have one angle at most, over or under the line: "rad", "rad/s", "N·m·s/rad".
int angles(std::string_view unit) {
  const auto at = unit.find("rad");
  if (at == std::string_view::npos) return 0;
  return unit.substr(0, at).find('/') == std::string_view::npos ? 1 : -1;
}

/// "m/s²" with the power as `Dimension` reads it.
std::string with_carets(std::string unit) {
  for (const auto& [sign, power] : {std::pair{"²", "^2"}, std::pair{"³", "^3"}})
    for (auto at = unit.find(sign); at != std::string::npos; at = unit.find(sign))
      unit.replace(at, std::string_view(sign).size(), power);
  return unit;
}

/// A unit with its powers of the SI's base units; without them where one is a fraction.
std::string unit_xml(const std::string& unit) {
  std::string base;
  const auto dimension = effects::Dimension::parse(with_carets(unit));
  if (const auto powers = dimension ? dimension->whole_powers() : std::nullopt) {
    base = "<BaseUnit";
    const auto add = [&](const char* name, int power) {
      if (power != 0) base += fmt::format(" {}=\"{}\"", name, power);
    };
    add("kg", (*powers)[1]), add("m", (*powers)[0]), add("s", (*powers)[2]);
    add("rad", angles(unit));
    base += "/>";
  }
  return fmt::format("    <Unit{}>{}</Unit>\n", attribute("name", unit), base);
}

std::string units_xml(std::span<const Variable> variables) {
  std::set<std::string> units;
  for (const Variable& v : variables)
    if (!v.unit.empty()) units.insert(v.unit);
  std::string out = "  <UnitDefinitions>\n";
  for (const std::string& unit : units) out += unit_xml(unit);
  return out + "  </UnitDefinitions>\n";
}

std::string variable_xml(const Variable& v, std::size_t reference) {
  const bool parameter = v.causality == Causality::parameter;
  std::string real = v.unit.empty() ? "" : attribute("unit", v.unit);
  if (std::isfinite(v.low)) real += fmt::format(" min=\"{}\"", v.low);
  if (std::isfinite(v.high)) real += fmt::format(" max=\"{}\"", v.high);
  if (v.causality != Causality::output) real += fmt::format(" start=\"{}\"", v.start);
  return fmt::format(
      "    <ScalarVariable{} valueReference=\"{}\" causality=\"{}\" variability=\"{}\"{}>"
      "<Real{}/></ScalarVariable>\n",
      attribute("name", v.name), reference, name(v.causality), parameter ? "fixed" : "continuous",
      attribute("description", v.description), real);
}

/// All outputs depend on all that is given, and are computed from it: FMI counts variables from 1.
std::string structure_xml(std::span<const Variable> variables) {
  std::string unknowns;
  const Order order = order_of(variables);
  for (std::size_t output = order.inputs; output < order.first_parameter; ++output)
    unknowns += fmt::format("      <Unknown index=\"{}\"/>\n", output + 1);
  return fmt::format(
      "  <ModelStructure>\n    <Outputs>\n{0}    </Outputs>\n    <InitialUnknowns>\n{0}"
      "    </InitialUnknowns>\n  </ModelStructure>\n",
      unknowns);
}

}  // namespace

std::string description_xml(const Description& description) {
  const std::span<const Variable> variables = description.variables;
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription";
  out += attribute("fmiVersion", "2.0") + attribute("modelName", description.model_name) +
         attribute("guid", description.guid) + attribute("description", description.summary) +
         attribute("generationTool", fmt::format("Tractus {}", description.version)) +
         attribute("variableNamingConvention", "structured") + ">\n";
  out += "  <CoSimulation" + attribute("modelIdentifier", kModelIdentifier) +
         " canHandleVariableCommunicationStepSize=\"true\" canInterpolateInputs=\"true\""
         " canNotUseMemoryManagementFunctions=\"true\" canGetAndSetFMUstate=\"true\"/>\n";
  out += units_xml(variables);
  out +=
      "  <LogCategories>\n    <Category name=\"logStatusError\" description=\"what a call was "
      "refused for\"/>\n  </LogCategories>\n  <DefaultExperiment startTime=\"0\" "
      "stepSize=\"0.001\"/>\n  <ModelVariables>\n";
  for (std::size_t k = 0; k < variables.size(); ++k) out += variable_xml(variables[k], k);
  return out + "  </ModelVariables>\n" + structure_xml(variables) + "</fmiModelDescription>\n";
}

}  // namespace fmu
}  // namespace tractus
