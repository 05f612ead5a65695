/// Plots as SVG text: panels under one another, lines, bands, histograms; for reports and the
/// tool's pictures.
#pragma once

#include <string>
#include <vector>

namespace plot {

struct Line {
  std::string label;
  std::vector<double> x,
      y;  ///< equal length; more points than the picture can show are thinned to their extremes
  std::string colour;  ///< "#1b4f8f"
  double width_px = 1.2;
  bool right_axis = false;
};

/// A histogram or any staircase: `y[k]` holds from `edges[k]` to `edges[k + 1]`.
struct Steps {
  std::string label;
  std::vector<double> edges, y;
  std::string colour;
  bool filled = false;
};

/// A shaded stretch of the x axis.
struct Band {
  double from, to;
  std::string colour, label;
};

struct Panel {
  std::string title, x_label, y_label, right_label;
  std::vector<Line> lines;
  std::vector<Steps> steps;
  std::vector<Band> bands;
  std::vector<double> horizontal_marks;
  double height_px = 220;
};

struct Figure {
  std::string title;
  double width_px = 900;
  int columns = 1;
  std::vector<Panel> panels;
};

/// A complete SVG document, readable on light ground.
std::string svg(const Figure& figure);

}  // namespace plot
