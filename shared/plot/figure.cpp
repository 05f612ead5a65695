#include "plot/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/require.hpp"
#include "plot/axis.hpp"
#include "plot/text.hpp"
#include "plot/trace.hpp"

namespace tractus {
namespace plot {
namespace {

constexpr const char* kFont =
    "'Helvetica Neue', Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif";
constexpr const char* kInk = "#22272e";  // titles
constexpr const char* kGrid = "#e6e9ed";
constexpr const char* kFrame = "#b9c0c8";
constexpr std::array kPalette{"#1b4f8f", "#d9731a", "#5a9e3f", "#8b4fa8", "#b8322f", "#3aa0a8"};
constexpr double kTickSize = 11.0, kLabelSize = 12.0, kTitleSize = 13.0, kFigureTitleSize = 16.0;
constexpr double kOuter = 14.0, kLegendRow = 17.0;

std::string ruled(double x1, double y1, double x2, double y2, const std::string& style) {
  return fmt::format(R"(<line x1="{}" y1="{}" x2="{}" y2="{}" {}/>)", px(x1), px(y1), px(x2),
                     px(y2), style) +
         "\n";
}

struct LegendEntry {
  std::string label, colour;
  bool filled;
  double width() const { return 26.0 + text_width(label, kTickSize) + 12.0; }
};

/// A panel with its axes chosen, before its place on the page is known.
struct Prepared {
  const Panel* panel;
  Axis across, left, right;
  bool has_right = false;
  std::vector<std::string> line_colours, step_colours;
  std::vector<LegendEntry> legend;
  int legend_rows = 0;
  bool legend_beside_title = false;
  double left_px = 0.0, right_px = 0.0;  // room for ticks and labels

