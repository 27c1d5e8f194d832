#include "chart/speed_accuracy.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "chart/chart_files.h"
#include "chart/chart_picture.h"
#include "chart/fidelities.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Without the cold costs, and each law timed once: nothing here depends on what a tick costs.
ChartOptions quick() { return {.models = {"kelvin"}, .folds = 0, .timing = {.rounds = 1, .cold_ticks = 0}}; }

/// An axis that goes in and out of the tissue like a sine, a second each.
ScriptedPath strokes_along(const std::string& axis, double depth) {
  ScriptedPath path;
  path.device.axes = {{.name = axis, .position_unit = "m", .force_unit = "N"}};
  path.at = [depth](double rate_hz) {
    SampledMotion motion = ticks_at(rate_hz, static_cast<std::size_t>(2.0 * rate_hz));
    for (std::size_t i = 0; i < motion.ticks(); ++i) {
      const double phase = std::acos(-1.0) * static_cast<double>(i) / rate_hz;
      motion.sample[i] = {.position = {depth * std::sin(phase)},
                          .velocity = {depth * std::acos(-1.0) * std::cos(phase)}};
    }
    return motion;
  };
  return path;
}

/// A vertical blade that turns about its own axis in the tissue, and goes nowhere: T2 of [Henry2004].
ScriptedPath turning_blade() {
  ScriptedPath path;
  for (const auto* name : {"x", "y", "z", "rx", "ry", "rz"}) {
    const bool turns = path.device.axes.size() >= 3;
    path.device.axes.push_back(
        {.name = name, .position_unit = turns ? "rad" : "m", .force_unit = turns ? "N·m" : "N"});
  }
  path.at = [](double rate_hz) {
    SampledMotion motion = ticks_at(rate_hz, static_cast<std::size_t>(rate_hz));
    for (std::size_t i = 0; i < motion.ticks(); ++i) {
      const double angle = 2.0 * static_cast<double>(i) / rate_hz;
      motion.sample[i] = {.position = {0.0, 0.0, 0.1, 0.0, 0.0, angle},
                          .velocity = {0.0, 0.0, 0.0, 0.0, 0.0, 2.0}};
    }
    return motion;
  };
  return path;
}

LawFile law_along_x(const models::Law& law) {
  return {.law = law, .contact = {.position = 0.0, .direction = 1.0}, .axis = "x"};
}

const ChartPoint& point(const SpeedAccuracy& chart, const std::string& law, const std::string& fidelity) {
  for (const ChartPoint& one : chart.points) {
    if (one.law == law && one.fidelity == fidelity) return one;
  }
  throw std::invalid_argument("no point " + law + ", " + fidelity);
}

TEST(SpeedAccuracy, StripsOfABladeConvergeWithTheSquareOfTheirNumber) {
  const std::vector values{0.0, 2e6, 4e5};
  const LawFile blade{
      .law = models::Law::make("blade", values, {{"thresholds", false}, {"edge", std::string()}})};
  const SpeedAccuracy chart = chart_scene(blade, turning_blade(), quick());
  for (int strips = 1; strips <= 32; strips *= 2) {
    const double error = point(chart, "blade", fmt::format("strips {}", strips)).error_n;
    const double finer = point(chart, "blade", fmt::format("strips {}", 2 * strips)).error_n;
    EXPECT_NEAR(error / finer, 4.0, 1e-6) << strips;
  }
  EXPECT_NEAR(point(chart, "blade", "exact").error_jnd, 0.0, 1e-9);
  EXPECT_EQ(point(chart, "blade", "paper 64").axis, "rz") << "the paper's blade turns without a torque";
  // Kn w^3 l / 12 w_z = 4e-3 N·m (T2 with 100 times the Kn), at the fingers 10 mm from the axis.
  EXPECT_NEAR(point(chart, "blade", "paper 64").error_n, 4e-3 / fitting::fingers_m, 1e-9);
}

