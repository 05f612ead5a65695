#include "bench/hand_recognition/forms.hpp"

#include <fmt/format.h>

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
          {"d_prime", form.d_prime},
          {"passes", form.passes},
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
  out.d_prime = json.at("d_prime").get<double>();
  out.passes = json.at("passes").get<bool>();
  out.carved.tract = {.entry_m = vector_of(json.at("entry_m")),
                      .axis = vector_of(json.at("axis")),
                      .length_m = json.at("length_m").get<double>(),
                      .radius_m = json.at("radius_m").get<double>(),
                      .medial = vector_of(json.at("medial")),
                      .superior = vector_of(json.at("superior"))};
  return out;
}

std::string volume_name(const Form& form) {
  return fmt::format("{}.tvol", form.breach ? name(*form.breach) : "whole");
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

core::Result<std::vector<Form>> made_forms(const Pedicle& pedicle,
                                           volume::Preparation preparation) {
  const auto& ct = ct_of(pedicle);
  const auto model = published_model();
  auto plan = pedicle.plan(preparation);
  const auto made = TRY(cases::make(ct, model, plan));
  std::vector<Form> out{{.breach = {}, .carved = made}};
  plan.envelope = made.envelope;
  plan.length_m = made.tract.length_m;
  for (const cases::WallCertificate& wall : made.certificate->walls) {
    if (!wall.at_m) continue;
    plan.breach = volume::BreachPlan{.wall = wall.wall};
    if (wall.wall != Wall::anterior) plan.breach->at_m = wall.at_m;
    out.push_back({.breach = wall.wall,
                   .d_prime = wall.d_prime().value_or(0.0),
                   .passes = wall.passes(),
                   .carved = TRY(cases::carve(ct, model.transfer, plan))});
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
