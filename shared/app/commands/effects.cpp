/// `tractus effects`: the catalogue of physical effects; checks a user's own.
#include <fmt/format.h>

#include <memory>

#include "app/command.hpp"
#include "core/json.hpp"
#include "core/try.hpp"
#include "effects/effect.hpp"
#include "effects/palpation_effect.hpp"
#include "effects/palpation_expression.hpp"
#include "effects/probing_effect.hpp"
#include "lab/io/catalogue.hpp"

namespace tractus {
namespace commands {
namespace {
using core::Json;
using tractus::effects::EffectFacts;
using tractus::effects::Expression;
using tractus::effects::ExpressionRig;
using tractus::effects::Param;

struct EffectsOptions {
  std::string id, rig, file;
  bool json = false;
};

struct Entry {
  std::string rig;
  EffectFacts facts;
};

const ExpressionRig& formulas_of(std::string_view rig) {
  return rig == "probing" ? tractus::effects::probing_expressions()
                          : tractus::effects::palpation_expressions();
}

core::Result<std::vector<Entry>> from_file(const std::string& file) {
  const auto json = TRY(core::read_json(file));
  const bool palpation = json.is_object() && json.contains("rig") && json["rig"] == "palpation";
  const std::string rig = palpation ? "palpation" : "probing";
  const auto own = TRY(Expression::from_json(json, file + ": ", formulas_of(rig)));
  return std::vector<Entry>{{rig, own.facts()}};
}

core::Result<std::vector<Entry>> chosen(const EffectsOptions& o) {
  if (!o.file.empty()) return from_file(o.file);
  std::vector<Entry> out;
  for (const auto& info : tractus::effects::probing_effects())
    out.push_back({"probing", info.facts});
  for (const auto& info : tractus::effects::palpation_effects())
    out.push_back({"palpation", info.facts});
  std::erase_if(out, [&](const Entry& entry) {
    return (!o.rig.empty() && entry.rig != o.rig) || (!o.id.empty() && entry.facts.id != o.id);
  });
  if (out.empty())
    return core::Error{core::Errc::not_found,
                       fmt::format("'{}' is not an effect{}; `tractus effects` lists them", o.id,
                                   o.rig.empty() ? "" : " of " + o.rig)};
  return out;
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

void print(const Entry& entry) {
  const EffectFacts& f = entry.facts;
  fmt::print("{} ({}, {})\n  {}\n  law     {}\n", f.id, entry.rig, tractus::effects::name(f.kind),
             f.summary, f.equation);
  for (const Param& p : f.params)
    fmt::print("  {}{}  {}: {:g} … {:g}, from {:g}{}\n", p.name,
               p.components > 1 ? fmt::format(" ({})", p.components) : "",
               fmt::format("[{}] {}", tractus::effects::unit_of(p), p.meaning), p.low, p.high,
               p.initial, p.logarithmic ? ", by its logarithm" : "");
  if (!f.needs.empty()) fmt::print("  needs   {}\n", joined(f.needs));
  if (!f.parents.empty()) fmt::print("  holds   {} as a limit\n", joined(f.parents));
  if (f.free_per_trial) fmt::print("  course  free in each trial\n");
  fmt::print("  source  {}\n\n", f.source);
}

void print_states() {
  fmt::print("expression:NAME, a formula of your own; it may name\n");
  for (const char* rig : {"probing", "palpation"}) {
    const ExpressionRig& r = formulas_of(rig);
    fmt::print("  {} ({} in {}):\n", rig, r.adds_to, r.unit);
    for (const auto& state : r.states)
      fmt::print("    {:12} {:6} {}\n", state.name, state.unit, state.meaning);
    if (!r.remembers) continue;
    fmt::print("    and what it remembers, by\n");
    for (const auto& memory : tractus::effects::memory_operators())
      fmt::print("      {}({})\n", memory.name, memory.arguments);
  }
}

Outcome run_effects(const EffectsOptions& o) {
  const auto entries = TRY(chosen(o));
  if (!o.json) {
    for (const Entry& entry : entries) print(entry);
    if (o.id.empty() && o.file.empty()) print_states();
    return 0;
  }
  Json list = Json::array();
  for (const Entry& entry : entries) list.push_back(lab_io::effect_json(entry.rig, entry.facts));
  fmt::print("{}\n", Json{{"effects", std::move(list)}}.dump(2));
  return 0;
}

}  // namespace

Command effects_command() {
  return {"effects", "List the physical effects that a model may contain, or check a user effect",
          "tractus effects --rig probing\n  tractus effects hysteresis\n  tractus effects --check "
          "my_drag.json",
          [](CLI::App& app) {
            auto options = std::make_shared<EffectsOptions>();
            auto* id = app.add_option("ID", options->id, "id of an effect: show only this effect");
            auto* rig = app.add_option("--rig", options->rig, "show only the effects of this rig")
                            ->check(CLI::IsMember({"probing", "palpation"}));
            app.add_option("--check", options->file,
                           "file of a user effect in the format tractus-effect/1; exit code 0: the "
                           "effect is valid and is shown, 2: it is invalid and the error is shown")
                ->excludes(id)
                ->excludes(rig);
            app.add_flag("--json", options->json, "print as JSON");
            return [options] { return run_effects(*options); };
          }};
}

}  // namespace commands
}  // namespace tractus
