#include "answer_pages/analysis_charts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/core.h>

#include "answer_pages/analysis_words.h"
#include "answer_pages/roc_chart.h"
#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

constexpr std::array subject_colours{Colour::blue,   Colour::vermillion, Colour::green, Colour::purple,
                                     Colour::orange, Colour::sky,        Colour::grey,  Colour::yellow};
constexpr std::size_t max_tracks = 12;

/// Rows of a forest plot from the top down: names at the left, a bar and a point each.
class Forest {
 public:
  Forest(std::string title, std::string x_label) {
    chart_.title = std::move(title);
    chart_.x_label = std::move(x_label);
  }

  void add(const std::string& name, double value, psychophysics::Interval interval, Colour colour) {
    const double at = next_--;
    chart_.y_ticks.push_back({.at = at, .name = name});
    if (std::isfinite(interval.lower) && std::isfinite(interval.upper)) {
      Curve bar{.x = {interval.lower, interval.upper}, .y = {at, at}, .colour = colour, .width = 2.5};
      chart_.curves.push_back(std::move(bar));
    }
    chart_.curves.push_back({.x = {value}, .y = {at}, .colour = colour, .mark = Mark::points, .width = 4.0});
  }

  void leave_space() { next_ -= 0.5; }

  [[nodiscard]] Chart finished() {
    chart_.y_range = {next_ + 0.3, 1.3};  // room for the name of a line at the top
    chart_.height_px = 150 + static_cast<int>(24.0 * -next_);
    return std::move(chart_);
  }
  [[nodiscard]] Chart& chart() { return chart_; }

 private:
  Chart chart_;
  double next_ = 0.0;
};

void add_family(Forest& forest, const std::vector<AnswerGroup>& family, const char* prefix, Colour colour) {
  for (const AnswerGroup& group : family) {
    const auto [k, n] = group.count;
    forest.add(fmt::format("{}{} ({})", prefix, group.name, n), 100.0 * k / n,
               {.lower = 100.0 * group.interval.lower, .upper = 100.0 * group.interval.upper}, colour);
  }
}

double level_at(double share, psychophysics::Axis axis, double least, double most) {
  return axis == psychophysics::Axis::logarithmic ? least * std::pow(most / least, share)
                                                  : least + share * (most - least);
}

/// Levels that the axis can show: on a logarithmic one not 0.
Range shown_levels(const LevelFit& fit, psychophysics::Axis axis) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const psychophysics::Level& level : fit.points) {
    if (axis == psychophysics::Axis::logarithmic && level.intensity <= 0.0) continue;
    least = std::min(least, level.intensity);
    most = std::max(most, level.intensity);
  }
  if (axis == psychophysics::Axis::logarithmic) return {least / 1.3, most * 1.3};
  const double room = most > least ? 0.06 * (most - least) : 0.1;
  return {least - room, most + room};
}

/// 1, 2 and 5 times powers of ten, which gnuplot itself writes at powers alone.
std::vector<NamedTick> logarithmic_ticks(Range range) {
  std::vector<NamedTick> ticks;
  const int first = static_cast<int>(std::floor(std::log10(range.begin)));
  const int last = static_cast<int>(std::ceil(std::log10(range.end)));
  for (int power = first; power <= last; ++power) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double at = factor * std::pow(10.0, power);
      if (at >= range.begin && at <= range.end)
        ticks.push_back({.at = at, .name = fmt::format("{:.3g}", at)});
    }
  }
  return ticks;
}

Curve drawn_curve(const psychophysics::Psychometric& psychometric, Range range, Colour colour, double width) {
  constexpr int steps = 160;
  Curve curve{.colour = colour, .width = width};
  for (int i = 0; i <= steps; ++i) {
    const double at = level_at(static_cast<double>(i) / steps, psychometric.axis, range.begin, range.end);
    curve.x.push_back(at);
    curve.y.push_back(100.0 * psychometric.probability(at));
  }
  return curve;
}

/// Where the curve reaches its criterion, as wide as its interval; an open end goes to the border.
void add_threshold(Chart& chart, const psychophysics::Threshold& threshold, Colour colour, double width) {
  const double y = 100.0 * threshold.criterion;
  const double begin = std::max(chart.x_range.begin, threshold.interval.lower);
  const double end = std::min(chart.x_range.end, threshold.interval.upper);
  chart.curves.push_back({.x = {begin, end}, .y = {y, y}, .colour = colour, .width = width});
}

