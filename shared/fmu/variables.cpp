#include "fmu/variables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "core/bytes.hpp"

namespace tractus {
namespace fmu {
namespace {

using core::Json;

/// A name of FMI's structured convention; one with other signs than letters, digits and _ is quoted.
std::string quoted(const std::string& id) {
  const auto plain = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  return std::ranges::all_of(id, plain) ? id : "'" + id + "'";
}

}  // namespace

Order order_of(std::span<const Variable> variables) {
  const auto first = [&](auto beyond) {
    return std::size_t(std::ranges::find_if(variables, beyond, &Variable::causality) -
                       variables.begin());
  };
  return {first([](Causality c) { return c != Causality::input; }),
          first([](Causality c) { return c == Causality::parameter; })};
}

void add_effect(const effects::EffectInstance& use, const effects::EffectFacts& facts,
                std::size_t k, std::vector<Variable>& out) {
  auto value = use.values.begin();
  for (const effects::Param& param : facts.params)
    for (int i = 0; i < param.components; ++i) {
      const bool one = param.components == 1;
      const std::string unit = effects::unit_of(param);
      out.push_back({fmt::format("effects.{}.{}", quoted(use.id), param.name) +
                         (one ? "" : fmt::format("[{}]", i + 1)),
                     Causality::parameter, unit == "1" ? "" : unit,
                     facts.label + (param.meaning.empty() ? "" : ": " + param.meaning), *value++,
                     param.low, param.high,
                     fmt::format("/effects/{}/parameters/{}", k, param.name) +
                         (one ? "" : fmt::format("/{}", i))});
    }
}

Json with_values(Json model, std::span<const Variable> variables, std::span<const double> values) {
  for (std::size_t k = 0; k < variables.size(); ++k)
    if (!variables[k].pointer.empty()) model[Json::json_pointer(variables[k].pointer)] = values[k];
  return model;
}

std::string guid(std::string_view carried_text) {
  const std::string digest = core::sha256(core::bytes_of(carried_text));
  return fmt::format("{{{}-{}-{}-{}-{}}}", digest.substr(0, 8), digest.substr(8, 4),
                     digest.substr(12, 4), digest.substr(16, 4), digest.substr(20, 12));
}

}  // namespace fmu
}  // namespace tractus
