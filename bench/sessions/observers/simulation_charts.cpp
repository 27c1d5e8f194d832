#include <algorithm>
#include <cmath>

#include "observers/simulation_report.h"

namespace kerf::bench {
namespace {

/// An upright line with its ends, for an interval.
void add_interval(Curve& curve, double x, const psychophysics::Interval& interval, double scale = 1.0) {
  curve.x.insert(curve.x.end(), {x, x, x});
  curve.y.insert(curve.y.end(), {scale * interval.lower, scale * interval.upper, line_break});
}

/// The truth over the levels, and the answers of one experiment.
Chart psychometric_chart(const Simulation& simulation) {
  const bool two_sided = simulation.example_fit->two_sided;
  Chart chart{.title = "What the observers do, and one experiment",
              .x_label = "level of the comparison [% of the standard]",
              .y_label = two_sided ? "comparison named [%]" : "right [%]",
              .y_range = {two_sided ? 0.0 : 40.0, 102.0},
              .legend_below = true};
  Curve truth{.label = "truth, lapses included", .colour = Colour::black};
  Curve fitted{.label = "fit of this experiment", .colour = Colour::vermillion, .dashed = true};
  const LevelFit& pooled = simulation.example_fit->pooled;
  double least = pooled.points.front().intensity;
  double most = pooled.points.back().intensity;
  for (const CellTruth& at : simulation.curve_truth) {
    if (at.level < std::min(0.0, least) || at.level > 1.1 * most) continue;
    truth.x.push_back(100.0 * at.level);
    truth.y.push_back(100.0 * at.share);
    if (!pooled.fit || (!two_sided && at.level <= 0.0)) continue;
    fitted.x.push_back(100.0 * at.level);
    fitted.y.push_back(100.0 * pooled.fit->curve.probability(at.level));
  }
  Curve points{
      .label = "answers, with 95 % intervals", .colour = Colour::blue, .mark = Mark::circles, .width = 5.0};
  Curve bars{.colour = Colour::sky};
  for (const psychophysics::Level& level : pooled.points) {
    points.x.push_back(100.0 * level.intensity);
    points.y.push_back(100.0 * level.answers.successes / level.answers.trials);
    add_interval(bars, 100.0 * level.intensity, psychophysics::clopper_pearson(level.answers), 100.0);
  }
  chart.curves = {std::move(bars), std::move(truth), std::move(points)};
  if (pooled.fit) chart.curves.insert(chart.curves.begin() + 2, std::move(fitted));
  if (std::isfinite(simulation.truth.jnd))
    chart.vertical.push_back({.at = 100.0 * simulation.truth.jnd, .label = "true JND", .label_after = true});
  return chart;
}

/// Of each pair the truth, and the answers of one experiment.
Chart pairs_chart(const Simulation& simulation) {
  const bool preference = simulation.design == Design::preference;
  Chart chart{.title = "What the observers do, and one experiment",
              .x_label = preference ? "first of the pair preferred [%]" : "right [%]",
              .x_range = {0.0, 100.0},
              .legend_below = true,
              .height_px = 160 + 60 * static_cast<int>(simulation.truth.cells.size())};
  Curve truth{
      .label = "truth, lapses included", .colour = Colour::black, .mark = Mark::crosses, .width = 5.0};
  Curve points{
      .label = "answers, with 95 % intervals", .colour = Colour::blue, .mark = Mark::circles, .width = 5.0};
  Curve bars{.colour = Colour::sky};
  std::size_t row = simulation.truth.cells.size();
  for (const CellTruth& cell : simulation.truth.cells) {
    const auto y = static_cast<double>(row--);
    chart.y_ticks.push_back({.at = y, .name = cell.name});
    truth.x.push_back(100.0 * cell.share);
    truth.y.push_back(y + 0.15);
    psychophysics::Count count;
    for (const Judgement& judgement : simulation.example->judgements) {
      if (!judgement.counts() || judgement.pair != cell.pair || judgement.tissue != cell.tissue) continue;
      ++count.trials;
      count.successes += judgement.is_right() != preference ? 1 : 0;
    }
    if (count.trials == 0) continue;
    const auto interval = psychophysics::clopper_pearson(count);
    points.x.push_back(100.0 * count.successes / count.trials);
    points.y.push_back(y - 0.15);
    bars.x.insert(bars.x.end(), {100.0 * interval.lower, 100.0 * interval.upper, line_break});
    bars.y.insert(bars.y.end(), {y - 0.15, y - 0.15, line_break});
  }
  chart.y_range = {0.4, static_cast<double>(simulation.truth.cells.size()) + 0.6};
  chart.vertical.push_back({.at = 100.0 * simulation.truth.chance, .label = "chance"});
  chart.curves = {std::move(bars), std::move(truth), std::move(points)};
  return chart;
}

Chart power_chart(const Simulation& simulation) {
  Chart chart{.title = "Power against trials",
              .x_label = simulation.curve_of,
              .y_label = "power",
              .y_range = {0.0, 1.05},
              .legend_below = true};
  Curve theory{.label = "by the exact probability", .colour = Colour::black};
  Curve points{
      .label = "simulated, with 95 % intervals", .colour = Colour::blue, .mark = Mark::circles, .width = 5.0};
  Curve bars{.colour = Colour::sky};
  for (const PowerPoint& point : simulation.curve) {
    const auto x = static_cast<double>(point.trials);
    theory.x.push_back(x);
    theory.y.push_back(point.theory);
    if (point.found.significant.count.trials == 0) continue;
    points.x.push_back(x);
    points.y.push_back(point.found.significant.value());
    add_interval(bars, x, point.found.significant.interval());
  }
  chart.horizontal.push_back({.at = simulation.options.power, .label = "wanted"});
  chart.curves = {std::move(bars), std::move(points)};
  if (std::isfinite(simulation.theory)) chart.curves.insert(chart.curves.begin() + 1, std::move(theory));
  return chart;
}

/// Of a JND it is its precision that trials buy.
Chart precision_chart(const Simulation& simulation) {
  Chart chart{.title = "Precision of the JND against trials",
              .x_label = simulation.curve_of,
              .y_label = "ratio",
              .legend_below = true};
  Curve ratio{.label = "upper over lower end of the interval, median", .colour = Colour::blue};
  Curve scatter{.label = "one standard deviation of the estimates", .colour = Colour::green, .dashed = true};
  Curve bias{.label = "mean estimate over truth", .colour = Colour::vermillion};
  for (const PowerPoint& point : simulation.curve) {
    const auto x = static_cast<double>(point.trials);
    for (Curve* curve : {&ratio, &scatter, &bias}) curve->x.push_back(x);
    ratio.y.push_back(std::isfinite(point.found.jnd_ratio) ? point.found.jnd_ratio : line_break);
    scatter.y.push_back(std::exp(point.found.jnd_spread));
    bias.y.push_back(1.0 + point.found.jnd_bias);
  }
  double most = 1.0;
  for (const Curve* curve : {&ratio, &scatter, &bias}) {
    for (const double y : curve->y) most = std::isfinite(y) ? std::max(most, y) : most;
  }
  chart.y_range = {0.0, 1.08 * most};
  chart.horizontal.push_back({.at = 1.0, .label = ""});
  chart.curves = {std::move(ratio), std::move(scatter), std::move(bias)};
  return chart;
}

/// What the analysis promises, and what it kept.
Chart promises_chart(const Simulation& simulation) {
  Chart chart{.title = "What the analysis promises, and what it kept",
              .x_label = "share of the experiments [%]",
              .x_range = {0.0, 100.0},
              .height_px = 220};
  Curve points{.colour = Colour::blue, .mark = Mark::circles, .width = 5.0};
  Curve bars{.colour = Colour::blue, .width = 2.5};
  double y = 0.0;
  const auto add = [&](const std::string& name, const SimulatedShare& share) {
    if (share.count.trials == 0) return;
    y += 1.0;
    chart.y_ticks.push_back({.at = y, .name = name});
    const auto interval = share.interval();
    points.x.push_back(100.0 * share.value());
    points.y.push_back(y);
    bars.x.insert(bars.x.end(), {100.0 * interval.lower, 100.0 * interval.upper, line_break});
    bars.y.insert(bars.y.end(), {y, y, line_break});
  };
  add("false alarms", simulation.false_alarms);
  add("d' covered", simulation.found.d_prime_covered);
  add("JND covered", simulation.found.jnd_covered);
  chart.y_range = {0.4, y + 0.6};
  chart.height_px = 150 + 40 * static_cast<int>(y);
  if (simulation.false_alarms.count.trials > 0)
    chart.vertical.push_back(
        {.at = 100.0 * simulation.options.analysis.level, .label = "at most", .label_after = true});
  chart.vertical.push_back({.at = 100.0 * simulation.options.analysis.confidence, .label = "promised"});
  chart.curves = {std::move(bars), std::move(points)};
  return chart;
}

}  // namespace

std::vector<Figure> simulation_charts(const Simulation& simulation) {
  std::vector<Figure> figures;
  if (simulation.example_fit && !simulation.example_fit->pooled.points.empty()) {
    figures.push_back({.name = "psychometric", .chart = psychometric_chart(simulation)});
  } else if (!simulation.truth.cells.empty()) {
    figures.push_back({.name = "pairs", .chart = pairs_chart(simulation)});
  }
  if (!simulation.curve.empty()) {
    if (simulation.truth.is_of_levels) {
      figures.push_back({.name = "precision", .chart = precision_chart(simulation)});
    } else {
      figures.push_back({.name = "power", .chart = power_chart(simulation)});
    }
  }
  const SimulatedFindings& found = simulation.found;
  if (found.jnd_covered.count.trials + found.d_prime_covered.count.trials +
          simulation.false_alarms.count.trials >
      0)
    figures.push_back({.name = "promises", .chart = promises_chart(simulation)});
  return figures;
}

}  // namespace kerf::bench
