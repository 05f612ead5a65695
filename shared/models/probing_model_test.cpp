#include "models/probing_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tractus {
namespace models {
namespace {

using core::Json;
using testing::HasSubstr;

/// The probing example of the file format's definition, its friction left out and one layer added.
constexpr const char* kProbingExample =
    R"({"format":"tractus-model/1","rig":"probing","name":"layered bone",
 "base":{"layers":[{"start_m":0,"thickness_m":0.004,"stiffness_N_per_m":4000,"damping_Ns_per_m":2000,"equilibrium_m":0},
                   {"start_m":0.004,"thickness_m":0.006,"stiffness_N_per_m":5000,"damping_Ns_per_m":2500,"equilibrium_m":0.004}],
         "rotary":{"viscous_Nms_per_rad":0.02,"detent_Nm":0.01,"detent_pitch_rad":0.35}},
 "fixed":["/base/layers/*/start_m","/base/rotary/detent_Nm"],"effects":[]})";

Json probing_example() { return *core::parse_json(kProbingExample, "example"); }

std::string refusal(const char* pointer, const char* value) {
  Json json = probing_example();
  json[Json::json_pointer(pointer)] = Json::parse(value);
  const auto model = ProbingModel::from_json(json, "m.json: ");
  return model ? "taken" : model.error().what;
}

TEST(ProbingModel, ReadsTheExampleOfTheFormat) {
  const auto model = ProbingModel::from_json(probing_example(), "m.json: ");
  ASSERT_TRUE(model) << model.error().what;
  EXPECT_EQ(model->name, "layered bone");
  ASSERT_EQ(model->layers.size(), 2u);
  EXPECT_EQ(model->layers[1].stiffness_N_per_m, 5000.0);
  EXPECT_EQ(model->rotary.detent_pitch_rad, 0.35);
  EXPECT_THAT(model->fixed,
              testing::ElementsAre("/base/layers/*/start_m", "/base/rotary/detent_Nm"));
}

TEST(ProbingModel, IsTheSameValueAfterWritingAndReading) {
  Json other = probing_example();
  other["base"]["layers"][0]["damping_Ns_per_m"] = 1000.0 / 3.0;  // no short decimal
  const auto text = ProbingModel::from_json(other, "")->to_json().dump();
  EXPECT_EQ(ProbingModel::from_json(*core::parse_json(text, "t"), "")->to_json(), other);
}

TEST(ProbingModel, RunsTheLawItDescribes) {
  const auto law = ProbingModel::from_json(probing_example(), "")->law(0.05);
  ASSERT_TRUE(law);
  // eq. (2): D v + K (x − x0): 2000 · 0.005 + 4000 · 0.003 = 22 N; 2500 · 0.005 + 5000 · 0.002
  // = 22.5
  EXPECT_NEAR(law->force_N(0.003, 0.005), 22.0, 1e-12);
  EXPECT_NEAR(law->force_N(0.006, 0.005), 22.5, 1e-12);
}

TEST(ProbingModel, MayHoldOneLayerOrNone) {
  Json json = probing_example();
  json["fixed"] = Json::array();
  json["base"]["layers"] = Json::array();
  const auto none = ProbingModel::from_json(json, "");
  ASSERT_TRUE(none) << none.error().what;
  EXPECT_EQ(none->law(0.05)->force_N(0.02, 0.01), 0.0);
  json["base"]["layers"] = Json::array({probing_example()["base"]["layers"][0]});
  json["base"].erase("rotary");
  const auto one = ProbingModel::from_json(json, "");
  ASSERT_TRUE(one) << one.error().what;
  EXPECT_EQ(one->rotary.viscous_Nms_per_rad, laws::RotaryStage{}.viscous_Nms_per_rad);
}

