/// `tractus carve` and `tractus case` from the outside, on a made vertebra.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <checkout.hpp>
#include <cstdlib>
#include <filesystem>

#include "cases/case.hpp"
#include "core/file.hpp"

namespace tractus {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using volume::Vec3;

struct Ran {
  int exit = -1;
  std::string out, err;
};

/// A made vertebra, mirrored about x = 5 mm: a body with a shell of 2 mm, two hollow pedicles with
/// walls of 2 mm (centred 17 mm off the midline, 10 mm wide, 14 mm high), a spine. Its left pedicle
/// runs from y = 22 mm into the body at y = −8 mm.
double made_vertebra(const Vec3& p_m) {
  const Vec3 p = p_m * 1e3 - Vec3(5, 0, 0);
  const double u = std::abs(p.x()), off = std::abs(u - 17), z = std::abs(p.z());
  const double body = std::hypot(u / 25, (p.y() + 22) / 17);
  const bool in_body = body < 1 && z < 13,
             marrow = std::hypot(u / 23, (p.y() + 22) / 15) < 1 && z < 11;
  const bool pedicle = off < 5 && z < 7 && p.y() > -14 && p.y() < 22;
  const bool core = off < 3 && z < 5 && p.y() > -16 && p.y() < 20;
  const bool spine = u < 3 && p.y() > 16 && p.y() < 40 && z < 8;
  if (core || (marrow && !pedicle)) return 60;
  return in_body || pedicle || spine ? 900 : 20;
}

class Carve : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    top_ = fs::temp_directory_path() /
           ("tractus_carve_" + std::to_string(::getpid()) + "_" + core::new_id());
    fs::create_directories(top_ / "in");
    volume::Volume v{.geometry = {{80, 90, 44},
                                  Vec3::Constant(0.001),
                                  Vec3(-0.0345, -0.0445, -0.0215),
                                  volume::Mat3::Identity()},
                     .slope = 1,
                     .intercept = -1024,
                     .counts = {}};
    for (int k = 0; k < 44; ++k)
      for (int j = 0; j < 90; ++j)
        for (int i = 0; i < 80; ++i)
          v.counts.push_back(v.count_of(made_vertebra(v.geometry.position_of(Vec3(i, j, k)))));
    ASSERT_TRUE(volume::write_volume(top_ / "in" / "ct.tvol", v, {"made", ""}));
  }
  static void TearDownTestSuite() { fs::remove_all(top_); }

  void SetUp() override { fs::create_directories(work()); }
  void TearDown() override { fs::remove_all(work()); }
  static fs::path work() { return top_ / "work"; }

  static Ran tractus(const std::string& arguments) {
    const fs::path out = top_ / "out.txt", err = top_ / "err.txt";
    const std::string line = fmt::format("cd '{}' && '{}/tractus' {} >'{}' 2>'{}'", work().string(),
                                         checkout::kBin, arguments, out.string(), err.string());
    const int status = std::system(line.c_str());
    const auto text = [](const fs::path& path) {
      return std::string(core::text_of(*core::read_file(path)));
    };
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text(out), text(err)};
  }
  static Ran carve(const std::string& more) {
    const bool spaced = more.find("--spacing") != std::string::npos;
    return tractus("carve --volume ../in/ct.tvol --key ../signing.key --out case --margin 10 " +
                   more + (spaced ? "" : " --spacing 0.5"));
  }
  static constexpr const char* kLeft = "--entry 22,19,0 --target 22,-20,0 ";
  inline static fs::path top_;
};

TEST_F(Carve, MakesACaseWhoseTruthIsWhereTheWallIs) {
  const auto ran =
      carve(std::string(kLeft) + "--breach medial --breach-depth 2 --json --png ../picture.png");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const auto report = core::parse_json(ran.out, "out");
  ASSERT_TRUE(report) << ran.out;
  EXPECT_EQ((*report)["side"], "left");
  EXPECT_NEAR((*report)["midline"]["x_m"].get<double>(), 0.005, 0.001);
  const auto opened = cases::open_case(work() / "case");
  ASSERT_TRUE(opened) << opened.error().what;
  EXPECT_EQ((*report)["case"], opened->id);
  const auto truth = cases::read_truth(*opened);
  ASSERT_TRUE(truth);
  EXPECT_EQ(truth->breached, volume::Wall::medial);
  EXPECT_NEAR(truth->breach_m->x(), 0.018,
              0.0005);  // medial wall from 12 to 14 mm left of the midline at 5 mm
  EXPECT_NEAR(truth->wall_thickness_m, 0.002, 0.0005);
  EXPECT_EQ(truth->breach_depth_m, 0.002);
  EXPECT_GT(fs::file_size(top_ / "picture.png"), 1000u);
  const auto drilled = volume::VolumeFile::open(work() / "case" / "volume.tvol")->read_all();
  ASSERT_TRUE(drilled);
  EXPECT_NEAR(drilled->value_at(*truth->breach_m), 0.0, 1.0);  // where the wall was
  EXPECT_GT(drilled->value_at(*truth->breach_m + Vec3(0, 0, 0.004)),
            700.0);  // the wall above the hole
  EXPECT_EQ(drilled->geometry.spacing_m, Vec3::Constant(0.0005));
}