TEST(SpeedAccuracy, CrossesEulerOutPastTwiceTheRelaxationTime) {
  // tau = 0.4 ms: at 1 kHz Euler diverges, at 4 kHz it does not.
  const LawFile fast = law_along_x(models::Law::make("kelvin", std::vector{100.0, 1000.0, 0.4}));
  const SpeedAccuracy chart = chart_scene(fast, strokes_along("x", 0.01), quick());
  EXPECT_EQ(point(chart, "kelvin", "Euler").stability.stable, Stable::no);
  EXPECT_FALSE(point(chart, "kelvin", "Euler").on_front);
  EXPECT_EQ(point(chart, "kelvin", "Euler, 250 Hz").stability.stable, Stable::no);
  EXPECT_NE(point(chart, "kelvin", "Euler, 4000 Hz").stability.stable, Stable::no);
  for (const auto* fidelity : {"exact", "exact, float", "semi-implicit", "semi-implicit, 250 Hz"})
    EXPECT_NE(point(chart, "kelvin", fidelity).stability.stable, Stable::no) << fidelity;
  const Chart picture = chart_picture(chart_as_json(chart));
  EXPECT_TRUE(std::any_of(picture.curves.begin(), picture.curves.end(),
                          [](const Curve& curve) { return curve.mark == Mark::crosses; }));
}

TEST(SpeedAccuracy, FirstOrderIntegratorsHalveTheirErrorWithThePeriod) {
  const LawFile tissue = law_along_x(models::Law::make("kelvin", std::vector{100.0, 400.0, 40.0}));
  const SpeedAccuracy chart = chart_scene(tissue, strokes_along("x", 0.01), quick());
  for (const std::string integrator : {"Euler", "semi-implicit"}) {
    EXPECT_NEAR(
        point(chart, "kelvin", integrator + ", 500 Hz").error_n / point(chart, "kelvin", integrator).error_n,
        2.0, 0.1);
  }
  EXPECT_LT(point(chart, "kelvin", "exact").error_n, 0.01 * point(chart, "kelvin", "Euler").error_n);
  EXPECT_LT(point(chart, "kelvin", "exact, float").error_n, 0.01 * point(chart, "kelvin", "Euler").error_n);
}

TEST(SpeedAccuracy, ErrorFallsWithSegmentsUpToTheLawsOwnNumberAndThenStays) {
  const LawFile segmented = law_along_x(models::Law::make(
      "piecewise", std::vector{0.0, 0.003, 0.006, 0.01, 0.0, 0.5, 0.7, 3.0}, {{"segments", 3.0}}));
  const SpeedAccuracy chart = chart_scene(segmented, strokes_along("x", 0.01), quick());
  const double one = point(chart, "piecewise", "1 segment").error_n;
  const double two = point(chart, "piecewise", "2 segments").error_n;
  const double three = point(chart, "piecewise", "3 segments").error_n;
  EXPECT_LT(two, 0.7 * one);
  EXPECT_LT(three, 0.01 * two);
  for (int segments = 4; segments <= 12; ++segments)
    EXPECT_LT(point(chart, "piecewise", fmt::format("{} segments", segments)).error_n, 0.01 * two);
  EXPECT_EQ(point(chart, "piecewise", "as given").error_n, 0.0);
}

TEST(SpeedAccuracy, FitsOtherLawsToAScalarOne) {
  const LawFile tissue = law_along_x(models::Law::make("hunt_crossley", std::vector{1.0, 0.5, 1.5}));
  const SpeedAccuracy chart = chart_scene(tissue, strokes_along("x", 0.01), quick());
  EXPECT_GT(point(chart, "kelvin", "exact").error_n,
            10.0 * point(chart, "hunt_crossley", "as given").error_n);
}