  double head_px() const {
    const double title = panel->title.empty() ? 4.0 : 20.0;
    return title + (legend_beside_title ? 0.0 : kLegendRow * legend_rows) + 4.0;
  }
  double foot_px() const { return 18.0 + (panel->x_label.empty() ? 0.0 : 18.0); }
};

double widest(const Axis& axis) {
  double out = 0.0;
  for (const Tick& tick : axis.ticks()) out = std::max(out, text_width(tick.label, kTickSize));
  return out;
}

void choose_axes(const Panel& panel, double width_px, Prepared& out) {
  Range across, left, right;
  for (const Line& line : panel.lines) {
    core::require(line.x.size() == line.y.size(), "a line has as many x as y");
    out.has_right |= line.right_axis;
    for (const double x : line.x) across.take(x);
    for (const double y : line.y)
      if (line.right_axis)
        right.take(y);
      else if (!panel.log_y || y > 0.0)
        left.take(y);
  }
  for (const Ribbon& ribbon : panel.ribbons) {
    core::require(ribbon.x.size() == ribbon.low.size() && ribbon.x.size() == ribbon.high.size(),
                  "a ribbon has as many x as ends");
    for (const double x : ribbon.x) across.take(x);
    for (const auto* ends : {&ribbon.low, &ribbon.high})
      for (const double y : *ends) left.take(y);
  }
  for (const Steps& steps : panel.steps) {
    core::require(steps.y.empty() || steps.edges.size() == steps.y.size() + 1,
                  "a staircase has one edge more than values");
    for (const double x : steps.edges) across.take(x);
    for (const double y : steps.y)
      if (!panel.log_y || y > 0.0) left.take(y);
    if (!panel.log_y && !steps.y.empty()) left.take(0.0);
  }
  for (const double mark : panel.horizontal_marks) left.take(mark);
  for (const Mark& mark : panel.marks)
    (mark.right_axis && out.has_right ? right : left).take(mark.at);
  const int wanted = std::max(2, int(panel.height_px / 42.0));
  out.across = Axis::linear(across, std::max(3, int(width_px / 110.0)), true);
  out.left = panel.log_y ? Axis::decades(left) : Axis::linear(left, wanted, false);
  out.right = Axis::linear(right, wanted, false);
  out.left_px = widest(out.left) + 10.0 + (panel.y_label.empty() ? 0.0 : 18.0);
  out.right_px =
      out.has_right ? widest(out.right) + 10.0 + (panel.right_label.empty() ? 0.0 : 18.0) : 8.0;
}

void choose_colours(const Panel& panel, Prepared& out) {
  std::size_t next = 0;
  const auto chosen = [&](const std::string& colour) {
    return colour.empty() ? std::string(kPalette[next++ % kPalette.size()]) : colour;
  };
  for (const Steps& steps : panel.steps) {
    out.step_colours.push_back(chosen(steps.colour));
    if (!steps.label.empty())
      out.legend.push_back({steps.label, out.step_colours.back(), steps.filled});
  }
  for (const Line& line : panel.lines) {
    out.line_colours.push_back(chosen(line.colour));
    if (!line.label.empty()) out.legend.push_back({line.label, out.line_colours.back(), false});
  }
}

/// Rows that the legend needs in `width_px`, and whether one fits beside the title.
void fit_legend(double width_px, Prepared& out) {
  double total = 0.0, row = 0.0;
  out.legend_rows = out.legend.empty() ? 0 : 1;
  for (const LegendEntry& entry : out.legend) {
    total += entry.width();
    if (row > 0.0 && row + entry.width() > width_px) ++out.legend_rows, row = 0.0;
    row += entry.width();
  }
  const double title =
      out.panel->title.empty() ? 0.0 : text_width(out.panel->title, kTitleSize) + 24.0;
  out.legend_beside_title = !out.panel->title.empty() && total + title <= width_px;
}

std::string legend_text(const Prepared& prepared, double width_px) {
  double total = 0.0;
  for (const LegendEntry& entry : prepared.legend) total += entry.width();
  double x = prepared.legend_beside_title ? width_px - total + 12.0 : 0.0;
  double y = prepared.legend_beside_title || prepared.panel->title.empty() ? 13.0 : 13.0 + 19.0;
  std::string out;
  for (const LegendEntry& entry : prepared.legend) {
    if (!prepared.legend_beside_title && x > 0.0 && x + entry.width() > width_px)
      x = 0.0, y += kLegendRow;
    if (entry.filled)
      out += fmt::format(
                 R"(<rect x="{}" y="{}" width="18" height="9" fill="{}" fill-opacity="0.45"/>)",
                 px(x), px(y - 8.5), entry.colour) +
             "\n";
    else
      out += ruled(x, y - 4.0, x + 18.0, y - 4.0,
                   fmt::format(R"(stroke="{}" stroke-width="2.2")", entry.colour));
    out += written({x + 23.0, y, kTickSize}, entry.label);
    x += entry.width();
  }
  return out;
}

std::string ticks_text(const Prepared& prepared, const Frame& frame) {
  std::string out;
  const auto style = fmt::format(R"(stroke="{}" stroke-width="1")", kGrid);
  for (const Tick& tick : prepared.left.ticks()) {
    const double y = frame.y(prepared.left, tick.at);
    out += ruled(0, y, frame.width_px, y, style);
    out += written({-6.0, y + 3.8, kTickSize, "end"}, tick.label);
  }
  double free_from = -1e9;  // labels of x never touch
  for (const Tick& tick : prepared.across.ticks()) {
    const double x = frame.x(prepared.across, tick.at),
                 half = 0.5 * text_width(tick.label, kTickSize);
    out += ruled(x, 0, x, frame.height_px, style);
    if (x - half < free_from) continue;
    out += written({x, frame.height_px + 15.0, kTickSize, "middle"}, tick.label);
    free_from = x + half + 6.0;
  }
  if (prepared.has_right)
    for (const Tick& tick : prepared.right.ticks())
      out += written({frame.width_px + 6.0, frame.y(prepared.right, tick.at) + 3.8, kTickSize},
                     tick.label);
  return out;
}

std::string bands_text(const Prepared& prepared, const Frame& frame) {
  std::string out;
  for (const Band& band : prepared.panel->bands) {
    const double from = std::max(0.0, frame.x(prepared.across, band.from));
    const double to = std::min(frame.width_px, frame.x(prepared.across, band.to));
    if (!(to > from)) continue;
    out +=
        fmt::format(R"(<rect x="{}" y="0" width="{}" height="{}" fill="{}" fill-opacity="0.13"/>)",
                    px(from), px(to - from), px(frame.height_px), band.colour) +
        "\n";
    if (text_width(band.label, kTickSize) + 8.0 <= to - from)
      out += written({0.5 * (from + to), 13.0, kTickSize, "middle"}, band.label);
  }
  return out;
}

std::string marks_text(const Prepared& prepared, const Frame& frame) {
  std::string out;
  for (const double at : prepared.panel->horizontal_marks) {
    const double y = frame.y(prepared.left, at);
    out +=
        ruled(0, y, frame.width_px, y, fmt::format(R"(stroke="{}" stroke-dasharray="5 3")", kGrey));
  }
  for (const Mark& mark : prepared.panel->marks) {
    const double y =
        frame.y(mark.right_axis && prepared.has_right ? prepared.right : prepared.left, mark.at);
    const std::string colour = mark.colour.empty() ? kGrey : mark.colour;
    out += ruled(0, y, frame.width_px, y,
                 fmt::format(R"(stroke="{}" stroke-dasharray="{}")", colour, mark.dash));
    // A white halo keeps the words readable over curves.
    out += written({6.0, y > 16.0 ? y - 4.0 : y + 12.0, kTickSize - 1.0, "start", colour, false,
                    R"( stroke="#ffffff" stroke-width="3" paint-order="stroke")"},
                   mark.label);
  }
  return out;
}

/// There along the high end, back along the low one.
std::string ribbons_text(const Prepared& prepared, const Frame& frame) {
  std::string out;
  for (const Ribbon& ribbon : prepared.panel->ribbons) {
    std::vector<double> x(ribbon.x), y(ribbon.high);
    x.insert(x.end(), ribbon.x.rbegin(), ribbon.x.rend());
    y.insert(y.end(), ribbon.low.rbegin(), ribbon.low.rend());
    const auto path = curve(x, y, prepared.across, prepared.left, frame);
    out +=
        fmt::format(R"(<path d="{}Z" fill="{}" fill-opacity="0.15"/>)", path, ribbon.colour) + "\n";
  }
  return out;
}

std::string data_text(const Prepared& prepared, const Frame& frame) {
  const Panel& panel = *prepared.panel;
  std::string out = ribbons_text(prepared, frame);
  for (std::size_t k = 0; k < panel.steps.size(); ++k) {
    const Steps& steps = panel.steps[k];
    const auto path =
        staircase(steps.edges, steps.y, prepared.across, prepared.left, frame, steps.filled);
    const auto style =
        steps.filled ? fmt::format(R"(fill="{}" fill-opacity="0.45")", prepared.step_colours[k])
                     : fmt::format(R"(fill="none" stroke="{}" stroke-width="1.6")",
                                   prepared.step_colours[k]);
    if (!path.empty()) out += fmt::format(R"(<path d="{}" {}/>)", path, style) + "\n";
  }
  for (std::size_t k = 0; k < panel.lines.size(); ++k) {
    const Line& line = panel.lines[k];
    const auto path = (line.points ? crosses : curve)(
        line.x, line.y, prepared.across, line.right_axis ? prepared.right : prepared.left, frame);
    if (!path.empty())
      out +=
          fmt::format(
              R"(<path d="{}" fill="none" stroke="{}" stroke-width="{}" stroke-linejoin="round"/>)",
              path, prepared.line_colours[k], line.width_px) +
          "\n";
  }
  if (out.empty())
    out = written({0.5 * frame.width_px, 0.5 * frame.height_px, kLabelSize, "middle"}, "no data");
  return out;
}

std::string turned(double x, double y, double degrees, const std::string& colour,
                   std::string_view text) {
  return text.empty()
             ? ""
             : written({x, y, kLabelSize, "middle", colour, false,
                        fmt::format(R"x( transform="rotate({} {} {})")x", degrees, px(x), px(y))},
                       text);
}

std::string right_colour(const Prepared& prepared) {
  for (std::size_t k = 0; k < prepared.panel->lines.size(); ++k)
    if (prepared.panel->lines[k].right_axis) return prepared.line_colours[k];
  return kGrey;
}

std::string moved_to(double x, double y) {
  return fmt::format(R"x(<g transform="translate({} {})">)x", px(x), px(y)) + "\n";
}

/// The panel with its plot's upper left corner at (x, y) of the page.
std::string panel_text(const Prepared& prepared, double x, double y, const Frame& frame) {
  const Panel& panel = *prepared.panel;
  std::string out = moved_to(x, y - prepared.head_px());
  if (!panel.title.empty()) out += written({0, 13.0, kTitleSize, "start", kInk, true}, panel.title);
  out += legend_text(prepared, frame.width_px) + "</g>\n" + moved_to(x, y) +
         ticks_text(prepared, frame);
  // A nested viewport clips without needing an id.
  out += fmt::format(R"(<svg width="{}" height="{}" overflow="hidden">)", px(frame.width_px),
                     px(frame.height_px)) +
         "\n";
  out += bands_text(prepared, frame) + data_text(prepared, frame) + marks_text(prepared, frame) +
         "</svg>\n";
  out += fmt::format(R"(<rect width="{}" height="{}" fill="none" stroke="{}"/>)",
                     px(frame.width_px), px(frame.height_px), kFrame) +
         "\n";
  out += turned(-prepared.left_px + 12.0, 0.5 * frame.height_px, -90, kGrey, panel.y_label);
  if (prepared.has_right)
    out += turned(frame.width_px + prepared.right_px - 6.0, 0.5 * frame.height_px, -90,
                  right_colour(prepared), panel.right_label);
  if (!panel.x_label.empty())
    out += written({0.5 * frame.width_px, frame.height_px + 32.0, kLabelSize, "middle"},
                   panel.x_label);
  return out + "</g>\n";
}

/// Rows of panels laid out on the page; the plots of a column share their left and right edges.
class Page {
 public:
  explicit Page(const Figure& figure)
      : figure_(figure),
        columns_(std::size_t(std::max(1, figure.columns))),
        all_(figure.panels.size()) {
    for (std::size_t k = 0; k < all_.size(); ++k) {
      all_[k].panel = &figure.panels[k];
      choose_axes(figure.panels[k], figure.width_px / double(columns_), all_[k]);
      choose_colours(figure.panels[k], all_[k]);
      left_ = std::max(left_, all_[k].left_px);
      right_ = std::max(right_, all_[k].right_px);
    }
    column_px_ = (figure.width_px - 2.0 * kOuter) / double(columns_);
    plot_px_ = std::max(40.0, column_px_ - left_ - right_);
  }

  std::string text() {
    std::string body;
    if (!figure_.title.empty()) {
      body += written({kOuter + left_, y_ + 14.0, kFigureTitleSize, "start", kInk, true},
                      figure_.title);
      y_ += 28.0;
    }
    for (std::size_t row = 0; row < all_.size(); row += columns_) body += row_text(row);
    if (!figure_.note.empty()) {
      body += written({kOuter + left_, y_ + 8.0, kTickSize}, figure_.note);
      y_ += 16.0;
    }
    return body;
  }
  double height_px() const { return y_ + kOuter; }

 private:
  std::string row_text(std::size_t row) {
    const std::size_t end = std::min(all_.size(), row + columns_);
    double head = 0.0, below = 0.0;
    for (std::size_t k = row; k < end; ++k) {
      all_[k].left_px = left_;
      all_[k].right_px = right_;
      fit_legend(plot_px_, all_[k]);
      head = std::max(head, all_[k].head_px());
      below = std::max(below, all_[k].panel->height_px + all_[k].foot_px());
    }
    std::string out;
    for (std::size_t k = row; k < end; ++k)
      out += panel_text(all_[k], kOuter + double(k - row) * column_px_ + left_, y_ + head,
                        {plot_px_, all_[k].panel->height_px});
    y_ += head + below + 10.0;
    return out;
  }

  const Figure& figure_;
  std::size_t columns_;
  std::vector<Prepared> all_;
  double left_ = 0.0, right_ = 0.0, column_px_ = 0.0, plot_px_ = 0.0, y_ = kOuter;
};

}  // namespace

std::string svg(const Figure& figure) {
  Page page(figure);
  const std::string body = page.text();
  return fmt::format(
             R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{1}" viewBox="0 0 {0} {1}" role="img" )"
             R"(aria-label="{2}" font-family="{3}">)",
             px(figure.width_px), px(page.height_px()), escaped(figure.title), kFont) +
         "\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n" + body + "</svg>\n";
}

}  // namespace plot
}  // namespace tractus
