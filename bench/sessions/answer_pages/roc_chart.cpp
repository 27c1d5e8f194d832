#include "answer_pages/roc_chart.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/core.h>

#include "answer_pages/analysis_words.h"

namespace kerf::bench {
namespace {

Curve points_of_criteria(const psychophysics::Ratings& ratings) {
  Curve curve{.mark = Mark::points};
  for (const RocPoint& point : roc_points(ratings)) {
    curve.x.push_back(point.false_alarm_rate);
    curve.y.push_back(point.hit_rate);
  }
  return curve;
}

/// From corner to corner: criteria from beyond both distributions to below both.
Curve normal_curve(const psychophysics::NormalRoc& fit) {
  constexpr int steps = 200;
  constexpr double reach = 4.5;
  const auto normal = [](double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); };
  const double most = std::max(reach, fit.mean + reach * fit.deviation);
  const double least = std::min(-reach, fit.mean - reach * fit.deviation);
  Curve curve{.label = fmt::format("normal distributions: d_a {}, deviation {:.2f}", d_prime_text(fit.d_a),
                                   fit.deviation),
              .colour = Colour::blue,
              .width = 2.5};
  for (int i = 0; i <= steps; ++i) {
    const double criterion = most - (most - least) * i / steps;
    curve.x.push_back(normal(-criterion));
    curve.y.push_back(normal((fit.mean - criterion) / fit.deviation));
  }
  return curve;
}

/// All in one colour, thin lines that keep together what is of one subject: 24 colours tell nothing.
void add_subjects(const std::vector<RatingGroup>& subjects, Chart& chart) {
  const auto drawn = std::ranges::count_if(subjects, [](const auto& each) { return each.area.has_value(); });
  bool is_named = false;
  for (const RatingGroup& subject : subjects) {
    if (!subject.area) continue;
    Curve points = points_of_criteria(subject.ratings);
    points.colour = Colour::grey;
    points.width = 2.0;
    Curve line = points;
    line.mark = Mark::line;
    line.width = 0.5;
    line.x.insert(line.x.begin(), 0.0);
    line.y.insert(line.y.begin(), 0.0);
    line.x.push_back(1.0);
    line.y.push_back(1.0);
    if (!is_named) points.label = fmt::format("each of {} subjects", drawn);
    is_named = true;
    chart.curves.push_back(std::move(line));
    chart.curves.push_back(std::move(points));
  }
}

}  // namespace

Chart roc_chart(const RatingAnalysis& analysis, double confidence) {
  Chart chart{.title = "Confidence: ROC curve",
              .x_label = "false-alarm rate [1]",
              .y_label = "hit rate [1]",
              .x_range = {0.0, 1.0},
              .y_range = {0.0, 1.0},
              .legend_below = true,
              .width_px = 640,  // gnuplot leaves out a legend that is wider than the chart
              .height_px = 740};
  chart.curves.push_back({.label = "by guessing",
                          .x = {0.0, 1.0},
                          .y = {0.0, 1.0},
                          .colour = Colour::grey,
                          .width = 1.0,
                          .dashed = true});
  add_subjects(analysis.by_subject, chart);
  const RatingGroup& all = analysis.all;
  if (all.fit) chart.curves.push_back(normal_curve(*all.fit));
  Curve points = points_of_criteria(all.ratings);
  points.label = fmt::format("all: area {:.3f} ({:.3g} % {:.3f} to {:.3f})", all.area->value,
                             100.0 * confidence, all.area->interval.lower, all.area->interval.upper);
  points.width = 5.0;
  chart.curves.push_back(std::move(points));
  return chart;
}

}  // namespace kerf::bench
