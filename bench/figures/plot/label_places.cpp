#include "plot/label_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>
#include <vector>

namespace kerf::bench {
namespace {

// Pixels of a small plot.
constexpr double plot_width = 600.0;
constexpr double plot_height = 400.0;
constexpr double character_width = 8.0;
constexpr double text_height = 18.0;
constexpr double mark_reach = 6.0;
constexpr double line_step = 5.0;
constexpr std::array distances{14.0, 24.0, 36.0, 50.0, 68.0, 90.0, 120.0, 160.0};
constexpr int directions = 24;
// What a place costs, in pixels of distance that one would go to avoid it.
constexpr double label_covered = 1000.0;
constexpr double mark_covered = 60.0;
constexpr double line_covered = 12.0;  // each line_step of it
constexpr double crossed = 15.0;       // by the leader, each line_step

struct PixelSpot {
  double x = 0.0;
  double y = 0.0;
};

struct Box {
  double left = 0.0, right = 0.0, bottom = 0.0, top = 0.0;
  [[nodiscard]] bool holds(const PixelSpot& spot, double reach) const {
    return spot.x > left - reach && spot.x < right + reach && spot.y > bottom - reach && spot.y < top + reach;
  }
  [[nodiscard]] bool meets(const Box& other) const {
    return left < other.right && other.left < right && bottom < other.top && other.bottom < top;
  }
};

/// Letters, not bytes.
double width_of(std::string_view text) {
  return character_width *
         static_cast<double>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

/// An axis in pixels.
struct PixelAxis {
  Range range;
  bool logarithmic = false;
  double pixels = 1.0;

  [[nodiscard]] double scaled(double value) const { return logarithmic ? std::log(value) : value; }
  [[nodiscard]] double to_pixels(double value) const {
    return pixels * (scaled(value) - scaled(range.begin)) / (scaled(range.end) - scaled(range.begin));
  }
  [[nodiscard]] double from_pixels(double at) const {
    const double value = scaled(range.begin) + at / pixels * (scaled(range.end) - scaled(range.begin));
    return logarithmic ? std::exp(value) : value;
  }
};

/// What stands in the chart, and what was placed since.
class Crowd {
 public:
  explicit Crowd(const Chart& chart)
      : x_{.range = chart.x_range, .logarithmic = chart.log_x, .pixels = plot_width},
        y_{.range = chart.y_range, .logarithmic = chart.log_y, .pixels = plot_height} {
    for (const Curve& curve : chart.curves) add(curve);
    for (const Marker& marker : chart.vertical) {
      const double at = x_.to_pixels(marker.at);
      add_line({at, 0.0}, {at, plot_height});
      const double left = marker.label_after ? at : at - width_of(marker.label);
      add_text({left, left + width_of(marker.label), plot_height - 2.0 * text_height, plot_height});
    }
    for (const Marker& marker : chart.horizontal) {
      const double at = y_.to_pixels(marker.at);
      add_line({0.0, at}, {plot_width, at});
      add_text({plot_width - width_of(marker.label), plot_width, at, at + text_height});
    }
  }

  void place(PointLabel& label) {
    const std::optional<PixelSpot> point = spot(label.x, label.y);
    if (!point) return;
    const double width = width_of(label.text);
    double least = std::numeric_limits<double>::infinity();
    PixelSpot best;
    for (const double distance : distances) {
      for (int k = 0; k < directions; ++k) {
        const double angle = 2.0 * std::numbers::pi * (k + 0.5) / directions;
        const PixelSpot text{point->x + distance * std::cos(angle), point->y + distance * std::sin(angle)};
        const bool before = text.x < point->x;
        const double cost = distance + cost_of(box_at(text, width, before), *point, text);
        if (cost >= least) continue;
        least = cost;
        best = text;
      }
    }
    if (!std::isfinite(least)) return;
    label.left = best.x < point->x;
    label.text_x = x_.from_pixels(best.x);
    label.text_y = y_.from_pixels(best.y);
    add_text(box_at(best, width, label.left));
    add_line(*point, best);
  }

 private:
  static Box box_at(const PixelSpot& text, double width, bool before) {
    const double left = before ? text.x - width : text.x;
    return {left, left + width, text.y - 0.5 * text_height, text.y + 0.5 * text_height};
  }
  [[nodiscard]] std::optional<PixelSpot> spot(double x, double y) const {
    const PixelSpot at{x_.to_pixels(x), y_.to_pixels(y)};
    const bool within = at.x >= 0.0 && at.x <= plot_width && at.y >= 0.0 && at.y <= plot_height;
    return within ? std::optional(at) : std::nullopt;
  }
  void add(const Curve& curve) {
    std::optional<PixelSpot> before;
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      const auto at = spot(curve.x[i], curve.y[i]);
      if (at && curve.mark != Mark::line) marks_.push_back(*at);
      if (at && before && curve.mark == Mark::line) add_line(*before, *at);
      before = at;
    }
  }
  void add_line(const PixelSpot& from, const PixelSpot& to) {
    for_steps(from, to, [&](const PixelSpot& at) { lines_.push_back(at); });
  }
  void add_text(const Box& box) { texts_.push_back(box); }

  template <typename Take>
  static void for_steps(const PixelSpot& from, const PixelSpot& to, Take&& take) {
    const int steps = 1 + static_cast<int>(std::hypot(to.x - from.x, to.y - from.y) / line_step);
    for (int i = 0; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      take(PixelSpot{from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)});
    }
  }

  [[nodiscard]] double cost_of(const Box& box, const PixelSpot& point, const PixelSpot& text) const {
    const bool within =
        box.left >= 0.0 && box.right <= plot_width && box.bottom >= 0.0 && box.top <= plot_height;
    if (!within) return std::numeric_limits<double>::infinity();
    double cost = 0.0;
    for (const Box& other : texts_) cost += box.meets(other) ? label_covered : 0.0;
    for (const PixelSpot& mark : marks_) cost += box.holds(mark, mark_reach) ? mark_covered : 0.0;
    for (const PixelSpot& at : lines_) cost += box.holds(at, 1.0) ? line_covered : 0.0;
    for_steps(point, text, [&](const PixelSpot& at) {
      if (std::hypot(at.x - point.x, at.y - point.y) < mark_reach) return;
      for (const Box& other : texts_) cost += other.holds(at, 0.0) ? label_covered : 0.0;
      for (const PixelSpot& mark : marks_)
        cost += std::hypot(at.x - mark.x, at.y - mark.y) < mark_reach ? crossed : 0.0;
    });
    return cost;
  }

  PixelAxis x_, y_;
  std::vector<PixelSpot> marks_;
  std::vector<PixelSpot> lines_;  ///< steps along them
  std::vector<Box> texts_;
};

}  // namespace

void place_labels(Chart& chart) {
  Crowd crowd(chart);
  for (PointLabel& label : chart.labels) crowd.place(label);
}

}  // namespace kerf::bench
