#include "effects/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/try.hpp"

namespace tractus {
namespace effects {
namespace {

using core::Errc;
using core::Error;
using core::Fields;
using core::Json;

constexpr std::size_t kMostParameters = 16;
constexpr double kMost = 1e12;
/// What a recording may lack.
constexpr std::array<std::string_view, 3> kSometimesMissing{"theta_rad", "omega_rad_s", "tz_Nm"};

bool is_id(std::string_view id) {
  if (!is_expression(id)) return false;
  id.remove_prefix(kExpressionPrefix.size());
  return !id.empty() && id.size() <= 40 && std::ranges::all_of(id, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
}

void need(Fields& fields, const char* key, std::string_view expected) {
  if (const auto found = fields.text(key); found != expected)
    fields.wrong(key, fmt::format("'{}'; '{}' is expected", found, expected));
}

Param read_parameter(Fields& fields, const std::string& name) {
  Param out{.name = name,
            .meaning = fields.text_or("meaning", "", 200),
            .initial = fields.number("initial", -kMost, kMost),
            .low = fields.number("low", -kMost, kMost),
            .high = fields.number("high", -kMost, kMost),
            .off = kNoOff};
  if (!(out.low < out.high))
    fields.wrong("high", fmt::format("{} is not above low, {}", out.high, out.low));
  if (!(out.low <= out.initial && out.initial <= out.high))
    fields.wrong("initial", fmt::format("{} is outside {} … {}", out.initial, out.low, out.high));
  if (!fields.has("logarithmic")) return out;
  const Json& flag = *fields.member("logarithmic");
  if (!flag.is_boolean()) fields.wrong("logarithmic", "true or false is expected");
  out.logarithmic = flag.is_boolean() && flag.get<bool>();
  if (out.logarithmic && out.low <= 0.0) fields.wrong("low", "must be above 0 to be logarithmic");
  return out;
}

}  // namespace

bool is_expression(std::string_view id) { return id.starts_with(kExpressionPrefix); }

std::string expression_label(std::string_view id) {
  std::string name(id.substr(kExpressionPrefix.size()));
  std::ranges::replace(name, '_', ' ');
  return "your own effect “" + name + "”";
}

const ExpressionRig& probing_expressions() {
  static constexpr std::array<ExpressionState, 8> kStates{
      {{"x_m", "m", "depth"},
       {"v_m_s", "m/s", "speed"},
       {"a_m_s2", "m/s^2", "acceleration"},
       {"theta_rad", "rad", "angle of the probe"},
       {"omega_rad_s", "rad/s", "speed of turning"},
       {"t_s", "s", "time in the trial"},
       {"tz_Nm", "N*m", "torque: as recorded; live, the law's"},
       {"base_N", "N", "resistance of the bone without this effect"}}};
  static constexpr ExpressionRig kRig{
      "probing", "fz_N", "N", kStates,
      "strokes in and out at three speeds, with holds and reversals, over the whole depth"};
  return kRig;
}

core::Result<Expression> Expression::from_json(const Json& json, const std::string& where,
                                               const ExpressionRig& rig) {
  Fields fields(json, where);
  if (!json.is_object()) return fields.done().error();
  Expression out;
  need(fields, "format", kEffectFormat);
  EffectFacts& facts = out.facts_;
  facts.id = fields.text("id");
  if (!is_id(facts.id))
    fields.wrong("id", fmt::format("'{}'; 'expression:' and a name of small letters, digits and _ "
                                   "are expected",
                                   facts.id));
  need(fields, "rig", rig.rig);
  need(fields, "adds_to", rig.adds_to);
  facts.equation = fields.text("formula", 1000);
  facts.summary = fields.text_or("summary", "A user's own formula", 200);
  facts.source = "user";
  facts.experiment = rig.experiment;
  facts.is_dry =
      true;  // as far as the sign of the speed is in it: what is smooth is 0 at standstill
  facts.passive = false;
  out.rig_ = rig.rig;
  out.adds_to_ = rig.adds_to;
  for (const ExpressionState& state : rig.states)
    out.quantities_.push_back({std::string(state.name), *Dimension::parse(state.unit)});
  const Json* parameters = fields.member("parameters");
  TRY(fields.done());
  facts.label = expression_label(facts.id);
  if (!parameters->is_object() || parameters->size() > kMostParameters)
    return Error{Errc::bad_input,
                 fmt::format("{}/parameters: an object of at most {} parameters is expected", where,
                             kMostParameters)};
  for (const auto& [name, given] : parameters->items()) {
    Fields own(given, fmt::format("{}/parameters/{}", where, name));
    if (!given.is_object()) return own.done().error();
    if (!is_free_name(name) ||
        std::ranges::find(out.quantities_, name, &Quantity::name) != out.quantities_.end())
      return Error{
          Errc::bad_input,
          fmt::format("{}: not a name for a parameter, or one that is taken", own.where())};
    facts.params.push_back(read_parameter(own, name));
    out.units_.push_back(own.text("unit", 64));
    auto unit = Dimension::parse(out.units_.back());
    if (!unit) own.wrong("unit", unit.error().what);
    facts.params.back().unit = out.units_.back();
    TRY(own.done());
    out.quantities_.push_back({name, *unit});
  }
  auto found = check_formula(facts.equation, out.quantities_, *Dimension::parse(rig.unit));
  if (!found)
    return Error{found.error().code, fmt::format("{}/formula: {}", where, found.error().what)};
  if (!found->memories.empty() && !rig.remembers)
    return Error{Errc::bad_input,
                 fmt::format("{}/formula: a formula of the {} rig knows the present moment alone; "
                             "{} and the other operators that remember are of the probing rig",
                             where, rig.rig, memory_operators().front().name)};
  out.memories_ = std::move(found->memories);
  for (std::size_t k = 0; k < facts.params.size(); ++k) {
    const std::size_t quantity = rig.states.size() + k;
    Param& param = facts.params[k];
    if (!found->uses[quantity])
      return Error{Errc::bad_input,
                   fmt::format("{}/parameters/{}: the formula does not use it", where, param.name)};
    if (found->vanishes[quantity] && param.low <= 0.0 && param.high >= 0.0) param.off = 0.0;
  }
  for (std::size_t k = 0; k < rig.states.size(); ++k)
    if (found->uses[k] &&
        std::ranges::find(kSometimesMissing, rig.states[k].name) != kSometimesMissing.end())
      facts.needs.emplace_back(rig.states[k].name);
  if (auto ready = out.program(); !ready)
    return Error{Errc::bad_input, fmt::format("{}/formula: {}", where, ready.error().what)};
  return out;
}

core::Result<Expression> Expression::read(const std::filesystem::path& path,
                                          const ExpressionRig& rig) {
  auto json = TRY(core::read_json(path));
  return from_json(json, path.string() + ": ", rig);
}

core::Result<Expression> Expression::of(const EffectInstance& use, const ExpressionRig& rig) {
  auto json = TRY(core::parse_json(use.definition, use.id));
  auto out = from_json(json, use.id + ": ", rig);
  if (out && out->facts().id != use.id)
    return Error{Errc::bad_input,
                 fmt::format("{}: its definition is of '{}'", use.id, out->facts().id)};
  return out;
}

Json Expression::to_json() const {
  Json parameters = Json::object();
  for (std::size_t k = 0; k < units_.size(); ++k) {
    const Param& p = facts_.params[k];
    Json& one = parameters[p.name];
    one = {{"unit", units_[k]}, {"initial", p.initial}, {"low", p.low}, {"high", p.high}};
    if (!p.meaning.empty()) one["meaning"] = p.meaning;
    if (p.logarithmic) one["logarithmic"] = true;
  }
  return {{"format", kEffectFormat},
          {"id", facts_.id},
          {"rig", rig_},
          {"adds_to", adds_to_},
          {"formula", facts_.equation},
          {"summary", facts_.summary},
          {"parameters", std::move(parameters)}};
}

EffectInstance Expression::use(std::vector<double> values) const {
  if (values.empty())
    for (const Param& param : facts_.params) values.push_back(param.initial);
  return {facts_.id, std::move(values), to_json().dump()};
}

core::Result<FormulaProgram> Expression::program() const {
  return FormulaProgram::make(facts_.equation, quantities_, memories_);
}

}  // namespace effects
}  // namespace tractus
