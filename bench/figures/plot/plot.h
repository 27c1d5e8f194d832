#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace kerf::bench {

/// Colours that colour-blind readers tell apart [OkabeIto2008], in the order in which charts use them.
enum class Colour { black, blue, vermillion, green, purple, orange, sky, yellow, grey };

enum class Mark { line, points, circles, crosses, steps, boxes };

/// A value that breaks the line of a curve.
inline constexpr double line_break = std::numeric_limits<double>::quiet_NaN();

/// One set of data in a chart. NaN breaks a line.
struct Curve {
  std::string label;  ///< empty: not in the legend
  std::vector<double> x;
  std::vector<double> y;
  Colour colour = Colour::black;
  Mark mark = Mark::line;
  double width = 1.5;
  bool dashed = false;
  std::vector<std::size_t> of;  ///< the number of what each point stands for, for a page; empty: of nothing
};

/// A stretch of the x axis laid behind the curves.
struct Band {
  double begin = 0.0;
  double end = 0.0;
  Colour colour = Colour::sky;
};

/// What cells of a map can be.
struct CellKind {
  Colour colour = Colour::sky;
  std::string label;
  bool dotted = false;  ///< on a page; gnuplot draws and names colours alone
};

/// A map laid behind the curves. Its cells follow each other along y where `upwards`, else along x.
struct Cells {
  std::vector<double> x_edges;  ///< where columns begin and end: one more than there are
  std::vector<double> y_edges;
  bool upwards = false;
  std::vector<CellKind> kinds;    ///< in the legend, cells or not
  std::vector<std::size_t> kind;  ///< of each cell; empty: none is drawn
};

/// A line across the chart with a text at it.
struct Marker {
  double at = 0.0;
  std::string label;
  bool label_after = false;  ///< right of a vertical line instead of left
};

/// A name in place of a number at an axis.
struct NamedTick {
  double at = 0.0;
  std::string name;
};

/// A text beside a point, above and right of it, or below and left; or at a place of its own, with a thin
/// line from the point.
struct PointLabel {
  double x = 0.0;
  double y = 0.0;
  std::string text;
  bool left = false;
  double text_x = std::numeric_limits<double>::quiet_NaN();  ///< where it begins, or ends if it is left; NaN:
  double text_y = std::numeric_limits<double>::quiet_NaN();  ///< beside the point
};

/// A range of an axis; empty while begin is not less than end.
struct Range {
  double begin = 0.0;
  double end = 0.0;
};

struct Chart {
  std::string title;
  std::string x_label;  ///< with its unit: "time [s]"
  std::string y_label;
  std::vector<Curve> curves;
  std::vector<Band> bands;
  Cells cells;
  std::vector<Marker> vertical;
  std::vector<Marker> horizontal;
  std::vector<PointLabel> labels;
  std::vector<NamedTick> x_ticks;  ///< in place of numbers
  std::vector<NamedTick> y_ticks;  ///< likewise
  Range x_range;                   ///< empty: what the curves need
  Range y_range;
  bool log_x = false;
  bool log_y = false;
  bool legend_below = false;  ///< instead of at the right
  int left_margin = 0;        ///< in letters, so that charts below one another align; 0: what labels need
  int right_margin = 0;
  int width_px = 900;
  int height_px = 340;
};

/// A chart and the name of its file, without ".svg".
struct Figure {
  std::string name;
  Chart chart;
};

/// Draws a chart with gnuplot and returns it as one `<svg>` element, without the XML prolog.
/// @throws std::runtime_error that names the package if gnuplot is missing, or what it printed if it fails.
[[nodiscard]] std::string draw(const Chart& chart);
/// Several, by one run of gnuplot, whose start takes longer than most charts.
[[nodiscard]] std::vector<std::string> draw_all(std::span<const Chart> charts);

/// Rows to keep of many, in their order, so that at most `most` are left and no spike is lost: of every
/// stretch the first, the last, and the smallest and largest of each column. All of them if they are so few.
[[nodiscard]] std::vector<std::size_t> decimated_rows(std::initializer_list<std::span<const double>> columns,
                                                      std::size_t most);
/// The same of columns that are too long to be kept: each gives its value of a row, once, in their order.
using ValueOfRow = std::function<double(std::size_t row)>;
[[nodiscard]] std::vector<std::size_t> decimated_rows(std::size_t rows, std::span<const ValueOfRow> columns,
                                                      std::size_t most);
/// The same of a long curve, by its y.
[[nodiscard]] Curve decimated(const Curve& curve, std::size_t most = 4000);

/// Every so many points of a cloud, so that `most` or up to twice as many are left.
[[nodiscard]] Curve thinned(Curve cloud, std::size_t most);

}  // namespace kerf::bench
