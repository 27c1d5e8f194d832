#include "plot/label_places.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

/// A label's place in a plot of 600 x 400 pixels, both axes logarithmic from 1 to 100.
struct TextBox {
  explicit TextBox(const PointLabel& label) {
    const double width = 6.6 * static_cast<double>(label.text.size());
    const double x = 300.0 * std::log10(label.text_x);
    left = label.left ? x - width : x;
    right = left + width;
    middle = 200.0 * std::log10(label.text_y);
  }
  double left, right, middle;
};

Chart crowded() {
  Chart chart{.x_range = {1.0, 100.0}, .y_range = {1.0, 100.0}, .log_x = true, .log_y = true};
  chart.curves.push_back({.mark = Mark::points});
  for (int i = 0; i < 6; ++i) {
    const double x = 40.0 + i;
    const double y = 10.0 + 0.1 * i;
    chart.curves.front().x.push_back(x);
    chart.curves.front().y.push_back(y);
    chart.labels.push_back({.x = x, .y = y, .text = "piecewise, 12 segments"});
  }
  return chart;
}

TEST(LabelPlaces, CoverNeitherEachOtherNorMarks) {
  Chart chart = crowded();
  place_labels(chart);
  for (const PointLabel& one : chart.labels) {
    const TextBox box(one);
    for (const PointLabel& other : chart.labels) {
      if (&one == &other) continue;
      const TextBox its(other);
      EXPECT_TRUE(box.right <= its.left || its.right <= box.left ||
                  std::abs(box.middle - its.middle) >= 15.0);
      const double x = 300.0 * std::log10(other.x);
      const double y = 200.0 * std::log10(other.y);
      EXPECT_FALSE(x > box.left && x < box.right && std::abs(y - box.middle) < 7.5) << "a mark";
    }
  }
}

TEST(LabelPlaces, LieWithinThePlot) {
  Chart chart{.labels = {{.x = 99.0, .y = 99.0, .text = "at the corner"}},
              .x_range = {1.0, 100.0},
              .y_range = {1.0, 100.0},
              .log_x = true,
              .log_y = true};
  place_labels(chart);
  EXPECT_TRUE(chart.labels[0].left);
  EXPECT_LT(chart.labels[0].text_y, 99.0);
}

TEST(LabelPlaces, StayAsTheyAreOutsideThePlot) {
  Chart chart{.labels = {{.x = 0.0, .y = 5.0, .text = "nowhere on a logarithmic axis"}},
              .x_range = {1.0, 100.0},
              .y_range = {1.0, 100.0},
              .log_x = true,
              .log_y = true};
  place_labels(chart);
  EXPECT_TRUE(std::isnan(chart.labels[0].text_x));
}

}  // namespace
}  // namespace kerf::bench
