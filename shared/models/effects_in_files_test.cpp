/// Effects in the model files of both rigs, the users' own among them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "effects/expression.hpp"
#include "models/model.hpp"
#include "models/probing_model.hpp"
#include "models/probing_runtime.hpp"

namespace tractus {
namespace models {
namespace {

using core::Json;
using testing::HasSubstr;

Json probing(const Json& effects) {
  return Json{{"format", "tractus-model/1"},
              {"rig", "probing"},
              {"name", "bone"},
              {"base", {{"layers", Json::array()}}},
              {"effects", effects}};
}

Json drag_file() {
  const Json c{{"unit", "N*s^2/m^2"}, {"initial", 1}, {"low", 0}, {"high", 1e4}};
  return Json{{"format", "tractus-effect/1"},
              {"id", "expression:my_drag"},
              {"rig", "probing"},
              {"adds_to", "fz_N"},
              {"formula", "c * v_m_s * abs(v_m_s)"},
              {"parameters", {{"c", c}}}};
}

Json drag_use(double c) {
  return Json{
      {"id", "expression:my_drag"}, {"parameters", {{"c", c}}}, {"expression", drag_file()}};
}

std::string refusal(const Json& effects) {
  const auto model = ProbingModel::from_json(probing(effects), "m.json: ");
  return model ? "taken" : model.error().what;
}

std::string refusal_of_formula(const char* pointer, const Json& value) {
  Json use = drag_use(2.0);
  use["expression"][Json::json_pointer(pointer)] = value;
  return refusal(Json::array({use}));
}

TEST(EffectsInFiles, AreReadAndWrittenAgain) {
  const Json list = Json::parse(R"([
    {"id":"stribeck_friction","parameters":{"friction_N":1.5,"breakaway_N":2.5,
                                            "stribeck_velocity_m_s":0.003}},
    {"id":"sensor_bias","parameters":{"force_N":-0.4}}])");
  const auto model = ProbingModel::from_json(probing(list), "");
  ASSERT_TRUE(model) << model.error().what;
  ASSERT_EQ(model->effects.size(), 2u);
  EXPECT_EQ(model->effects[0].values, (std::vector<double>{1.5, 2.5, 0.003}));
  EXPECT_EQ(model->to_json()["effects"], list);
  EXPECT_EQ(ProbingModel::from_json(model->to_json(), "")->to_json(), model->to_json());
}

TEST(EffectsInFiles, AreRefusedByNameWithTheirRange) {
  const auto one = [](const char* text) { return refusal(Json::array({Json::parse(text)})); };
  EXPECT_EQ(one(R"({"id":"gravity","parameters":{}})"),
            "m.json: /effects/0/id: 'gravity' is an effect that this version does not know");
  EXPECT_EQ(one(R"({"id":"coulomb_friction","parameters":{"friction_N":-1}})"),
            "m.json: /effects/0/parameters/friction_N: -1 is outside 0 … 200");
  EXPECT_EQ(one(R"({"id":"hysteresis","parameters":{"stiffness_N_per_m":10}})"),
            "m.json: /effects/0/parameters/yield_displacement_m: is missing");
  EXPECT_EQ(one(R"({"id":"inertia","parameters":{"mass_kg":1,"mass_g":1}})"),
            "m.json: /effects/0/parameters/mass_g: this field is not known");
  EXPECT_EQ(one(R"({"id":"inertia","parameters":{"mass_kg":"1 kg"}})"),
            "m.json: /effects/0/parameters/mass_kg: a number is expected");
  EXPECT_EQ(one(R"({"id":"inertia"})"), "m.json: /effects/0/parameters: is missing");
  EXPECT_EQ(one(R"({"id":"inertia","parameters":[1]})"),
            "m.json: /effects/0/parameters: a JSON object is expected");
  EXPECT_EQ(one("7"), "m.json: /effects/0: an object with a text \"id\" is expected");
  EXPECT_EQ(
      one(R"({"id":"contact_friction","parameters":{"coefficient":0.2}})"),
      "m.json: /effects/0/id: 'contact_friction' is an effect that this version does not know");
  const Json mass = Json::parse(R"({"id":"inertia","parameters":{"mass_kg":1}})");
  EXPECT_EQ(refusal(Json::array({mass, mass})),
            "m.json: /effects/1/id: 'inertia' is in the list already");
}

TEST(EffectsInFiles, MayLeaveOutWhatHasAValueOtherwise) {
  const auto model = ProbingModel::from_json(
      probing(Json::parse(R"([{"id":"backlash","parameters":{"gap_m":4e-4}}])")), "");
  ASSERT_TRUE(model) << model.error().what;
  EXPECT_EQ(model->effects[0].values, (std::vector<double>{4e-4, 0.0}));
  EXPECT_EQ(model->to_json()["effects"][0]["parameters"]["damping_share"], 0.0);
}

TEST(UsersOwnEffects, TravelWholeInTheModelFile) {
  const auto model = ProbingModel::from_json(probing(Json::array({drag_use(5000.0)})), "");
  ASSERT_TRUE(model) << model.error().what;
  const auto again = ProbingModel::from_json(Json::parse(model->to_json().dump()), "");
  ASSERT_TRUE(again) << again.error().what;
  EXPECT_EQ(again->to_json(), model->to_json());
  const auto runtime = ProbingRuntime::make(*again, 0.05);
  ASSERT_TRUE(runtime) << runtime.error().what;
  ProbingForces forces;
  runtime->predict({.t_s = {0.0}, .x_m = {0.01}, .v_m_s = {-0.02}, .a_m_s2 = {0.0}}, forces);
  EXPECT_DOUBLE_EQ(forces.fz_N[0], -2.0);  // 5000 · 0.02²
}

TEST(UsersOwnEffects, AreRefusedByTheFieldThatIsWrong) {
  EXPECT_EQ(refusal(Json::array({drag_use(2e4)})),
            "m.json: /effects/0/parameters/c: 20000 is outside 0 … 10000");
  Json bare = drag_use(1.0);
  bare.erase("expression");
  EXPECT_EQ(refusal(Json::array({bare})), "m.json: /effects/0/expression: is missing");
  EXPECT_THAT(refusal_of_formula("/formula", "c * v_m_s + x_m"),
              HasSubstr("/effects/0/expression: expression:my_drag: /formula: `c * v_m_s + x_m`: "
                        "N*s/m and m"));
  EXPECT_THAT(refusal_of_formula("/formula", "1"), HasSubstr("`1`: 1 where N is expected"));
  EXPECT_THAT(refusal_of_formula("/formula", 7), HasSubstr("/formula: a text is expected"));
  EXPECT_THAT(refusal_of_formula("/rig", "palpation"),
              HasSubstr("/rig: 'palpation'; 'probing' is"));
  EXPECT_THAT(refusal_of_formula("/adds_to", "tz_Nm"), HasSubstr("/adds_to: 'tz_Nm'; 'fz_N' is"));
  EXPECT_THAT(refusal_of_formula("/id", "expression:other"), HasSubstr("is of 'expression:other'"));
  EXPECT_THAT(refusal_of_formula("/id", "expression:My Drag"),
              HasSubstr("/id: 'expression:My Drag'"));
  EXPECT_THAT(refusal_of_formula("/parameters/c/unit", "N*s2"), HasSubstr("'s2' is no unit"));
  EXPECT_THAT(refusal_of_formula("/parameters/c/high", -1),
              HasSubstr("/parameters/c/high: -1 is not"));
  EXPECT_THAT(refusal_of_formula("/parameters/c/initial", 2e4), HasSubstr("/parameters/c/initial"));
  EXPECT_THAT(refusal_of_formula("/parameters/d", drag_file()["parameters"]["c"]),
              HasSubstr("/parameters/d: the formula does not use it"));
  EXPECT_THAT(refusal_of_formula("/parameters/x_m", drag_file()["parameters"]["c"]),
              HasSubstr("/parameters/x_m: not a name for a parameter"));
  EXPECT_THAT(refusal_of_formula("/parameters/c/step", 1),
              HasSubstr("step: this field is not known"));
}

TEST(UsersOwnEffects, KnowTheirFactsAsTheCatalogueDoes) {
  auto file = drag_file();
  file["formula"] = "c * v_m_s^2 * sgn(v_m_s) / (1 + n * abs(omega_rad_s) * t0)";
  file["parameters"]["n"] = {{"unit", "1"}, {"initial", 0}, {"low", -1}, {"high", 1}};
  file["parameters"]["t0"] = {
      {"unit", "s"}, {"initial", 0.1}, {"low", 0.01}, {"high", 1}, {"logarithmic", true}};
  const auto own = effects::Expression::from_json(file, "f: ", effects::probing_expressions());
  ASSERT_TRUE(own) << own.error().what;
  const auto& facts = own->facts();
  EXPECT_EQ(facts.kind, effects::Kind::force);
  EXPECT_EQ(facts.needs, std::vector<std::string>{"omega_rad_s"});
  EXPECT_EQ(facts.params[0].off, 0.0);
  EXPECT_TRUE(std::isnan(facts.params[1].off));
  EXPECT_TRUE(facts.params[2].logarithmic);
  EXPECT_EQ(own->use().values, (std::vector<double>{1.0, 0.0, 0.1}));
  EXPECT_EQ(effects::probing_facts(own->use())->id, "expression:my_drag");
}

}  // namespace
}  // namespace models
}  // namespace tractus
