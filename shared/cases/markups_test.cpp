/// Markups of 3D Slicer: lines in, lines and curves out. The files are written here as Slicer's
/// markups schema 1.0.3 describes them.
#include "cases/markups.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <string>

#include "core/bytes.hpp"
#include "core/file.hpp"

namespace tractus {
namespace {
using math::Vec3;
namespace fs = std::filesystem;

/// As Slicer 5 writes a line: two points, colours and sizes of the display left out.
std::string slicer_line(const std::string& system, const std::string& units,
                        const std::string& points) {
  return R"({"@schema": "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/)"
         R"(Markups/Resources/Schema/markups-schema-v1.0.3.json#", "markups": [{"type": "Line", )"
         R"("coordinateSystem": ")" +
         system + R"(", "coordinateUnits": )" + units +
         R"(, "locked": false, "labelFormat": "%N-%d", "controlPoints": [)" + points +
         R"(], "measurements": [{"name": "length", "enabled": true, "value": 42.7, "units": "mm"}])"
         R"(, "display": {"visibility": true, "opacity": 1.0}}]})";
}
std::string point(const std::string& at, const std::string& status = "defined") {
  return R"({"id": "1", "label": "L-1", "description": "", "associatedNodeID": "", "position": )" +
         at + R"(, "orientation": [-1, 0, 0, 0, -1, 0, 0, 0, 1], "selected": true, )" +
         R"("positionStatus": ")" + status + "\"}";
}
const std::string kTwo = point("[46.0, 200.5, -61.0]") + ", " + point("[38.5, 158.0, -61.0]");

core::Result<cases::PlannedLine> read(const std::string& text) {
  const fs::path path = fs::temp_directory_path() /
                        ("tractus_markup_" + std::to_string(::getpid()) + "_" + core::new_id());
  EXPECT_TRUE(core::write_file(path, core::bytes_of(text)));
  auto line = cases::read_line_markup(path);
  fs::remove(path);
  return line;
}

void expect_refused(const std::string& text, const std::string& why) {
  const auto line = read(text);
  ASSERT_FALSE(line) << text;
  EXPECT_NE(line.error().what.find(why), std::string::npos) << line.error().what;
}

TEST(Markups, ALineOfSlicerIsReadInMetres) {
  const auto line = read(slicer_line("LPS", R"("mm")", kTwo));
  ASSERT_TRUE(line) << line.error().what;
  EXPECT_LT((line->entry_m - Vec3(0.046, 0.2005, -0.061)).norm(), 1e-12);
  EXPECT_LT((line->target_m - Vec3(0.0385, 0.158, -0.061)).norm(), 1e-12);
}

TEST(Markups, RightAnteriorSuperiorTurnsTwoAxes) {
  const auto line = read(slicer_line("RAS", R"(["mm", "UCUM", "millimeter"])", kTwo));
  ASSERT_TRUE(line) << line.error().what;
  EXPECT_LT((line->entry_m - Vec3(-0.046, -0.2005, -0.061)).norm(), 1e-12);
}

TEST(Markups, MicrometresAreScaled) {
  const auto line =
      read(slicer_line("LPS", R"("um")", point("[46000, 0, 0]") + "," + point("[38500, 0, 0]")));
  ASSERT_TRUE(line) << line.error().what;
  EXPECT_NEAR(line->entry_m.x(), 0.046, 1e-12);
}

TEST(Markups, PointsThatAreNotPlacedDoNotCount) {
  const auto line =
      read(slicer_line("LPS", R"("mm")", kTwo + "," + point("[0, 0, 0]", "undefined")));
  EXPECT_TRUE(line) << line.error().what;
}

TEST(Markups, WhatIsNoPlanIsRefusedInWords) {
  expect_refused("[]", "a markups file of 3D Slicer");
  expect_refused(R"({"markups": [{"type": "Fiducial"}]})", "holds no markup of type \"Line\"");
  expect_refused(R"({"markups": [{"type": "Line"}, {"type": "Line"}]})", "several lines");
  expect_refused(slicer_line("LPS", R"("mm")", point("[1, 2, 3]")), "has 1 placed points");
  expect_refused(slicer_line("LPS", R"("mm")", kTwo + "," + point("[1, 2, 3]")),
                 "has 3 placed points");
  expect_refused(slicer_line("XYZ", R"("mm")", kTwo), "\"LPS\" or \"RAS\"");
  expect_refused(slicer_line("LPS", R"("inch")", kTwo), "\"mm\" or \"um\"");
  expect_refused(slicer_line("LPS", R"("mm")", point("[1, 2]") + "," + point("[1, 2, 3]")),
                 "three numbers");
  expect_refused(slicer_line("LPS", R"("mm")", point("[1, 2, \"x\"]") + "," + point("[1, 2, 3]")),
                 "position/2");
  expect_refused(slicer_line("LPS", R"("mm")", point("[1, 2, 1e9]") + "," + point("[1, 2, 3]")),
                 "position/2");
  expect_refused(slicer_line("LPS", R"("mm")", point("[1, 2, 3]") + "," + point("[1, 2, 3.5]")),
                 "less than 1 mm apart");
  expect_refused(slicer_line("LPS", R"("mm")", "7, 8"), "has 0 placed points");
}

TEST(Markups, ALineThatIsWrittenIsReadAgain) {
  const cases::PlannedLine line{Vec3(0.0463, 0.2, -0.061), Vec3(0.0385, 0.158, -0.0612)};
  const auto back = read(cases::line_markup(line, "plan").dump());
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_LT((back->entry_m - line.entry_m).norm(), 1e-12);
  EXPECT_LT((back->target_m - line.target_m).norm(), 1e-12);
}

TEST(Markups, ACurveHoldsItsPointsInMillimetres) {
  const Vec3 points_m[] = {Vec3(0.001, 0.002, 0.003), Vec3(-0.004, 0, 0)};
  const auto markup = cases::curve_markup(points_m, "tip path")["markups"][0];
  EXPECT_EQ(markup["type"], "Curve");
  EXPECT_EQ(markup["coordinateSystem"], "LPS");
  EXPECT_EQ(markup["controlPoints"].size(), 2u);
  EXPECT_DOUBLE_EQ(markup["controlPoints"][1]["position"][0].get<double>(), -4.0);
}

}  // namespace
}  // namespace tractus
