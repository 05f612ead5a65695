#include "models/model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tractus {
namespace models {
namespace {

using core::Json;
using testing::HasSubstr;

/// The palpation example of the file format's definition.
constexpr const char* kExample =
    R"({"format":"tractus-model/1","rig":"palpation","name":"uniform cantilever",
 "volume":"l3.nrrd","transfer":[[150,0],[700,1]],
 "base":{"force_factor_Nm":0.005,"force_scale":0.3,"torque_scale":0.3,"points":3,"point_spacing_m":0.009,
         "youngs_modulus_Pa":1.95e11,"length_m":0.13,"radius_m":0.0007,"pose_offset_m":[0,0,0],"field":"paper"},
 "fixed":["/base/length_m"],"effects":[]})";

Json example() { return *core::parse_json(kExample, "example"); }

/// The refusal of the example with one member replaced.
std::string refusal(const char* pointer, const Json& value) {
  Json json = example();
  json[Json::json_pointer(pointer)] = value;
  const auto model = PalpationModel::from_json(json, "m.json: ");
  return model ? "taken" : model.error().what;
}

TEST(PalpationModel, ReadsTheExampleOfTheFormat) {
  const auto model = PalpationModel::from_json(example(), "m.json: ");
  ASSERT_TRUE(model) << model.error().what;
  EXPECT_EQ(model->name, "uniform cantilever");
  EXPECT_EQ(model->volume, "l3.nrrd");
  EXPECT_EQ(model->transfer.opacity(425.0), 0.5);  // half way from 150 to 700
  EXPECT_EQ(model->base.youngs_modulus_Pa, 1.95e11);
  EXPECT_EQ(model->base.points, 3);
  EXPECT_EQ(model->field, volume::FieldKind::paper);
  EXPECT_THAT(model->fixed, testing::ElementsAre("/base/length_m"));
}

TEST(PalpationModel, IsTheSameValueAfterWritingAndReading) {
  EXPECT_EQ(PalpationModel::from_json(example(), "")->to_json(), example());
  Json other = example();
  other["base"]["field"] = "potential";
  other["base"]["radius_m"] = 0.1 / 137.0;  // no short decimal
  other["base"]["pose_offset_m"] = {0.0, 0.0045, 0.0005};
  other.erase("volume");
  const auto text = PalpationModel::from_json(other, "")->to_json().dump();
  EXPECT_EQ(PalpationModel::from_json(*core::parse_json(text, "t"), "")->to_json(), other);
}

TEST(PalpationModel, TakesThePapersNumbersForWhatIsNotSaid) {
  const auto json = core::parse_json(
      R"({"format":"tractus-model/1","rig":"palpation","name":"n","base":{}})", "t");
  const auto model = PalpationModel::from_json(*json, "");
  ASSERT_TRUE(model) << model.error().what;
  EXPECT_EQ(model->base.length_m, 0.13);          // [Zoller2020]: L = 130 mm
  EXPECT_EQ(model->base.point_spacing_m, 0.009);  // 9 mm apart
  EXPECT_EQ(model->base.force_factor_Nm, 0.005);  // 5 N·mm
}

TEST(PalpationModel, RefusesAnotherRigByName) {
  EXPECT_THAT(refusal("/rig", "probing"),
              HasSubstr("m.json: /rig: 'probing' is a model of the other rig; 'palpation' is"));
  EXPECT_THAT(refusal("/rig", "driving"), HasSubstr("'driving' is not a rig"));
  EXPECT_THAT(refusal("/format", "tractus-model/9"), HasSubstr("/format: 'tractus-model/9'"));
}

TEST(PalpationModel, KeepsItsEffectsThroughAFile) {
  Json json = example();
  json["effects"] = Json::parse(R"([{"id":"tip_ball","parameters":{"radius_m":0.001}},
    {"id":"sensor_bias","parameters":{"force_N":[0.1,-0.2,0],"torque_Nm":[0,0,0.003]}}])");
  const auto model = PalpationModel::from_json(json, "");
  ASSERT_TRUE(model) << model.error().what;
  ASSERT_EQ(model->effects.size(), 2u);
  EXPECT_EQ(model->effects[1].id, "sensor_bias");
  EXPECT_THAT(model->effects[1].values, testing::ElementsAre(0.1, -0.2, 0, 0, 0, 0.003));
  EXPECT_EQ(model->to_json(), json);
}

