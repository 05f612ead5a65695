/// Plots as SVG text: panels under one another, lines, bands, histograms; for reports and the
/// tool's pictures.
#pragma once

#include <string>
#include <vector>

namespace tractus::plot {

/// A curve. A value that is not finite makes a gap. Where `x` does not decrease, more points than
/// the picture can show are thinned to first, lowest, highest and last of each pixel column, so
/// that no peak is lost.
struct Line {
  std::string label;         ///< in the legend; none if empty
  std::vector<double> x, y;  ///< equal length
  std::string colour;        ///< "#1b4f8f"; the palette's next if empty
  double width_px = 1.2;
  bool right_axis = false;
  bool points = false;  ///< small crosses in place of a curve; nothing is thinned
};

/// An area between two curves, for example a confidence band.
struct Ribbon {
  std::string label;
  std::vector<double> x, low, high;  ///< equal length
  std::string colour;
};

/// A histogram or any staircase: `y[k]` holds from `edges[k]` to `edges[k + 1]`.
struct Steps {
  std::string label;
  std::vector<double> edges, y;  ///< one edge more than values
  std::string colour;
  bool filled = false;
};

/// A shaded stretch of the x axis.
struct Band {
  double from, to;
  std::string colour, label;
};

/// A horizontal line across the panel.
struct Mark {
  double at;
  std::string label;  ///< written on it at its left end
  std::string colour;
  std::string dash = "5 3";  ///< SVG's stroke-dasharray
  bool right_axis = false;
};

struct Panel {
  std::string title, x_label, y_label, right_label;
  std::vector<Line> lines;
  std::vector<Steps> steps;
  std::vector<Band> bands;
  std::vector<double> horizontal_marks;  ///< grey, on the left axis
  std::vector<Mark> marks;
  bool log_y = false;  ///< left axis by decades; values ≤ 0 lie below its foot
  double height_px = 220;
  std::vector<Ribbon> ribbons = {};           ///< behind the lines, on the left axis
  std::vector<std::string> group_names = {};  ///< of x = 1, 2, …; the SVG writes the numbers
};

struct Figure {
  std::string title;
  double width_px = 900;
  int columns = 1;
  std::vector<Panel> panels;
  std::string note;  ///< small print under the panels
};

/// A complete SVG document, readable on light ground. Holds no ids and no style sheet, so that
/// several may stand in one page.
std::string svg(const Figure& figure);

}  // namespace tractus::plot
