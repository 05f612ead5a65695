#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <random>

#include "capture/assemble.hpp"
#include "core/bytes.hpp"

namespace tractus {
namespace capture {
namespace {
namespace fs = std::filesystem;
using math::Vec3;

class Capture : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path file(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  fs::path folder_ = fs::temp_directory_path() / core::new_id();
};

// A quarter turn about z: columns (0,1,0), (−1,0,0), (0,0,1), as QTM lists them.
const char* const kQtm =
    "NO_OF_FRAMES\t2\r\nNO_OF_BODIES\t2\r\nFREQUENCY\t100\r\nDATA_INCLUDED\t6D\r\n"
    "BODY_NAMES\tprobe\tbone\r\n"
    "Frame\tTime\tprobe X\tY\tZ\tRoll\tPitch\tYaw\tResidual\tRot[0]\tRot[1]\tRot[2]\tRot[3]\tRot[4]"
    "\tRot[5]\tRot[6]\tRot[7]\tRot[8]\tbone X\tY\tZ\tRoll\tPitch\tYaw\tResidual\tRot[0]\tRot[1]"
    "\tRot[2]\tRot[3]\tRot[4]\tRot[5]\tRot[6]\tRot[7]\tRot[8]\r\n"
    "1\t0.00000\t10.000\t20.000\t30.000\t0\t0\t90\t0.3\t0\t1\t0\t-1\t0\t0\t0\t0\t1"
    "\t1\t2\t3\t0\t0\t0\t0.2\t1\t0\t0\t0\t1\t0\t0\t0\t1\r\n"
    "2\t0.01000\t11.000\t20.000\t30.000\t0\t0\t90\t0.3\t0\t1\t0\t-1\t0\t0\t0\t0\t1"
    "\t0\t0\t0\t0\t0\t0\t-1\t0\t0\t0\t0\t0\t0\t0\t0\t0\r\n";

TEST_F(Capture, ReadsBodiesOfAQtmExportInMetres) {
  const auto motion = read_motion(file("m.tsv", kQtm));
  ASSERT_TRUE(motion) << motion.error().what;
  const BodyTrack& probe = motion->bodies.at("probe");
  ASSERT_EQ(probe.t_s.size(), 2u);
  EXPECT_LT((probe.X_CB[1].p - Vec3(0.011, 0.020, 0.030)).norm(), 1e-12);
  EXPECT_LT((probe.X_CB[0].q * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-9);
  EXPECT_EQ(motion->bodies.at("bone").t_s.size(), 1u);  // not seen in the second frame
}

TEST_F(Capture, ReadsMarkersOfAQtmExport) {
  const auto motion = read_motion(file(
      "m.tsv",
      "NO_OF_FRAMES\t2\nFREQUENCY\t200\nDATA_INCLUDED\t3D\nMARKER_NAMES\ta\tb\n"
      "a X\ta Y\ta Z\tb X\tb Y\tb Z\n1.0\t2.0\t3.0\t4\t5\t6\n1.5\t2\t3\t0.000\t0.000\t0.000\n"));
  ASSERT_TRUE(motion) << motion.error().what;
  EXPECT_EQ(motion->markers.at("a").t_s, (std::vector<double>{0.0, 0.005}));
  EXPECT_EQ(motion->markers.at("b").t_s.size(), 1u);
  EXPECT_NEAR(motion->markers.at("a").p_C_m[1].x(), 0.0015, 1e-12);
}

// As Qualisys exports markers: no row of column names, a stamp before, a tab at the lines' ends.
TEST_F(Capture, ReadsMarkersOfAQtmExportWithoutARowOfNames) {
  const std::string head =
      "NO_OF_FRAMES\t2\nNO_OF_CAMERAS\t20\nNO_OF_MARKERS\t2\nFREQUENCY\t200\nNO_OF_ANALOG\t0\n"
      "ANALOG_FREQUENCY\t0\nDESCRIPTION\t--\nTIME_STAMP\t2022-06-03, 10:47:36.627\t94247.454\n"
      "DATA_INCLUDED\t3D\nMARKER_NAMES\ta\tb\t\nTRAJECTORY_TYPES\tMeasured\tMeasured\n";
  const auto bare = read_motion(file("m.tsv", head + "1\t2\t3\t4\t5\t6\t\n7\t8\t9\t1\t2\t3\t\n"));
  ASSERT_TRUE(bare) << bare.error().what;
  EXPECT_EQ(bare->markers.at("b").t_s, (std::vector<double>{0.0, 0.005}));
  EXPECT_EQ(bare->markers.at("b").p_C_m[1], 1e-3 * Vec3(1, 2, 3));
  const auto numbered =
      read_motion(file("n.tsv", head + "1\t0.5\t1\t2\t3\t4\t5\t6\n2\t0.505\t7\t8\t9\t1\t2\t3\n"));
  ASSERT_TRUE(numbered) << numbered.error().what;
  EXPECT_EQ(numbered->markers.at("a").t_s, (std::vector<double>{0.5, 0.505}));
  EXPECT_EQ(numbered->markers.at("a").p_C_m[0], 1e-3 * Vec3(1, 2, 3));
}

TEST_F(Capture, ReadsMarkersOfAMotiveExport) {
  const auto motion = read_motion(
      file("m.csv",
           "Format Version,1.22,Take Name,t,Export Frame Rate,100,Length Units,Meters\n\n"
           ",,Rigid Body Marker,Rigid Body Marker,Rigid Body Marker,Marker,Marker,Marker\n"
           ",,\"probe:Marker1\",\"probe:Marker1\",\"probe:Marker1\",probe:M1,probe:M1,probe:M1\n"
           ",,Position,Position,Position,Position,Position,Position\n"
           "Frame,Time (Seconds),X,Y,Z,X,Y,Z\n0,0.0,9,9,9,0.1,0.2,0.3\n1,0.01,9,9,9,,,\n"));
  ASSERT_TRUE(motion) << motion.error().what;
  ASSERT_EQ(motion->markers.size(), 1u);  // what was measured, not what the solver put there
  EXPECT_EQ(motion->markers.at("probe:M1").t_s.size(), 1u);
  EXPECT_EQ(motion->markers.at("probe:M1").p_C_m[0], Vec3(0.1, 0.2, 0.3));
}

TEST_F(Capture, ReadsRigidBodiesOfAMotiveExport) {
  const auto motion = read_motion(
      file("m.csv",
           "Format Version,1.23,Take Name,t,Export Frame Rate,120.000000,Rotation Type,Quaternion,"
           "Length Units,Millimeters,Coordinate Space,Global\n\n"
           ",Type,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body\n"
           ",Name,probe,probe,probe,probe,probe,probe,probe\n,ID,1,1,1,1,1,1,1\n"
           ",,Rotation,Rotation,Rotation,Rotation,Position,Position,Position\n"
           "Frame,Time (Seconds),X,Y,Z,W,X,Y,Z\n"
           "0,0.000000,0,0,0.70710678,0.70710678,100,200,300\n1,0.008333,,,,,,,\n"
           "2,0.016667,0,0,0,1,101,200,300\n"));
  ASSERT_TRUE(motion) << motion.error().what;
  const BodyTrack& probe = motion->bodies.at("probe");
  ASSERT_EQ(probe.t_s.size(), 2u);
  EXPECT_LT((probe.X_CB[0].p - Vec3(0.1, 0.2, 0.3)).norm(), 1e-12);
  EXPECT_LT((probe.X_CB[0].q * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-7);
}

// As QTM 2020 writes them: each value is followed by a tab, the last one too. A rotation's columns
// stand one after the other: Rot[1] is the sine of a yaw, here of 90 degrees.
TEST_F(Capture, FindsAQtmBodysColumnsByTheirNames) {
  const std::string columns =
      " X\tY\tZ\tRoll\tPitch\tYaw\tResidual\tRot[0]\tRot[1]\tRot[2]\tRot[3]\tRot[4]\tRot[5]\tRot[6]"
      "\t"
      "Rot[7]\tRot[8]\t";
  const std::string values = "\t0\t0\t0\t0\t90\t0.2\t0\t1\t0\t-1\t0\t0\t0\t0\t1\t";
  for (const std::string between : {"", "\t"}) {
    const auto motion =
        read_motion(file("q.tsv",
                         "NO_OF_FRAMES\t1\nNO_OF_BODIES\t2\nFREQUENCY\t100\nDATA_INCLUDED\t6D\n"
                         "BODY_NAMES\tprobe\tbone\nFrame\tTime\tprobe" +
                             columns + between + "bone" + columns + "\n1\t0.00000\t10" + values +
                             between + "20" + values + "\n"));
    ASSERT_TRUE(motion) << motion.error().what;
    ASSERT_TRUE(motion->bodies.contains("bone")) << "between: " << between.size();
    EXPECT_LT((motion->bodies.at("probe").X_CB[0].p - Vec3(0.01, 0, 0)).norm(), 1e-12);
    const math::Pose& bone = motion->bodies.at("bone").X_CB[0];
    EXPECT_LT((bone.p - Vec3(0.02, 0, 0)).norm(), 1e-12);
    EXPECT_LT((bone.q * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-9);
  }
}

TEST_F(Capture, TakesAMotiveExportsUnitAsItSaysAndNoneThatItDoesNotKnow) {
  const auto in = [&](const std::string& unit) {
    return read_motion(
        file("m.csv", "Format Version,1.23,Length Units," + unit +
                          ",Export Frame Rate,100\n\n,,Marker,Marker,Marker\n,,M1,M1,M1\n"
                          ",,Position,Position,Position\nFrame,Time (Seconds),X,Y,Z\n"
                          "0,0.0,10,20,30\n1,0.01,10,20,30\n"));
  };
  const auto cm = in("Centimeters");
  ASSERT_TRUE(cm) << cm.error().what;
  EXPECT_LT((cm->markers.at("M1").p_C_m[0] - Vec3(0.1, 0.2, 0.3)).norm(), 1e-12);
  const auto inches = in("Inches");
  ASSERT_FALSE(inches);
  EXPECT_NE(inches.error().what.find("Length Units 'Inches'"), std::string::npos);
}

/// A C3D file by hand: header, one parameter block with POINT:LABELS and POINT:UNITS, float frames.
std::string c3d(const std::vector<std::array<float, 4>>& points_of_frames, int points) {
  std::string out(1024, '\0');
  const auto put = [&](std::size_t at, auto value) { std::memcpy(&out[at], &value, sizeof value); };
  out[0] = 2, out[1] = 0x50;
  put(2, std::uint16_t(points));
  put(6, std::uint16_t(1));
  put(8, std::uint16_t(points_of_frames.size() / std::size_t(points)));
  put(12, -1.0f);
  put(16, std::uint16_t(3));
  put(20, 250.0f);
  std::string p("\x01\x50\x01\x54", 4);
  p += std::string("\x05\xff", 2) + "POINT" + std::string("\x03\x00\x00", 3);
  std::string labels = std::string("\x06\x01", 2) + "LABELS";
  const std::string data = "tip top side";
  labels += std::string("\x13\x00", 2) + std::string("\xff\x02\x04\x03", 4) + "tip top side";
  p += labels;
  p += std::string("\x05\x01", 2) + "UNITS" + std::string("\x08\x00\xff\x01\x02", 5) + "mm" + '\0';
  p += std::string(2, '\0');
  out.replace(512, p.size(), p);
  for (const auto& point : points_of_frames)
    out.append(reinterpret_cast<const char*>(point.data()), 16);
  return out;
}

TEST_F(Capture, ReadsMarkersOfAC3dFileAndFitsABodyToThem) {
  // A right angle of 30 and 40 mm in the body, moved by (5, 6, 7) mm and turned a quarter about z.
  const auto motion = read_motion(file("m.c3d", c3d({{5, 6, 7, 0},
                                                     {5, 36, 7, 0},
                                                     {-35, 6, 7, 0},
                                                     {0, 0, 0, -1},
                                                     {5, 36, 7, 0},
                                                     {-35, 6, 7, 0}},
                                                    3)));
  ASSERT_TRUE(motion) << motion.error().what;
  EXPECT_EQ(motion->rate_Hz, 250.0);
  EXPECT_EQ(motion->markers.at("tip").t_s.size(), 1u);
  EXPECT_EQ(motion->markers.at("side").t_s.size(), 2u);
  const BodyShape shape{{"tip", {0, 0, 0}}, {"top", {0.03, 0, 0}}, {"side", {0, 0.04, 0}}};
  const auto body = fit_body(*motion, shape);
  ASSERT_TRUE(body) << body.error().what;
  ASSERT_EQ(body->t_s.size(), 1u);  // two markers do not tell a pose
  EXPECT_LT((body->X_CB[0].p - Vec3(0.005, 0.006, 0.007)).norm(), 1e-9);
  EXPECT_LT((body->X_CB[0].q * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-6);
}

TEST_F(Capture, RefusesRubbishInOneLineThatNamesTheFile) {
  const auto refused = [&](const std::string& name, const std::string& text) {
    const auto motion = read_motion(file(name, text));
    EXPECT_FALSE(motion) << name;
    if (motion) return;
    EXPECT_NE(motion.error().what.find(name), std::string::npos) << motion.error().what;
    EXPECT_EQ(motion.error().what.find('\n'), std::string::npos);
  };
  refused("a.tsv", "");
  refused("b.tsv", "hello");
  refused("c.tsv", "NO_OF_FRAMES\t2\n");
  refused("d.tsv", "NO_OF_FRAMES\t2\nFrame\tTime\n1\t2\n");
  refused("e.csv", "Format Version,1.23,Rotation Type,XYZ\n");
  refused("f.c3d", std::string("\x02\x50", 2));
  refused("g.c3d", std::string("\xff\x50", 2) + std::string(600, '\0'));
  refused("h.csv", "t_s,x\n0,1\n");
  EXPECT_FALSE(read_motion(folder_ / "none"));
  // Any byte of a good file changed: read or refused, never a crash.
  const std::string good = c3d({{5, 6, 7, 0}, {5, 36, 7, 0}, {-35, 6, 7, 0}}, 3);
  std::mt19937 random(5);
  for (int n = 0; n < 200; ++n) {
    std::string bad = good;
    for (int k = 0; k < 4; ++k) bad[random() % bad.size()] = char(random());
    static_cast<void>(read_motion(file("z.c3d", bad)));
  }
}

/// Five taps with uneven gaps, then a soft motion: force half-sines, and a tip that goes down to
/// the surface and turns there.
struct Tapping {
  std::vector<double> t_force, force, t_motion;
  std::vector<Vec3> tip;

  /// @param noise_N  of the force; the motion's is 0.1 mm @param drift  of the force's clock
  explicit Tapping(double offset_s, double noise_N, double drift = 0.0,
                   const std::vector<double>& taps = {2.0, 2.45, 2.83, 3.4, 3.76}) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    const double end_s = taps.back() + 6.0;
    for (double t = 0.0; t < end_s; t += 0.001) {
      double f = 0.0;
      for (const double tap : taps)
        if (std::abs(t - tap) < 0.02) f += 6.0 * std::cos(M_PI * (t - tap) / 0.04);
      if (t > taps.back() + 2.0) f += 1.0 + std::sin(5.0 * t);
      t_force.push_back(t * (1.0 + drift) + offset_s);
      force.push_back(std::abs(f + noise_N * normal(random)));
    }
    for (double t = 0.0; t < end_s; t += 0.005) {
      double z = 0.03;
      for (const double tap : taps)
        if (std::abs(t - tap) < 0.17) z -= 0.015 * (1.0 + std::cos(M_PI * (t - tap) / 0.17));
      if (t > taps.back() + 2.0) z += 0.01 * std::sin(3.0 * t);
      tip.push_back(Vec3(0.001 * std::sin(t), 0, z) +
                    1e-4 * Vec3(normal(random), normal(random), normal(random)));
      t_motion.push_back(t);
    }
  }
  core::Result<ClockFit> clock(int count) const {
    return align({t_force, force, t_motion, tip}, count);
  }
};

TEST(Taps, TellTheDriftWhenTheyStandAtBothEnds) {
  const Tapping room(0.5, 0.02, 300e-6,
                     {2.0, 2.45, 2.83, 3.4, 3.76, 42.0, 42.4, 42.95, 43.31, 43.8});
  const auto clock = room.clock(5);
  ASSERT_TRUE(clock) << clock.error().what;
  ASSERT_EQ(clock->runs.size(), 2u);
  EXPECT_NEAR(clock->drift, 300e-6, 1e-5);  // half a millisecond over 40 s
  EXPECT_NEAR(clock->force_time(30.0), 30.0 * (1.0 + 300e-6) + 0.5, 5e-4);
  EXPECT_NEAR(clock->motion_time(clock->force_time(30.0)), 30.0, 1e-12);
}

TEST(Taps, StandOutOfNoiseAndOfBumpsBetweenThem) {
  Tapping room(0.5, 0.25);
  for (std::size_t k = 0; k < room.force.size(); ++k)
    for (const double bump : {2.2, 2.65, 3.1, 3.6})
      if (std::abs(room.t_force[k] - 0.5 - bump) < 0.03) room.force[k] += 1.0;
  const auto clock = room.clock(5);
  ASSERT_TRUE(clock) << clock.error().what;
  EXPECT_NEAR(clock->offset_s, 0.5, 0.001);
}

TEST(Taps, ThatCouldBeAlignedTwoWaysAreRefused) {
  // Six in an even rhythm where five are asked for: the first five or the last?
  const Tapping room(0.5, 0.02, 0.0, {2.0, 2.4, 2.8, 3.2, 3.6, 4.0});
  const auto clock = room.clock(5);
  ASSERT_FALSE(clock);
  EXPECT_NE(clock.error().what.find("two offsets"), std::string::npos) << clock.error().what;
  EXPECT_TRUE(room.clock(6));
}

TEST(Taps, TellTheClocksApartToAMillisecond) {
  for (const double offset_s : {0.0, 0.73, -1.2345, 12.0}) {
    const Tapping room(offset_s, 0.02);
    const auto clock = room.clock(5);
    ASSERT_TRUE(clock) << clock.error().what;
    EXPECT_NEAR(clock->offset_s, offset_s, 0.0005);
    EXPECT_LT(clock->sd_s, 0.001);
    EXPECT_EQ(clock->drift, 0.0);
    ASSERT_EQ(clock->runs.size(), 1u);
    ASSERT_EQ(clock->runs[0].taps_s.size(), 5u);
    EXPECT_NEAR(clock->runs[0].taps_s[0], 2.0, 0.005);
  }
}

TEST(Taps, AreNotFoundWhereThereAreNoneOrTheRhythmIsAnother) {
  const Tapping room(0.5, 0.02);
  const auto why = [&](const Tapped& tapped, int count) {
    const auto clock = align(tapped, count);
    return clock ? std::string() : clock.error().what;
  };
  EXPECT_NE(why({room.t_force, room.force, room.t_motion, room.tip}, 6).find("6 taps in the force"),
            std::string::npos);
  std::vector<double> slower = room.t_motion;
  for (double& t : slower) t *= 1.2;
  EXPECT_NE(why({room.t_force, room.force, slower, room.tip}, 5).find("rhythm"), std::string::npos);
  const std::vector<Vec3> at_rest(room.tip.size(), Vec3::Zero());
  EXPECT_NE(why({room.t_force, room.force, room.t_motion, at_rest}, 5).find("in the motion"),
            std::string::npos);
  const std::vector<double> still(room.force.size(), 0.01);
  EXPECT_TRUE(force_taps(room.t_force, still, 5).empty());
}

TEST_F(Capture, MovesTheWrenchFromTheSensorToTheHandleAndTakesItsZeroOff) {
  // The sensor 50 mm along z of H, turned a quarter about z: its x is H's y. Zero 0.5 N in its x.
  std::string force = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n";
  for (int k = 0; k < 2000; ++k)
    force += std::to_string(0.001 * k) + (k < 1000 ? ",0.5,0,0,0,0,0\n" : ",2.5,0,0,0,0,0\n");
  file("f.csv", force);
  std::string motion = "t_s,probe.px_m,probe.py_m,probe.pz_m,probe.qw,probe.qx,probe.qy,probe.qz\n";
  for (int k = 0; k < 200; ++k) motion += std::to_string(0.01 * k) + ",1,2,3,1,0,0,0\n";
  file("m.csv", motion);
  file("a.json", R"({"format":"tractus-assembly/1","rig":"palpation",
    "tool":{"body":"probe","X_BH":{"p_m":[0,0,0.1]}},
    "sensor":{"X_HS":{"p_m":[0,0,0.05],"q":[0.70710678118654752,0,0,0.70710678118654752]}},
    "trials":[{"id":"t","motion":"m.csv","force":"f.csv","offset_s":0,"from_s":1.1}]})");
  const auto recipe = Recipe::read(folder_ / "a.json");
  ASSERT_TRUE(recipe) << recipe.error().what;
  const auto out = assemble(*recipe, recipe->recordings[0]);
  ASSERT_TRUE(out) << out.error().what;
  EXPECT_NEAR(out->zero_S.force_N.x(), 0.5, 1e-9);
  EXPECT_NEAR(out->rate_Hz, 100.0, 1e-6);
  const math::Wrench& w = out->trial.wrench_H.back();
  EXPECT_LT((w.force_N - Vec3(0, 2, 0)).norm(), 1e-9);
  EXPECT_LT((w.torque_Nm - Vec3(-0.1, 0, 0)).norm(), 1e-9);  // 0.05 z × 2 y = −0.1 x
  EXPECT_LT((out->trial.X_VH[0].p - Vec3(1, 2, 3.1)).norm(), 1e-12);
  EXPECT_EQ(out->trial.t_s.front(), 0.0);
}

TEST_F(Capture, NamesTheFieldThatIsWrongInARecipe) {
  const auto why = [&](const std::string& text) {
    const auto recipe = Recipe::read(file("r.json", text));
    return recipe ? std::string() : recipe.error().what;
  };
  EXPECT_NE(why(R"({"format":"tractus-assembly/2"})").find("format"), std::string::npos);
  EXPECT_NE(
      why(R"({"format":"tractus-assembly/1","rig":"palpation","tool":{"body":"p","X_BH":{"q":[1,1,0,0]}},
      "trials":[]})")
          .find("r.json: /tool/X_BH/q: a quaternion"),
      std::string::npos);
  EXPECT_NE(why(R"({"format":"tractus-assembly/1","rig":"palpation","tool":{"body":"p"},
      "trials":[{"id":"a","motion":"m.tsv","force":"f.csv"},
                {"id":"a","motion":"n.tsv","force":"g.csv"}]})")
                .find("/trials/1/id: 'a' is there twice"),
            std::string::npos);
  EXPECT_NE(why(R"({"format":"tractus-assembly/1","rig":"palpation","tool":{"body":"p"},
      "trials":[{"id":"a","motion":"../m.tsv","force":"f.csv"}]})")
                .find("motion"),
            std::string::npos);
}

}  // namespace
}  // namespace capture
}  // namespace tractus