/// Marks whose area goes with their answers.
void add_points(Chart& chart, const LevelFit& fit) {
  int most = 1;
  for (const psychophysics::Level& level : fit.points) most = std::max(most, level.answers.trials);
  std::map<int, Curve> by_size;
  for (const psychophysics::Level& level : fit.points) {
    const auto [k, n] = level.answers;
    const int size = static_cast<int>(std::lround(10.0 * std::sqrt(static_cast<double>(n) / most)));
    Curve& curve = by_size[std::max(2, size)];
    curve.x.push_back(level.intensity);
    curve.y.push_back(100.0 * k / n);
  }
  for (auto& [size, curve] : by_size) {
    curve.mark = Mark::points;
    curve.width = 0.75 * size;
    if (size == by_size.rbegin()->first)
      curve.label = fmt::format("answers at a level, the largest {}", most);
    chart.curves.push_back(curve);
  }
}

std::vector<double> times_of(const Study& study, const std::string* subject, std::optional<bool> right) {
  std::vector<double> times;
  for (const Judgement& each : study.judgements) {
    if (!each.counts() || !std::isfinite(each.response_s)) continue;
    if ((subject != nullptr && each.subject != *subject) || (right && each.is_right() != *right)) continue;
    times.push_back(each.response_s);
  }
  return times;
}

/// Every sample with its interval over subjects.
Chart estimate_chart(const Analysis& analysis) {
  const EstimateAnalysis& estimates = *analysis.estimates;
  Forest forest(estimates.of_magnitudes ? "Magnitudes over subjects" : "Ratings over subjects",
                !estimates.of_magnitudes ? "mean rating"
                : estimates.has_modulus  ? "times the number of the standard"
                                         : "times the mean of all samples");
  for (const EstimatedTissue& tissue : estimates.tissues) {
    const std::string where = tissue.tissue.empty() ? std::string() : tissue.tissue + ": ";
    for (const EstimatedSample& sample : tissue.samples)
      forest.add(where + sample.name, sample.value, sample.interval, Colour::blue);
    forest.leave_space();
  }
  return forest.finished();
}

}  // namespace

Chart proportion_chart(const Analysis& analysis) {
  const bool preference = analysis.design == Design::preference;
  const std::string counted = !preference    ? "right answers"
                              : analysis.all ? fmt::format("answers: {}", analysis.all->counted)
                                             : "answers that prefer the first of the pair";
  Forest forest(fmt::format("{} with {:.3g} % intervals", preference ? "Preferences" : "Right answers",
                            100.0 * analysis.options.confidence),
                fmt::format("{} [%]", counted));
  if (analysis.all) add_family(forest, {*analysis.all}, "", Colour::black);
  if (analysis.spread.population) {
    const auto& population = *analysis.spread.population;
    forest.add(fmt::format("mean of {} subjects", analysis.spread.subjects), 100.0 * population.mean,
               {.lower = 100.0 * population.interval.lower, .upper = 100.0 * population.interval.upper},
               Colour::grey);
  }
  const auto add = [&](const std::vector<AnswerGroup>& family, const char* prefix, Colour colour) {
    if (family.size() < 2) return;
    forest.leave_space();
    add_family(forest, family, prefix, colour);
  };
  add(analysis.by_tissue, "", Colour::blue);
  add(analysis.by_pair, "", Colour::green);
  add(analysis.by_subject, "subject ", Colour::vermillion);
  const double chance = analysis.all ? analysis.all->chance : 0.5;
  forest.chart().vertical.push_back(
      {.at = 100.0 * chance, .label = preference ? "no preference" : "chance", .label_after = true});
  forest.chart().x_range = {0.0, 100.0};
  return forest.finished();
}

