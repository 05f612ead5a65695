#include "bench/hand_recognition/forms.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/file.hpp"
#include "core/try.hpp"
#include "volume/volume_file.hpp"

namespace tractus {
namespace bench {
namespace {

using volume::Wall;
namespace fs = std::filesystem;

core::Json array_of(const math::Vec3& v) { return core::Json::array({v.x(), v.y(), v.z()}); }
math::Vec3 vector_of(const core::Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

core::Json json_of(const Form& form) {
  const volume::Tract& tract = form.carved.tract;
  return {{"breach", form.breach ? core::Json(std::string(name(*form.breach))) : core::Json()},
          {"at_m", form.at_m},
          {"chosen", form.chosen},
          {"passes", form.passes},
          {"from_m", form.from_m},
          {"entry_m", array_of(tract.entry_m)},
          {"axis", array_of(tract.axis)},
          {"medial", array_of(tract.medial)},
          {"superior", array_of(tract.superior)},
          {"length_m", tract.length_m},
          {"radius_m", tract.radius_m}};
}

Form form_of(const core::Json& json) {
  Form out;
  if (!json.at("breach").is_null())
    out.breach = core::from_name<Wall>(json.at("breach").get<std::string>());
  out.at_m = json.at("at_m").get<double>();
  out.chosen = json.at("chosen").get<bool>();
  out.passes = json.at("passes").get<bool>();
  out.from_m = json.at("from_m").get<double>();
  out.carved.tract = {.entry_m = vector_of(json.at("entry_m")),
                      .axis = vector_of(json.at("axis")),
                      .length_m = json.at("length_m").get<double>(),
                      .radius_m = json.at("radius_m").get<double>(),
                      .medial = vector_of(json.at("medial")),
                      .superior = vector_of(json.at("superior"))};
  return out;
}

std::string volume_name(const Form& form) {
  return fmt::format("{}{}.tvol", form.breach ? name(*form.breach) : "whole",
                     form.chosen ? "" : " worst");
}

core::Result<void> write_forms(const fs::path& folder, const std::vector<Form>& forms) {
  core::Json all = core::Json::array();
  fs::create_directories(folder);
  for (const Form& form : forms) {
    TRY(volume::write_volume(folder / volume_name(form), form.carved.volume, {}));
    all.push_back(json_of(form));
  }
  return core::write_json(folder / "forms.json", all);
}

core::Result<std::vector<Form>> read_forms(const fs::path& folder) {
  const auto all = TRY(core::read_json(folder / "forms.json"));
  std::vector<Form> out;
  for (const core::Json& one : all) {
    out.push_back(form_of(one));
    const auto file = TRY(volume::VolumeFile::open(folder / volume_name(out.back())));
    out.back().carved.volume = TRY(file.read_all());
  }
  return out;
}

/// A place of a wall at which a breach is made.
struct Chosen {
  double at_m;
  bool chosen, passes;
};

/// The maker's choice; of a side wall that was tried at several places, the worst of them too.
std::vector<Chosen> chosen_of(const cases::WallCertificate& wall) {
  std::vector<Chosen> out{{*wall.at_m, true, wall.passes()}};
  const auto told = [](const cases::TriedPlace& place) {
    return std::min(place.told.k.value_or(0.0), place.told.b.value_or(0.0));
  };
  const auto worst = std::ranges::min_element(wall.places, {}, told);
  if (worst == wall.places.end() || worst->at_m == *wall.at_m) return out;
  const cases::WallCertificate there{
      .wall = wall.wall, .at_m = worst->at_m, .told = worst->told, .foretold = worst->foretold};
  out.push_back({worst->at_m, false, there.passes()});
  return out;
}

core::Result<std::vector<Form>> made_forms(const Pedicle& pedicle,
                                           volume::Preparation preparation) {
  constexpr double kMove_m = 0.002;
  const auto& ct = ct_of(pedicle);
  const auto model = published_model();
  auto plan = pedicle.plan(preparation);
  if (preparation == volume::Preparation::filled) plan.may_move_m = kMove_m;
  const auto made = TRY(cases::make(ct, model, plan));
  const double from_m = made.certificate->from_m;
  std::vector<Form> out{{.breach = {}, .from_m = from_m, .carved = made}};
  plan.envelope = made.envelope;
  plan.length_m = made.tract.length_m;
  plan.target_m += made.tract.entry_m - plan.entry_m;
  plan.entry_m = made.tract.entry_m;
  for (const cases::WallCertificate& wall : made.certificate->walls) {
    if (!wall.at_m) continue;
    for (const Chosen& place : chosen_of(wall)) {
      plan.breach = volume::BreachPlan{.wall = wall.wall};
      if (wall.wall != Wall::anterior) plan.breach->at_m = place.at_m;
      out.push_back({.breach = wall.wall,
                     .at_m = place.at_m,
                     .chosen = place.chosen,
                     .passes = place.passes,
                     .from_m = from_m,
                     .carved = TRY(cases::carve(ct, model.transfer, plan))});
    }
  }
  return out;
}

}  // namespace

std::string name_of(const Pedicle& pedicle, volume::Preparation preparation) {
  return fmt::format("{}, {}", pedicle.name, name(preparation));
}

models::PalpationModel published_model() {
  models::PalpationModel model;
  model.name = "uniform cantilever";
  return model;
}

core::Result<std::vector<Form>> forms_of(const Pedicle& pedicle, volume::Preparation preparation,
                                         const fs::path& keep) {
  if (keep.empty()) return made_forms(pedicle, preparation);
  const fs::path folder = keep / name_of(pedicle, preparation);
  if (fs::exists(folder / "forms.json")) return read_forms(folder);
  auto forms = TRY(made_forms(pedicle, preparation));
  TRY(write_forms(folder, forms));
  return forms;
}

}  // namespace bench
}  // namespace tractus
