#include "lab/io/case.hpp"

#include <fmt/format.h>

#include "effects/expression.hpp"
#include "effects/palpation_expression.hpp"
#include "lab/io/unpacked.hpp"
#include "lab/palpation_problem.hpp"
#include "lab/probing_problem.hpp"
#include "models/probing_model.hpp"
#include "trial/probing_set.hpp"
#include "volume/io/read_volume.hpp"

namespace lab_io {
namespace {

namespace fs = std::filesystem;
using core::Errc;
using core::Error;
using core::Result;

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

/// The user's own effects, each at its initial numbers.
Result<void> add_effects(const std::vector<fs::path>& files, const effects::ExpressionRig& rig,
                         std::vector<effects::Use>& to) {
  for (const fs::path& file : files) {
    const auto expression = effects::Expression::read(file, rig);
    if (!expression) return expression.error();
    to.push_back(expression->use());
  }
  return {};
}

template <class Set>
Case begun(const std::string& model, const Set& set, const Sources& sources) {
  return {model, name_of(set.stated, sources.measurements), is_simulated(set.stated), nullptr,
          lab::recorded(set)};
}

Result<Case> with(Case opened, Result<std::unique_ptr<lab::Problem>> problem) {
  if (!problem) return problem.error();
  opened.problem = std::move(*problem);
  return opened;
}

Result<Case> open_probing(models::ProbingModel model, const Sources& sources,
                          const fs::path& folder, const core::Progress& progress) {
  auto added = add_effects(sources.effects, effects::probing_expressions(), model.effects);
  if (!added) return added.error();
  auto set = trial::read_probing_set(folder);
  if (!set) return set.error();
  Case opened = begun(model.name, *set, sources);
  return with(std::move(opened), lab::make_probing_problem(model, std::move(*set),
                                                           {.threads = sources.threads}, progress));
}

Result<Case> open_palpation(models::PalpationModel model, const Sources& sources,
                            const fs::path& folder, const core::Progress& progress) {
  auto added = add_effects(sources.effects, effects::palpation_expressions(), model.effects);
  if (!added) return added.error();
  auto set = trial::read_palpation_set(folder);
  if (!set) return set.error();
  if (model.volume.empty() && set->volume.empty())
    return Error{Errc::bad_input,
                 fmt::format("{}: names no \"volume\", and neither does {}/set.json",
                             sources.model.string(), sources.measurements.string())};
  const fs::path path =
      model.volume.empty() ? folder / set->volume : sources.model.parent_path() / model.volume;
  const auto imported = volume_io::read_volume(path, part_of(progress, 0.0, 0.2));
  if (!imported) return imported.error();
  Case opened = begun(model.name, *set, sources);
  return with(std::move(opened), lab::make_palpation_problem(
                                     model, std::move(*set), imported->volume,
                                     {.threads = sources.threads}, part_of(progress, 0.2, 0.8)));
}

}  // namespace

core::Progress part_of(const core::Progress& whole, double from, double width) {
  if (!whole) return {};
  return [=](double share) { return whole(from + width * share); };
}

Result<Case> open_case(const Sources& sources, const core::Progress& progress) {
  const auto model = models::read_model(sources.model);
  if (!model) return model.error();
  const auto unpacked = Unpacked::open(sources.measurements, {}, part_of(progress, 0.0, 0.2));
  if (!unpacked) return unpacked.error();
  const auto rig = trial::rig_of_set(unpacked->folder());
  if (!rig) return rig.error();
  const auto* probing = std::get_if<models::ProbingModel>(&*model);
  if ((*rig == "probing") != (probing != nullptr))
    return Error{Errc::bad_input,
                 fmt::format("{}: a model of the {} rig, but {} holds measurements of the {} rig",
                             sources.model.string(), probing ? "probing" : "palpation",
                             sources.measurements.string(), *rig)};
  const auto rest = part_of(progress, 0.2, 0.8);
  if (probing) return open_probing(*probing, sources, unpacked->folder(), rest);
  return open_palpation(std::get<models::PalpationModel>(*model), sources, unpacked->folder(),
                        rest);
}

}  // namespace lab_io