TEST(SpeedAccuracy, AsksWhetherTheClosedLoopIsStable) {
  const LawFile tissue = law_along_x(models::Law::make("kelvin", std::vector{100.0, 400.0, 40.0}));
  ChartOptions options = quick();
  options.stability = [](const LawFile& law, double) -> StabilityVerdict {
    const auto precision = law.law.options().find("precision");
    const bool single =
        precision != law.law.options().end() && std::get<std::string>(precision->second) == "float";
    return single ? not_stable("it has a limit cycle") : StabilityVerdict{Stable::yes, {}};
  };
  const SpeedAccuracy chart = chart_scene(tissue, strokes_along("x", 0.01), options);
  EXPECT_EQ(point(chart, "kelvin", "exact").stability.stable, Stable::yes);
  EXPECT_EQ(point(chart, "kelvin", "exact, float").stability.stable, Stable::no);
  EXPECT_THAT(point(chart, "kelvin", "exact, float").stability.why, HasSubstr("it has a limit cycle"));
}

TEST(SpeedAccuracy, DoesNotCallStableWhatNobodyPressed) {
  const LawFile tissue = law_along_x(models::Law::make("kelvin", std::vector{100.0, 400.0, 40.0}));
  const SpeedAccuracy chart = chart_scene(tissue, strokes_along("x", 0.01), quick());
  EXPECT_TRUE(std::ranges::any_of(chart.points, &ChartPoint::on_front)) << "it competes all the same";
  const auto json = chart_as_json(chart);
  for (const auto& one : json.at("points")) {
    if (one.at("stable") == false) continue;
    EXPECT_TRUE(one.at("stable").is_null()) << one;
    EXPECT_THAT(one.at("why_not_judged").get<std::string>(), HasSubstr("no hand pressed")) << one;
    EXPECT_EQ(one.at("why_not_stable"), "");
  }
  EXPECT_THAT(chart_csv(chart), HasSubstr(",not judged,"));
  EXPECT_THAT(chart_page(chart), HasSubstr("its stability was not judged"));
  EXPECT_THAT(chart_page(chart), Not(HasSubstr("<td>yes")));
}

TEST(SpeedAccuracy, RefusesAPathThatNeverMeetsTheTissue) {
  LawFile tissue = law_along_x(models::Law::make("kelvin", std::vector{100.0, 400.0, 40.0}));
  tissue.contact.position = 1.0;
  EXPECT_THROW((void)chart_scene(tissue, strokes_along("x", 0.01), quick()), std::invalid_argument);
}

TEST(SpeedAccuracy, StopsWithoutPoints) {
  const LawFile tissue = law_along_x(models::Law::make("kelvin", std::vector{100.0, 400.0, 40.0}));
  const std::atomic<bool> stop{true};
  ChartOptions options = quick();
  options.stop = &stop;
  const SpeedAccuracy chart = chart_scene(tissue, strokes_along("x", 0.01), options);
  EXPECT_TRUE(chart.stopped);
  EXPECT_TRUE(chart.points.empty());
}

TEST(ChartFiles, HoldEveryPoint) {
  const LawFile tissue = law_along_x(models::Law::make("kelvin", std::vector{100.0, 400.0, 40.0}));
  SpeedAccuracy chart = chart_scene(tissue, strokes_along("x", 0.01), quick());
  chart.source = "<b>tissue</b>";
  const auto json = chart_as_json(chart);
  EXPECT_EQ(json["points"].size(), chart.points.size());
  EXPECT_FALSE(json["front"].empty());
  const std::string csv = chart_csv(chart);
  EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), chart.points.size() + 1);
  EXPECT_THAT(csv, HasSubstr("\"Euler, 250 Hz\""));
  const std::string page = chart_page(chart);
  EXPECT_THAT(page, HasSubstr("&lt;b&gt;tissue"));
  EXPECT_THAT(page, HasSubstr("semi-implicit, 4000 Hz"));
  EXPECT_THAT(page, HasSubstr("<svg"));
}

}  // namespace
}  // namespace kerf::bench