Chart psychometric_chart(const Analysis& analysis) {
  const LevelAnalysis& levels = *analysis.levels;
  Chart chart{.title = "Psychometric functions",
              .x_label = "level [1, fraction of the standard]",
              .y_label = levels.two_sided ? "comparison named [%]" : "right answers [%]",
              .x_range = shown_levels(levels.pooled, levels.axis),
              .y_range = {levels.two_sided ? 0.0 : std::max(0.0, 100.0 * levels.guess - 25.0), 103.0},
              .log_x = levels.axis == psychophysics::Axis::logarithmic,
              .legend_below = true,
              .height_px = 460};
  if (chart.log_x) chart.x_ticks = logarithmic_ticks(chart.x_range);
  for (std::size_t i = 0; i < levels.by_subject.size(); ++i) {
    const LevelFit& subject = levels.by_subject[i];
    if (!subject.fit) continue;
    const Colour colour = subject_colours[i % subject_colours.size()];
    Curve curve = drawn_curve(subject.fit->curve, chart.x_range, colour, 1.2);
    curve.label = subject.name;
    curve.dashed = i >= subject_colours.size();
    chart.curves.push_back(std::move(curve));
  }
  if (levels.pooled.fit) {
    Curve curve = drawn_curve(levels.pooled.fit->curve, chart.x_range, Colour::black, 2.5);
    curve.label = levels.by_subject.empty() ? levels.pooled.name : "all together";
    chart.curves.push_back(std::move(curve));
    const auto& threshold = levels.two_sided ? levels.pooled.equality : levels.pooled.jnd;
    if (threshold) {
      add_threshold(chart, *threshold, Colour::black, 4.0);
      chart.vertical.push_back(
          {.at = threshold->value,
           .label = fmt::format("{} {}", levels.two_sided ? "PSE" : "JND", percent_text(threshold->value)),
           .label_after = false});
    }
  }
  add_points(chart, levels.pooled);
  chart.horizontal.push_back({.at = 100.0 * (levels.two_sided ? 0.5 : levels.guess),
                              .label = levels.two_sided ? "equally often" : "by guessing"});
  return chart;
}

/// "staircase", or which of several.
std::string staircase_name(const AdaptiveTrack& track, const Analysis& analysis) {
  const bool is_one_of_several = std::any_of(analysis.tracks.begin(), analysis.tracks.end(),
                                             [](const AdaptiveTrack& other) { return other.number > 0; });
  return is_one_of_several ? fmt::format("staircase {}", track.number + 1) : "staircase";
}

Chart track_chart(const AdaptiveTrack& track, const Analysis& analysis) {
  const bool staircase = analysis.design == Design::staircase;
  Chart chart{.title = fmt::format("{}, session {}: {}", track.subject, track.session,
                                   staircase ? staircase_name(track, analysis) : "QUEST+"),
              .x_label = "trial",
              .y_label = "level [1, fraction of the standard]",
              .log_y = true,
              .legend_below = true,
              .height_px = 430};
  Curve line{.colour = Colour::grey, .mark = Mark::line, .width = 1.0};
  Curve right{.label = "right", .colour = Colour::blue, .mark = Mark::points, .width = 2.5};
  Curve wrong{.label = "wrong", .colour = Colour::vermillion, .mark = Mark::crosses, .width = 4.5};
  Curve turned{.label = "reversal", .colour = Colour::black, .mark = Mark::circles, .width = 6.0};
  for (std::size_t trial = 0; trial < track.levels.size(); ++trial) {
    const double x = static_cast<double>(trial) + 1.0;
    for (Curve* curve : {&line, track.right[trial] ? &right : &wrong}) {
      curve->x.push_back(x);
      curve->y.push_back(track.levels[trial]);
    }
  }
  for (const std::size_t trial : track.reversals) {
    turned.x.push_back(static_cast<double>(trial) + 1.0);
    turned.y.push_back(track.levels[trial]);
  }
  for (Curve* curve : {&line, &right, &wrong, &turned}) {
    if (!curve->x.empty()) chart.curves.push_back(std::move(*curve));
  }
  const double end = static_cast<double>(track.levels.size()) + 1.0;
  const auto add_estimate = [&](const std::string& name, double at) {
    chart.curves.push_back(
        {.label = name, .x = {0.0, end}, .y = {at, at}, .colour = Colour::green, .dashed = true});
  };
  if (track.staircase) {
    add_estimate(
        fmt::format("mean of {} reversals: {} at {} right", track.staircase->reversals,
                    percent_text(track.staircase->threshold), percent_text(track.staircase->probability)),
        track.staircase->threshold);
  }
  if (track.quest)
    add_estimate(fmt::format("threshold of the curve: {}", percent_text(track.quest->threshold)),
                 track.quest->threshold);
  const auto [least, most] = std::minmax_element(track.levels.begin(), track.levels.end());
  chart.x_range = {0.0, end};
  chart.y_range = {*least / 1.3, *most * 1.3};
  chart.y_ticks = logarithmic_ticks(chart.y_range);
  return chart;
}

