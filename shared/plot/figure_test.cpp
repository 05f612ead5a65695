#include "plot/figure.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <regex>

#include "plot/axis.hpp"
#include "plot/text.hpp"
#include "plot/trace.hpp"

namespace tractus {
namespace plot {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> labels(const Axis& axis) {
  std::vector<std::string> out;
  for (const Tick& tick : axis.ticks()) out.push_back(tick.label);
  return out;
}

/// Every element that opens is closed, in order: what an XML parser asks for before all else.
bool is_balanced(const std::string& text) {
  std::vector<std::string> open;
  const std::regex tag("<(/?)([a-z]+)[^>]*?(/?)>");
  for (std::sregex_iterator it(text.begin(), text.end(), tag), end; it != end; ++it) {
    if ((*it)[3] == "/") continue;
    if ((*it)[1] != "/") {
      open.push_back((*it)[2]);
    } else if (open.empty() || open.back() != (*it)[2]) {
      return false;
    } else {
      open.pop_back();
    }
  }
  return open.empty();
}

TEST(Axis, StepsByOneTwoOrFive) {
  EXPECT_THAT(labels(Axis::linear({0.0, 1.0}, 5, false)),
              ElementsAre("0.0", "0.2", "0.4", "0.6", "0.8", "1.0"));
  EXPECT_THAT(labels(Axis::linear({-7.8, 0.3}, 4, false)), ElementsAre("−10", "−5", "0", "5"));
  EXPECT_THAT(labels(Axis::linear({0.0, 0.134}, 3, false)),
              ElementsAre("0.00", "0.05", "0.10", "0.15"));
}

TEST(Axis, HoldsAllDataAndPutsEndsAtEnds) {
  const Axis axis = Axis::linear({0.37, 9.1}, 8, true);
  EXPECT_DOUBLE_EQ(axis.share(0.37), 0.0);
  EXPECT_DOUBLE_EQ(axis.share(9.1), 1.0);
  const Axis round = Axis::linear({0.37, 9.1}, 8, false);
  EXPECT_GE(round.share(0.37), 0.0);
  EXPECT_LE(round.share(9.1), 1.0);
}

TEST(Axis, StaysUsableForNoDataOneValueAndHugeValues) {
  EXPECT_GE(Axis::linear({}, 5, false).ticks().size(), 2u);
  EXPECT_GE(Axis::linear({3.0, 3.0}, 5, false).ticks().size(), 2u);
  EXPECT_LE(Axis::linear({1e300, 1e300}, 5, false).ticks().size(), 20u);
  EXPECT_LE(Axis::linear({-1e300, 1e300}, 5, false).ticks().size(), 20u);
}

TEST(Axis, CountsDecadesAndPutsZeroAtTheFoot) {
  const Axis axis = Axis::decades({0.004, 30.0});
  EXPECT_THAT(labels(axis), ElementsAre("10⁻³", "10⁻²", "10⁻¹", "1", "10¹", "10²"));
  EXPECT_DOUBLE_EQ(axis.share(0.0), 0.0);
  EXPECT_DOUBLE_EQ(axis.share(100.0), 1.0);
  EXPECT_NEAR(axis.share(0.1), 0.4, 1e-12);
}

TEST(Curve, ThinsWithoutLosingASinglePeak) {
  std::vector<double> x, y;
  for (int k = 0; k < 100'000; ++k)
    x.push_back(k), y.push_back(k == 54'321 ? 1.0 : k == 65'432 ? -1.0 : 0.0);
  const Axis across = Axis::linear({0, 99'999}, 8, true), up = Axis::linear({-1, 1}, 4, false);
  const std::string path = curve(x, y, across, up, {500, 100});
  EXPECT_THAT(path, HasSubstr(" 0L"));    // the peak reaches the top
  EXPECT_THAT(path, HasSubstr(" 100L"));  // and the trough the bottom
  EXPECT_LE(std::ranges::count(path, 'L'), 4 * 501);
}

TEST(Curve, LiftsThePenWhereAValueIsMissing) {
  const double gap = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> x{0, 1, 2, 3, 4}, y{0, 1, gap, 1, 0};
  const Axis across = Axis::linear({0, 4}, 4, true), up = Axis::linear({0, 1}, 2, false);
  EXPECT_EQ(curve(x, y, across, up, {400, 100}), "M0 100L100 0M300 0L400 100");
}

TEST(Staircase, ClosesToTheFootWhenFilled) {
  const std::vector<double> edges{0, 1, 2}, y{1, 0.5};
  const Axis across = Axis::linear({0, 2}, 2, true), up = Axis::linear({0, 1}, 2, false);
  EXPECT_EQ(staircase(edges, y, across, up, {200, 100}, true),
            "M0 100L0 0L100 0L100 50L200 50L200 100Z");
}

TEST(Crosses, StandAtEachPointThatIsANumber) {
  const std::vector<double> x{1, 2}, y{0.5, std::numeric_limits<double>::quiet_NaN()};
  const Axis across = Axis::linear({0, 4}, 4, true), up = Axis::linear({0, 1}, 2, false);
  EXPECT_EQ(crosses(x, y, across, up, {400, 100}), "M97 50L103 50M100 47L100 53");
}

TEST(Svg, FillsARibbonThereAndBack) {
  Panel panel;
  panel.ribbons.push_back({"band", {0, 1}, {0, 0}, {1, 1}, "#ff0000"});
  const std::string text = svg({"", 900, 1, {panel}, ""});
  EXPECT_TRUE(is_balanced(text)) << text;
  EXPECT_THAT(text,
              testing::ContainsRegex("<path d=\"M0 0L[0-9.]+ 0L[0-9.]+ [0-9.]+L0 [0-9.]+Z\""));
  EXPECT_THAT(text, Not(HasSubstr("no data")));
}

TEST(Words, AreEscapedAndIndicesSetLower) {
  EXPECT_THAT(written({0, 0, 10}, "a<b & \"c\"\n"),
              HasSubstr(">a&lt;b &amp; &quot;c&quot; </text>"));
  EXPECT_THAT(written({0, 0, 10}, "F_xy, N"),
              HasSubstr("F<tspan dy=\"2.5\" font-size=\"78%\">xy</tspan>"));
  EXPECT_THAT(written({0, 0, 10}, "trial_one S_1 AB_c"), HasSubstr(">trial_one S_1 AB_c<"));
}

TEST(Svg, IsBalancedAndFreeOfNonNumbersWhateverIsShown) {
  Figure figure;
  figure.title = "</svg><script>";
  figure.note = "simulated";
  Panel panel;
  panel.title = "F_z & more";
  panel.x_label = "time, s";
  panel.right_label = "depth, mm";
  panel.lines.push_back({"a", {0, 1, 2}, {NAN, INFINITY, 1}, "", 1.2, false});
  panel.lines.push_back({"b", {0, 1}, {1e300, -1e300}, "", 1.2, true});
  panel.bands.push_back({0.5, 0.6, "#ff0000", "sides"});
  panel.marks.push_back({0.3, "here", "", "5 3", true});
  panel.steps.push_back({"s", {0, 1, 2}, {0, 3}, "", true});
  figure.panels = {panel, Panel{}};
  figure.panels[1].log_y = true;
  const std::string text = svg(figure);
  EXPECT_TRUE(is_balanced(text)) << text;
  EXPECT_THAT(text, Not(HasSubstr("nan")));
  EXPECT_THAT(text, Not(HasSubstr("inf")));
  EXPECT_THAT(text, Not(HasSubstr("<script>")));
  EXPECT_THAT(text, HasSubstr("no data"));
}

}  // namespace
}  // namespace plot
}  // namespace tractus