TEST_F(Carve, FillsMarrowAndSaysWhatCanBeFelt) {
  const auto ran = carve(std::string(kLeft) + "--breach medial --preparation filled --json");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const auto report = core::parse_json(ran.out, "out");
  ASSERT_TRUE(report) << ran.out;
  EXPECT_EQ((*report)["preparation"], "filled");
  EXPECT_EQ((*report)["certificate"]["walls"].size(), 5u);
  const auto opened = cases::open_case(work() / "case");
  ASSERT_TRUE(opened) << opened.error().what;
  EXPECT_EQ(opened->definition.preparation, volume::Preparation::filled);
  ASSERT_TRUE(opened->definition.certified);
  const bool passes = (*report)["certificate"]["passes"].get<bool>();
  EXPECT_EQ(*opened->definition.certified, passes);
  EXPECT_EQ(tractus("case certify case").exit, passes ? 0 : 1);
  // Marrow of 60 HU above the channel: α = 0.8 + 0.2 · 60/700, so 150 + 550 α = 599.4 HU by hand.
  const auto drilled = volume::VolumeFile::open(work() / "case" / "volume.tvol")->read_all();
  ASSERT_TRUE(drilled);
  EXPECT_NEAR(drilled->value_at(Vec3(0.022, 0.014, 0.003)), 599.4, 2.0);
  for (const cases::Part& part : opened->definition.parts)
    EXPECT_EQ(part.secret, part.name != cases::kVolumePart) << part.name;
}

TEST_F(Carve, TakesAPersonsWordWhereTheEnvelopeIsWrong) {
  const std::string filled = std::string(kLeft) + "--preparation filled ";
  ASSERT_EQ(carve(filled + "--bone-at 31,0,0").exit, 0) << "outside the lateral wall";
  const auto drilled = volume::VolumeFile::open(work() / "case" / "volume.tvol")->read_all();
  ASSERT_TRUE(drilled);
  EXPECT_GT(drilled->value_at(Vec3(0.031, 0.0, 0.0)), 500.0);
  fs::remove_all(work() / "case");
  ASSERT_EQ(carve(filled).exit, 0);
  const auto before = volume::VolumeFile::open(work() / "case" / "volume.tvol")->read_all();
  ASSERT_TRUE(before);
  EXPECT_LT(before->value_at(Vec3(0.031, 0.0, 0.0)), 100.0);
}

TEST_F(Carve, TakesALineThatWasDrawnInSlicer) {
  const std::string drawn =
      R"({"markups": [{"type": "Line", "coordinateSystem": "RAS", "controlPoints": [)"
      R"({"position": [-22, -19, 0]}, {"position": [-22, 20, 0]}]}]})";
  ASSERT_TRUE(core::write_file(work() / "line.mrk.json", core::bytes_of(drawn)));
  const auto ran = carve("--plan line.mrk.json");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const auto opened = cases::open_case(work() / "case");
  ASSERT_TRUE(opened) << opened.error().what;
  EXPECT_LT((opened->definition.tract.end_m() - Vec3(0.022, -0.02, 0)).norm(), 1e-9);
  fs::remove_all(work() / "case");
  EXPECT_EQ(carve("--plan line.mrk.json " + std::string(kLeft)).exit, 2);
  const auto neither = carve("");
  EXPECT_EQ(neither.exit, 2);
  EXPECT_THAT(neither.err, HasSubstr("give --entry and --target, or --plan FILE.mrk.json"));
}

TEST_F(Carve, WritesACaseForSlicerWhoseLineMakesTheSameTract) {
  ASSERT_EQ(carve(kLeft).exit, 0);
  const auto ran = tractus("slicer --case case --out seen --json");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const auto report = core::parse_json(ran.out, "out");
  ASSERT_TRUE(report) << ran.out;
  EXPECT_EQ((*report)["surface_value"], 425.0);  // half way from 150 to 700 HU
  for (const char* file : {"volume.nrrd", "bone.stl", "channel.stl", "plan.mrk.json"})
    EXPECT_GT(fs::file_size(work() / "seen" / file), 200u) << file;
  fs::rename(work() / "case", work() / "first");
  ASSERT_EQ(carve("--plan seen/plan.mrk.json").exit, 0);
  const auto first = cases::open_case(work() / "first"), again = cases::open_case(work() / "case");
  ASSERT_TRUE(first && again);
  EXPECT_LT((again->definition.tract.end_m() - first->definition.tract.end_m()).norm(), 1e-9);
  EXPECT_THAT(tractus("slicer --case case --out seen").err, HasSubstr("seen: exists already"));
  EXPECT_THAT(tractus("slicer --case case --surface 5000 --out high").err,
              HasSubstr("--surface: no surface lies at the CT value 5000"));
  EXPECT_FALSE(fs::exists(work() / "high"));
}