TEST(PalpationModel, RefusesByNameAnEffectThatCannotBe) {
  const auto of = [](const char* text) { return refusal("/effects", Json::parse(text)); };
  EXPECT_EQ(of(R"([{"id":"tissue_flap","parameters":{"radius_m":0.001}}])"),
            "m.json: /effects/0/id: 'tissue_flap' is an effect that this version does not know");
  EXPECT_THAT(of(R"([{"id":"tip_ball","parameters":{"radius_m":1}}])"),
              HasSubstr("m.json: /effects/0/parameters/radius_m: 1 is outside"));
  EXPECT_THAT(of(R"([{"id":"tip_ball"}])"), HasSubstr("m.json: /effects/0/parameters: is missing"));
  EXPECT_THAT(of(R"([{"id":"tip_ball","parameters":{"radius_mm":1}}])"),
              HasSubstr("m.json: /effects/0/parameters/radius_m: is missing"));
  EXPECT_THAT(of(R"([{"id":"pose_offset","parameters":{"offset_m":[0,1,0]}}])"),
              HasSubstr("m.json: /effects/0/parameters/offset_m: 1 is outside"));
  EXPECT_THAT(of(R"([{"id":"pose_offset","parameters":{"offset_m":[0,0]}}])"),
              HasSubstr("m.json: /effects/0/parameters/offset_m"));
  EXPECT_THAT(of(R"([{"id":"tip_ball","parameters":{"radius_m":0.001}},
                    {"id":"tip_ball","parameters":{"radius_m":0.001}}])"),
              HasSubstr("m.json: /effects/1/id: 'tip_ball' is in the list already"));
  EXPECT_THAT(of("[3]"), HasSubstr("/effects/0: an object"));
  EXPECT_THAT(refusal("/effects", "none"), HasSubstr("/effects: an array is expected"));
}

struct Refusal {
  const char* pointer;
  const char* value;
  const char* message;
};
class ABadField : public testing::TestWithParam<Refusal> {};

TEST_P(ABadField, IsRefusedByItsName) {
  const auto& [pointer, value, message] = GetParam();
  EXPECT_THAT(refusal(pointer, Json::parse(value)),
              testing::StartsWith(std::string("m.json: ") + message));
}

INSTANTIATE_TEST_SUITE_P(
    PalpationModel, ABadField,
    testing::Values(
        Refusal{"/name", "7", "/name: a text"}, Refusal{"/volume", "[]", "/volume: a text"},
        Refusal{"/colour", "1", "/colour: this field is not known"},
        Refusal{"/base/mass_kg", "1", "/base/mass_kg: this field is not known"},
        Refusal{"/base", "[]", "/base: a JSON object"},
        Refusal{"/base/length_m", "130", "/base/length_m: 130"},
        Refusal{"/base/length_m", "\"0.13\"", "/base/length_m: a number"},
        Refusal{"/base/radius_m", "0", "/base/radius_m: 0 is outside"},
        Refusal{"/base/radius_m", "null", "/base/radius_m: a number"},
        Refusal{"/base/force_factor_Nm", "-1", "/base/force_factor_Nm: -1 is outside"},
        Refusal{"/base/youngs_modulus_Pa", "195", "/base/youngs_modulus_Pa: 195 is outside"},
        Refusal{"/base/points", "0", "/base/points: 0 is outside"},
        Refusal{"/base/points", "2.5", "/base/points: a whole number"},
        Refusal{"/base/points", "65", "/base/points: 65 is outside"},
        Refusal{"/base/points", "20", "/base/points: 20 points"},  // 19 · 9 mm = 171 mm > 130 mm
        Refusal{"/base/pose_offset_m", "[0,0]", "/base/pose_offset_m: an array of 3"},
        Refusal{"/base/pose_offset_m", "[0,4.5,0.5]", "/base/pose_offset_m: is longer than 1 m"},
        Refusal{"/base/field", "\"wrong\"", "/base/field: 'wrong'"},
        Refusal{"/transfer", "[[150,0]]", "/transfer: at least two points"},
        Refusal{"/transfer", "{}", "/transfer: an array"},
        Refusal{"/transfer", "[[1],[2]]", "/transfer/0: two numbers"},
        Refusal{"/transfer", "[[700,0],[150,1]]", "/transfer: point 1"},
        Refusal{"/transfer", "[[150,0],[700,1.5]]", "/transfer: point 1"},
        Refusal{"/fixed", "[3]", "/fixed/0: a JSON pointer"},
        Refusal{"/fixed", "[\"/base/lenght_m\"]", "/fixed/0: '/base/lenght_m' names no parameter"},
        Refusal{"/fixed", "[\"/name\"]", "/fixed/0: '/name' names no parameter"},
        Refusal{"/fixed", "[\"/base/length_m/*\"]", "/fixed/0"},
        Refusal{"/fixed", "[\"/base/pose_offset_m/3\"]", "/fixed/0"},
        Refusal{"/fixed", "\"/base/length_m\"", "/fixed: an array"}));

TEST(PalpationModel, TakesAStarForEveryElementInFixed) {
  Json json = example();
  json["fixed"] = {"/base/pose_offset_m/*", "/base/pose_offset_m/1", "/base/points"};
  EXPECT_TRUE(PalpationModel::from_json(json, ""));
}

TEST(PalpationModel, NamesAFileThatIsNotThere) {
  const auto model = PalpationModel::read("/nonexistent/m.json");
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, core::Errc::not_found);
}

}  // namespace
}  // namespace models
}  // namespace tractus