TEST(ProbingModel, TakesRoundingBetweenLayersAsOneBorder) {
  for (const double gap_m : {-1e-6, 1e-6}) {
    Json json = probing_example();
    Json& layers = json["base"]["layers"];
    const double border_m =
        layers[0]["start_m"].get<double>() + layers[0]["thickness_m"].get<double>();
    const double end_m = border_m + gap_m + layers[1]["thickness_m"].get<double>();
    layers[1]["start_m"] = border_m + gap_m;
    const auto model = ProbingModel::from_json(json, "");
    ASSERT_TRUE(model) << model.error().what;
    EXPECT_DOUBLE_EQ(model->layers[1].start_m, border_m);
    EXPECT_DOUBLE_EQ(model->layers[1].start_m + model->layers[1].thickness_m, end_m);
    ASSERT_EQ(model->remarks.size(), 1u);
    EXPECT_THAT(model->remarks[0], HasSubstr(gap_m > 0.0 ? "a gap of 1 µm" : "an overlap of 1 µm"));
  }
}

TEST(ProbingModel, RefusesByNameWhatCannotBe) {
  EXPECT_THAT(refusal("/base/layers/1/stiffness_N_per_m", "-1"),
              HasSubstr("m.json: /base/layers/1/stiffness_N_per_m: -1"));
  EXPECT_THAT(refusal("/base/layers/0/stiffness_N_per_m", "1e9"),
              HasSubstr("m.json: /base/layers/0/stiffness_N_per_m: 1"));
  EXPECT_THAT(refusal("/base/layers/1/start_m", "0.003"),
              HasSubstr("m.json: /base/layers/1/start_m: 0.003 lies inside the layer before it"));
  EXPECT_THAT(refusal("/base/layers/0/damping_Ns_per_m", "0"),
              HasSubstr("m.json: /base/layers/0/damping_Ns_per_m: 0"));
  EXPECT_THAT(refusal("/base/layers/0/thickness_m", "\"4 mm\""),
              HasSubstr("m.json: /base/layers/0/thickness_m: a number is expected"));
  EXPECT_THAT(refusal("/base/layers/0/mass_kg", "1"),
              HasSubstr("m.json: /base/layers/0/mass_kg: this field is not known"));
  EXPECT_THAT(refusal("/base/layers/0", "7"), HasSubstr("m.json: /base/layers/0: a JSON object"));
  EXPECT_THAT(refusal("/base/layers", "{}"), HasSubstr("m.json: /base/layers: an array"));
  EXPECT_THAT(refusal("/base/rotary/detent_Nm", "-1"),
              HasSubstr("m.json: /base/rotary/detent_Nm: -1 is outside"));
  EXPECT_THAT(refusal("/base", "[]"), HasSubstr("m.json: /base: a JSON object"));
  EXPECT_THAT(refusal("/fixed", R"(["/base/layers/*/mass_kg"])"),
              HasSubstr("m.json: /fixed/0: '/base/layers/*/mass_kg' names no parameter"));
  EXPECT_THAT(refusal("/effects", R"([{"id":"tip_ball","parameters":{"radius_m":0.001}}])"),
              HasSubstr("m.json: /effects/0/id: 'tip_ball' is an effect"));
}

TEST(AModelFile, SaysWhichRigItIsOf) {
  const auto probing = model_from_json(probing_example(), "");
  ASSERT_TRUE(probing);
  EXPECT_TRUE(std::holds_alternative<ProbingModel>(*probing));
  const auto palpation = model_from_json(Json{{"format", "tractus-model/1"},
                                              {"rig", "palpation"},
                                              {"name", "n"},
                                              {"base", Json::object()}},
                                         "");
  ASSERT_TRUE(palpation) << palpation.error().what;
  EXPECT_TRUE(std::holds_alternative<PalpationModel>(*palpation));
  EXPECT_THAT(
      refusal("/rig", "\"palpation\""),
      HasSubstr("m.json: /rig: 'palpation' is a model of the other rig; 'probing' is expected"));
  EXPECT_FALSE(model_from_json(Json::parse(R"({"rig":7})"), ""));
}

}  // namespace
}  // namespace models
}  // namespace tractus