TEST_F(Carve, TriesACaseThatWasMadeWithoutACertificate) {
  ASSERT_EQ(carve("--no-channel " + std::string(kLeft)).exit, 0);
  const auto ran = tractus("case certify case");
  EXPECT_EQ(ran.exit, 2);
  EXPECT_THAT(ran.err, HasSubstr("a planned channel has no walls to feel"));
}

TEST_F(Carve, KnowsTheRightPedicleFromTheLeft) {
  const auto ran = carve("--entry=-12,19,0 --target=-12,-20,0 --breach lateral --json");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const auto truth = cases::read_truth(*cases::open_case(work() / "case"));
  EXPECT_EQ(truth->breached, volume::Wall::lateral);
  EXPECT_NEAR(truth->breach_m->x(), 0.005 - 0.021,
              0.0005);  // lateral wall from 20 to 22 mm right of the midline
}

TEST_F(Carve, TakesUnitsThatAreWrittenOut) {
  const auto ran =
      carve("--entry '0.022,0.019,0 m' --target 22,-20,0mm --length 20mm --radius 0.002m --json");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const auto tract = (*core::parse_json(ran.out, "out"))["tract"];
  EXPECT_EQ(tract["length_m"], 0.02);
  EXPECT_EQ(tract["radius_m"], 0.002);
}

TEST_F(Carve, RefusesWithOneLineAndLeavesNothingBehind) {
  const std::string left = kLeft;
  const std::vector<std::pair<std::string, const char*>> wrong{
      {"--entry 22,19 --target 22,-20,0", "--entry: '22,19'"},
      {"--entry 22,nan,0 --target 22,-20,0", "--entry"},
      {"--entry 1e400,0,0 --target 22,-20,0", "--entry"},
      {"--entry 22,19,0 --target 22,19,0", "a length of 0 mm"},
      {"--entry 22,19,0", "give --entry and --target, or --plan FILE.mrk.json"},
      {"--entry 90,19,0 --target 22,-20,0",
       "ct.tvol: the entry (90.0, 19.0, 0.0) mm lies outside the volume"},
      {left + "--length 100", "the tract's end"},
      {left + "--length 0", "a length of 0 mm"},
      {left + "--radius -1", "a radius of -1 mm"},
      {left + "--radius 3km", "--radius: '3km'"},
      {left + "--spacing 0", "a spacing of 0 mm"},
      {left + "--breach up", "--breach: 'up'"},
      {left + "--breach-depth 3", "--breach-depth: needs --breach"},
      {left + "--breach medial --breach-depth 0", "breach's depth of 0 mm"},
      {left + "--breach medial --breach-at 60", "not along the tract"},
      {left + "--breach anterior --breach-at 6", "no other place"},
      {left + "--breach anterior --length 12 --breach-depth 24", "anterior"},
      {left + "--midline-x 22", "from the midline"},
      {left + "--midline-x 900", "a distance from entry to midline of"},
      {"--entry 40,25,19 --target 40,10,19 --midline-x 5", "meets no bone"},
      {left + "--model none.json", "none.json"},
      {left + "--preparation solid", "--preparation: 'solid'"},
      {left + "--envelope mask.nii", "--envelope: needs --preparation filled"},
      {left + "--bone-at 1,2,3", "--bone-at and --no-bone-at: need --preparation filled"},
      {left + "--preparation filled --no-bone-at 1,2", "--no-bone-at: '1,2'"},
      {left + "--calibrated", "ct.tvol: the transfer function cannot be calibrated"},
      {left + "--certified --no-channel", "--certified"},
      {left + "--png none/picture.png", "none/picture.png"},
  };
  for (const auto& [arguments, expected] : wrong) {
    const auto ran = carve(arguments);
    EXPECT_EQ(ran.exit, 2) << arguments << ran.out;
    EXPECT_THAT(ran.err, HasSubstr(expected)) << arguments;
    EXPECT_EQ(std::ranges::count(ran.err, '\n'), 1) << ran.err;
    EXPECT_TRUE(fs::is_empty(work())) << arguments;
  }
}

TEST_F(Carve, NeverOverwritesACase) {
  ASSERT_EQ(carve(kLeft).exit, 0);
  const auto again = carve(kLeft);
  EXPECT_EQ(again.exit, 2);
  EXPECT_THAT(again.err, HasSubstr("case: exists already"));
}

TEST_F(Carve, IsVerifiedUntilSomebodyTouchesIt) {
  ASSERT_EQ(carve(kLeft).exit, 0);
  EXPECT_EQ(tractus("case verify case").exit, 0);
  EXPECT_THAT(tractus("case show case").out, HasSubstr("truth.json"));
  ASSERT_TRUE(core::write_file(work() / "case" / "truth.json", core::bytes_of("{}")));
  const auto verified = tractus("case verify case");
  EXPECT_EQ(verified.exit, 1);
  EXPECT_THAT(verified.out, HasSubstr("truth.json: has 2 bytes"));
  EXPECT_EQ(tractus("case show case").exit, 2);
  EXPECT_EQ(tractus("case verify nowhere").exit, 2);
}

}  // namespace
}  // namespace tractus