Chart ranking_chart(const TissueRanking& ranking, const Analysis& analysis) {
  Forest forest(
      fmt::format("{}{}", ranking.tissue.empty() ? "" : ranking.tissue + ": ",
                  "worth of the samples (Bradley-Terry, the mean is 0)"),
      fmt::format("worth [1, log odds], with {:.3g} % intervals", 100.0 * analysis.options.confidence));
  const auto& worth = ranking.bradley_terry->worth;
  std::vector<std::size_t> order(worth.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return worth[a] > worth[b]; });
  for (const std::size_t i : order) {
    forest.add(analysis.samples[ranking.samples[i]], worth[i], ranking.intervals[i], Colour::blue);
  }
  double most = 0.0;
  for (const psychophysics::Interval& interval : ranking.intervals)
    most = std::max({most, -interval.lower, interval.upper});
  forest.chart().x_range = {-1.1 * most, 1.1 * most};
  forest.chart().vertical.push_back({.at = 0.0, .label = "mean", .label_after = true});
  return forest.finished();
}

Chart time_chart(const Study& study, const Analysis& analysis) {
  Forest forest("Time to the answer: median and quartiles", "time [s]");
  const bool apart = std::isfinite(analysis.times.right_is_faster);
  double most = 0.0;
  const auto add = [&](const std::string& name, const std::string* subject, std::optional<bool> right,
                       Colour colour) {
    const std::vector<double> times = times_of(study, subject, right);
    if (times.empty()) return;
    const psychophysics::Interval quartiles{.lower = quantile(times, 0.25), .upper = quantile(times, 0.75)};
    most = std::max(most, quartiles.upper);
    forest.add(fmt::format("{} ({})", name, times.size()), quantile(times, 0.5), quartiles, colour);
  };
  const auto add_all = [&](const std::string& name, const std::string* subject) {
    if (apart) {
      add(fmt::format("{}, right", name), subject, true, Colour::blue);
      add(fmt::format("{}, wrong", name), subject, false, Colour::vermillion);
    } else {
      add(name, subject, std::nullopt, Colour::blue);
    }
  };
  add_all("all", nullptr);
  if (analysis.subjects.size() > 1) {
    for (const std::string& subject : analysis.subjects) {
      forest.leave_space();
      add_all(subject, &subject);
    }
  }
  forest.chart().x_range = {0.0, most > 0.0 ? 1.1 * most : 1.0};
  return forest.finished();
}

std::vector<Figure> analysis_figures(const Study& study, const Analysis& analysis) {
  std::vector<Figure> figures;
  if (analysis.trials == 0) return figures;
  if (analysis.levels && analysis.levels->pooled.points.size() > 1)
    figures.push_back({"psychometric", psychometric_chart(analysis)});
  if (analysis.ratings && analysis.ratings->all.area)
    figures.push_back({"roc", roc_chart(*analysis.ratings, analysis.options.confidence)});
  for (std::size_t i = 0; i < std::min(analysis.tracks.size(), max_tracks); ++i)
    figures.push_back({fmt::format("track-{}", i + 1), track_chart(analysis.tracks[i], analysis)});
  for (std::size_t i = 0; i < analysis.rankings.size(); ++i) {
    if (analysis.rankings[i].bradley_terry)
      figures.push_back({fmt::format("ranking-{}", i + 1), ranking_chart(analysis.rankings[i], analysis)});
  }
  if ((analysis.all || !analysis.by_pair.empty()) && !analysis.levels)
    figures.push_back({"proportions", proportion_chart(analysis)});
  if (analysis.estimates) figures.push_back({"estimates", estimate_chart(analysis)});
  if (analysis.times.trials > 0) figures.push_back({"response-times", time_chart(study, analysis)});
  return figures;
}

}  // namespace kerf::bench
