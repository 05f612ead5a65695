#include "lab/io/case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/try.hpp"
#include "effects/expression.hpp"
#include "effects/palpation_expression.hpp"
#include "lab/identify/user_effect_checks.hpp"
#include "lab/io/torque.hpp"
#include "lab/io/unpacked.hpp"
#include "lab/rigs/palpation/problem.hpp"
#include "lab/rigs/probing/problem.hpp"
#include "models/probing_model.hpp"
#include "trial/probing_set.hpp"
#include "volume/io/read_volume.hpp"

namespace tractus {
namespace lab_io {
namespace {

namespace fs = std::filesystem;
using core::Errc;
using core::Error;
using core::Result;

constexpr double kFirstStep = 0.01;  // of a parameter's range, from where its effect is off

/// The set's own name, else its folder's or archive's.
std::string name_of(const core::Json& stated, const fs::path& path) {
  const auto it = stated.find("name");
  if (it != stated.end() && it->is_string()) return it->get<std::string>();
  const fs::path plain = path.has_filename() ? path : path.parent_path();
  return plain.filename().string();
}

bool is_simulated(const core::Json& stated) {
  const auto it = stated.find("simulated");
  return it != stated.end() && it->is_boolean() && it->get<bool>();
}

core::Json json_of(const trial::StatedTract& tract) {
  const auto numbers = [](const math::Vec3& v) { return core::Json{v.x(), v.y(), v.z()}; };
  return {{"entry_m", numbers(tract.entry_m)},
          {"axis", numbers(tract.axis)},
          {"length_m", tract.length_m}};
}

/// The user's own effects, to be tried as the catalogue's are.
Result<lab::UserEffects> take_own(const Sources& sources, const effects::ExpressionRig& rig,
                                  const std::vector<effects::EffectInstance>& in_model) {
  std::vector<std::pair<effects::EffectInstance, effects::EffectFacts>> user_effects;
  for (const OwnEffect& one : sources.own) {
    const auto expression = TRY(effects::Expression::from_json(one.definition, one.where, rig));
    effects::EffectInstance use = expression.use();
    const auto same = [&](const auto& other) { return other.id == use.id; };
    if (std::ranges::any_of(in_model, same))
      return Error{Errc::bad_input,
                   fmt::format("{}id: the model has an effect '{}' already", one.where, use.id)};
    if (std::ranges::any_of(user_effects, [&](const auto& other) { return same(other.first); }))
      return Error{Errc::bad_input, fmt::format("{}id: '{}' is given twice", one.where, use.id)};
    effects::EffectFacts facts = expression.facts();
    for (effects::Param& p : facts.params)  // a search cannot begin where the effect is off
      if (p.initial == p.off)
        p.initial = p.off + kFirstStep * (p.high > p.off ? p.high - p.off : p.low - p.off);
    user_effects.emplace_back(std::move(use), std::move(facts));
  }
  return lab::UserEffects(std::move(user_effects));
}

/// What is wrong with an own effect on these recordings is told before anything is fitted.
Result<Case> with_own(Case opened, const Sources& sources) {
  for (const OwnEffect& one : sources.own) {
    opened.own.push_back(one.definition["id"].get<std::string>());
    if (auto fine = lab::check_own_effect(*opened.problem, opened.own.back()); !fine)
      return Error{fine.error().code, one.where + fine.error().what};
  }
  return opened;
}

Error renamed(Error error, const std::string& from, const std::string& to) {
  if (from == to) return error;
  for (auto at = error.what.find(from); at != std::string::npos;
       at = error.what.find(from, at + to.size()))
    error.what.replace(at, from.size(), to);
  return error;
}

/// A message that names the archive rather than the folder that it was unpacked into.
Error named(Error error, const Unpacked& unpacked, const fs::path& given) {
  return renamed(std::move(error), unpacked.folder().string(), given.string());
}

template <class Set>
Case begun(const std::string& model, const Set& set, const Sources& sources) {
  return {model,
          name_of(set.stated, sources.measurements),
          is_simulated(set.stated),
          core::Json(),
          {},
          nullptr,
          nullptr,
          lab::recorded(set)};
}

Result<Case> with(Case opened, Result<std::unique_ptr<lab::Problem>> problem) {
  if (!problem) return problem.error();
  opened.problem = std::move(*problem);
  return opened;
}

/// A channel that is judged and never changes is a sensor that was off.
Result<void> check_sensors(const Case& opened) {
  const auto& channels = opened.recorded.channels;
  const std::string& primary = opened.problem->channels().front().name;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (channels[c] != primary) continue;
    for (const auto& trial : opened.recorded.trials) {
      const auto [least, most] = std::ranges::minmax(trial.values[c]);
      if (least == most)
        return Error{Errc::bad_input,
                     fmt::format("trial {}: {} is {} in every sample; was the sensor off?",
                                 trial.id, primary, least)};
    }
  }
  return {};
}

/// Recordings that never enter the model's bone tell nothing of it.
Result<void> check_reach(const models::ProbingModel& model, const trial::ProbingSet& set) {
  if (model.layers.empty()) return {};
  const double first_m = model.layers.front().start_m,
               last_m = model.layers.back().start_m + model.layers.back().thickness_m;
  double least_m = std::numeric_limits<double>::infinity(), most_m = -least_m;
  for (const auto& trial : set.trials)
    for (const double x_m : trial.x_m)
      least_m = std::min(least_m, x_m), most_m = std::max(most_m, x_m);
  if (!(least_m <= most_m)) return {};  // a rig that only turns
  if (most_m < first_m || least_m > last_m)
    return Error{
        Errc::bad_input,
        fmt::format("{}: depths run from {:.4g} to {:.4g} m, the model's layers from {:.4g} "
                    "to {:.4g} m; x_m counts from the entry, positive into the bone",
                    set.folder.string(), least_m, most_m, first_m, last_m)};
  return {};
}

Result<Case> open_probing(models::ProbingModel model, const Sources& sources,
                          const fs::path& folder, const core::Progress& progress) {
  auto own = TRY(take_own(sources, effects::probing_expressions(), model.effects));
  auto set = TRY(trial::read_probing_set(folder));
  TRY(check_reach(model, set));
  Case opened = begun(model.name, set, sources);
  if (model.states_rotary && records_torque(set))
    opened.torque = TRY(lab::make_probing_problem(
        about_axis(model), set, {.threads = sources.threads, .torque_beside_force = true}));
  if (sources.keep_recordings) opened.kept = {model, set};
  return with(std::move(opened),
              lab::make_probing_problem(
                  model, std::move(set),
                  {.threads = sources.threads, .user_effects = std::move(own)}, progress));
}

Result<Case> open_palpation(models::PalpationModel model, const Sources& sources,
                            const fs::path& folder, const core::Progress& progress) {
  auto own = TRY(take_own(sources, effects::palpation_expressions(), model.effects));
  auto set = TRY(trial::read_palpation_set(folder));
  if (model.volume.empty() && set.volume.empty())
    return Error{Errc::bad_input,
                 fmt::format("{}: names no \"volume\", and neither does {}/set.json",
                             sources.model.string(), sources.measurements.string())};
  const fs::path path =
      model.volume.empty() ? folder / set.volume : sources.model.parent_path() / model.volume;
  const auto imported = TRY(volume_io::read_volume(path, part_of(progress, 0.0, 0.2)));
  Case opened = begun(model.name, set, sources);
  if (set.tract) opened.tract = json_of(*set.tract);
  return with(std::move(opened), lab::make_palpation_problem(
                                     model, std::move(set), imported.volume,
                                     {.threads = sources.threads, .user_effects = std::move(own)},
                                     part_of(progress, 0.2, 0.8)));
}

}  // namespace

core::Progress part_of(const core::Progress& whole, double from, double width) {
  if (!whole) return {};
  return [=](double share) { return whole(from + width * share); };
}

Result<Case> open_case(const Sources& sources, const core::Progress& progress) {
  const auto model = TRY(models::read_model(sources.model));
  const auto unpacked = TRY(Unpacked::open(sources.measurements, {}, part_of(progress, 0.0, 0.2)));
  const auto rig = trial::rig_of_set(unpacked.folder());
  if (!rig) return named(rig.error(), unpacked, sources.measurements);
  const auto* probing = std::get_if<models::ProbingModel>(&model);
  if ((*rig == "probing") != (probing != nullptr))
    return Error{Errc::bad_input,
                 fmt::format("{}: a model of the {} rig, but {} holds measurements of the {} rig",
                             sources.model.string(), probing ? "probing" : "palpation",
                             sources.measurements.string(), *rig)};
  const auto rest = part_of(progress, 0.2, 0.8);
  auto opened = probing ? open_probing(*probing, sources, unpacked.folder(), rest)
                        : open_palpation(std::get<models::PalpationModel>(model), sources,
                                         unpacked.folder(), rest);
  if (!opened) return named(opened.error(), unpacked, sources.measurements);
  if (auto fine = check_sensors(*opened); !fine)
    return Error{fine.error().code, sources.measurements.string() + ": " + fine.error().what};
  return with_own(std::move(*opened), sources);
}

Result<SetFacts> facts_of_set(const fs::path& path) {
  const auto unpacked = Unpacked::open(path);
  if (!unpacked) return renamed(unpacked.error(), path.string(), path.filename().string());
  const auto counted = [&](const auto& set) -> Result<SetFacts> {
    if (!set) return named(set.error(), *unpacked, path.filename());
    SetFacts out{"", is_simulated(set->stated), set->trials.size(), 0};
    for (const auto& trial : set->trials) out.samples += trial.t_s.size();
    return out;
  };
  const auto rig = trial::rig_of_set(unpacked->folder());
  if (!rig) return named(rig.error(), *unpacked, path.filename());
  auto facts = *rig == "probing" ? counted(trial::read_probing_set(unpacked->folder()))
                                 : counted(trial::read_palpation_set(unpacked->folder()));
  if (facts) facts->rig = *rig;
  return facts;
}

}  // namespace lab_io
}  // namespace tractus
