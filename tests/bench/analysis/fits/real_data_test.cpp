#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/fitting/fit.h>

#include "fits/fit_recording.h"
#include "fits/fit_series.h"
#include "import/import.h"
#include "laws/render.h"
#include "segment/segment.h"
#include "signal/quantiles.h"
#include "support/measured_data.h"

// What the laws say of measurements of other labs (docs/findings.md).

namespace kerf::bench {
namespace {

class RealFit : public testing::Test {
 protected:
  static schema::Recording imported(const std::string& data, const std::string& map, double rate_hz = 0.0) {
    return import_text(test::measured_file(data), {.map = parse_map(map), .rate_hz = rate_hz}).recording;
  }
  /// Every so many rows of a series, from one of them on; the first row, from which a law starts, stays.
  static AxisSeries thinned(const AxisSeries& all, std::size_t step, std::size_t from = 0) {
    AxisSeries few;
    for (std::size_t i = 0; i < all.time_s.size(); ++i) {
      if (i > 0 && (i < from || i % step != 0)) continue;
      few.time_s.push_back(all.time_s[i]);
      few.penetration.push_back(all.penetration[i]);
      few.velocity.push_back(all.velocity[i]);
      few.force.push_back(all.force[i]);
      if (!all.cycle.empty()) few.cycle.push_back(all.cycle[i]);
    }
    return few;
  }
  static double rms(const std::vector<double>& values) {
    double squares = 0.0;
    for (const double value : values) squares += value * value;
    return std::sqrt(squares / static_cast<double>(values.size()));
  }
  static const fitting::Estimate& of(const fitting::FitResult& fit, const std::string& name) {
    return *std::ranges::find(fit.parameters, name,
                              [](const fitting::Estimate& estimate) { return estimate.info.name; });
  }
};

TEST_F(RealFit, OfATendonNeedsMoreThanOneRelaxationTime) {
  KERF_NEEDS_DATA("tendon/relaxation_fresh_1.csv");
  const auto tendon = imported("tendon/relaxation_fresh_1.csv", "time=Time,position=Extension,force=Load");
  const AxisSeries series = axis_series(tendon, 0, {.position = 0.0, .direction = 1.0});
  const auto one = fitting::fit("kelvin", fitted_view(series));
  const auto several =
      fitting::fit("maxwell", fitted_view(series));  // as many arms as held-out blocks pay for
  const auto power = fitting::fit("springpot", fitted_view(series));
  EXPECT_GE(std::get<double>(several.law_options.at("arms")), 2.0);
  EXPECT_LT(several.cv_rmse, 0.5 * one.cv_rmse);
  // In the hold alone three arms leave 6 mN, the sensor's noise included: one misses by ten times that.
  EXPECT_GT(one.rmse, 0.05);
  EXPECT_LT(several.rmse, 0.02);
  // With no more parameters than one time constant has, a power of time does nearly as well as three.
  EXPECT_EQ(power.free_parameters, one.free_parameters);
  EXPECT_LT(power.rmse, 0.02);
  EXPECT_GT(of(power, "order").lower, 0.1);
  EXPECT_LT(of(power, "order").upper, 0.4);
}

// Stretched to four times its length it is not linear on the stroke there, so the stroke counts by its ends
// alone.
TEST_F(RealFit, OfAPolymerRelaxesAsAPowerOfTime) {
  KERF_NEEDS_DATA("vhb/relaxation_4d0.csv");
  const auto polymer = imported("vhb/relaxation_4d0.csv", "time=时间,position=位移,force=3");
  constexpr std::size_t hold = 255;
  const AxisSeries series = thinned(axis_series(polymer, 0, {.position = 0.0, .direction = 1.0}), 15, hold);
  const auto power = fitting::fit("springpot", fitted_view(series));
  fitting::FitOptions options;
  for (const double arms : {1.0, 2.0, 3.0}) {
    options.law_options["arms"] = arms;
    const auto times = fitting::fit("maxwell", fitted_view(series), options);
    EXPECT_LT(power.cv_rmse, times.cv_rmse) << arms;
    if (arms < 3.0) {
      EXPECT_LT(power.rmse, 0.5 * times.rmse) << arms;
    }
  }
  EXPECT_LT(power.rmse, 0.005);  // of 2.4 N at the beginning
}

// SciPy 1.10's least_squares from thirty random starts, on the same exact steps (least over all of them).
TEST_F(RealFit, OfRelaxationsReachesTheSumsOfSquaresOfAnotherSolver) {
  const std::map<std::string, std::vector<double>> least{
      {"vhb/relaxation_4d0.csv", {301.711360923, 71.0297543617, 16.6116126422, 14.619852347}},
      {"vhb/relaxation_5d0.csv", {395.677107826, 96.2909390071, 24.8087853333, 22.7411770035}}};
  for (const auto& [file, squares] : least) {
    KERF_NEEDS_DATA(file);
    const auto polymer = imported(file, "time=时间,position=位移,force=3");
    const AxisSeries series = axis_series(polymer, 0, {.position = 0.0, .direction = 1.0});
    for (std::size_t arms = 1; arms <= squares.size(); ++arms) {
      const fitting::FitOptions options{.law_options = {{"arms", static_cast<double>(arms)}}, .folds = 0};
      const auto fit = fitting::fit("maxwell", fitted_view(series), options);
      EXPECT_TRUE(fit.converged) << file << " " << arms << ": " << fit.message;
      // However badly one or two arms do, none of them is idle.
      for (const std::string& warning : fit.warnings)
        EXPECT_EQ(warning.find("without it"), std::string::npos) << file << " " << arms << ": " << warning;
      EXPECT_LT(fit.rmse * fit.rmse * static_cast<double>(fit.samples) / squares[arms - 1] - 1.0, 1e-9)
          << file << " " << arms;
    }
  }
}

struct Site {
  std::vector<double> time_s, depth, still, force;
};

TEST_F(RealFit, OfLiverStiffensExponentiallySiteBySite) {
  KERF_NEEDS_DATA("liver/pig_liver_20150826_region1.csv");
  const auto liver = imported("liver/pig_liver_20150826_region1.csv",
                              "position=depth_mm,force=normal_force_N,site=site[1]", 1.0);
  std::map<double, Site> sites;
  for (std::size_t row = 0; row < liver.rows(); ++row) {
    Site& site = sites[liver.channels[0].values[row]];
    site.time_s.push_back(static_cast<double>(site.time_s.size()));  // any will do: no law of speed is asked
    site.depth.push_back(liver.position[row] + 1e-9);                // the first row touches
    site.still.push_back(0.0);
    site.force.push_back(liver.force_measured[row]);
  }
  std::vector<double> left, amplitude, per_mm, left_where_weak;
  const fitting::FitOptions options{
      .law_options = {{"viscous", false}, {"offset", true}, {"thickness", 0.001}}, .folds = 0};
  for (const auto& [number, site] : sites) {
    const fitting::Series series{
        .time_s = site.time_s, .penetration = site.depth, .velocity = site.still, .force = site.force};
    const auto fit = fitting::fit("exponential", series, options);
    const double share = std::pow(fit.rmse / fitting::line_rmse(series), 2);
    if (*std::ranges::max_element(site.force) <= 0.3) {
      left_where_weak.push_back(share);
      continue;
    }
    EXPECT_TRUE(fit.converged) << number;
    left.push_back(share);
    amplitude.push_back(of(fit, "amplitude").value);
    per_mm.push_back(of(fit, "exponent").value);
  }
  ASSERT_EQ(left.size(), 58U);
  EXPECT_LT(median(left), 0.05);
  EXPECT_LT(*std::ranges::max_element(left), 0.1);
  // Where the ball barely touches, ten steps tell a curve from a line less well.
  EXPECT_LT(median(left), median(left_where_weak));
  // The medians given with the data, to their last digit.
  EXPECT_NEAR(median(amplitude), 0.039, 0.0015);
  EXPECT_NEAR(median(per_mm), 1.22, 0.015);
}

/// What goes into the viscosity and into the dry friction of a law along a path [J].
struct Work {
  double viscous = 0.0;
  double dry = 0.0;
};
Work work_of(const models::Law& law, const AxisSeries& series) {
  const auto& values = law.values();  // offset, stiffness, viscosity, coulomb, presliding
  const auto force = render(law, series);
  Work work;
  for (std::size_t i = 1; i < force.size(); ++i) {
    const double travel = series.penetration[i] - series.penetration[i - 1];
    const auto viscous = [&](std::size_t k) { return values[2] * series.velocity[k]; };
    const auto elastic = [&](std::size_t k) { return values[0] + values[1] * series.penetration[k]; };
    work.viscous += 0.5 * (viscous(i) + viscous(i - 1)) * travel;
    work.dry +=
        0.5 * travel * (force[i] - elastic(i) - viscous(i) + force[i - 1] - elastic(i - 1) - viscous(i - 1));
  }
  return work;
}

class RealGrasper : public RealFit {
 protected:
  void SetUp() override { KERF_NEEDS_DATA(file_of("00"), file_of("33")); }

  static std::string file_of(const std::string& number) {
    return "grasper/Tool_4_Maryland_L_2_" + number + ".TXT";
  }
  // The sensor at the spindle reads negative where the spindle is turned forward.
  static AxisSeries spindle(const std::string& number, const std::string& torque_unit) {
    const auto recording =
        imported(file_of(number), "time=1[s],position=2[0.0439453125 deg],force=3[" + torque_unit + "]");
    return thinned(axis_series(recording, 0, {.position = 0.0, .direction = 1.0}), 10);
  }
  static constexpr auto resisting = "-3.9811e-5 Nm";
};

TEST_F(RealGrasper, LosesItsWorkToDryFrictionAtBothSpeeds) {
  const AxisSeries slow = spindle("00", resisting);
  const AxisSeries fast = spindle("33", resisting);
  const std::vector<fitting::Series> both{fitted_view(slow), fitted_view(fast)};
  const auto fit =
      fitting::fit("friction", both, {.folds = 0, .per_recording = {"offset", "stiffness", "coulomb"}});
  ASSERT_TRUE(fit.converged);
  const auto other = std::ranges::find_if(
      fit.others, [](const fitting::Estimate& estimate) { return estimate.info.name == "coulomb"; });
  // The speed is three times as high and the dry friction the same: viscous it would be threefold.
  EXPECT_NEAR(other->value, of(fit, "coulomb").value, 0.1 * of(fit, "coulomb").value);
  EXPECT_GT(of(fit, "coulomb").lower, 0.0) << "it is there, whatever the residuals have of a memory";
  const Work at_slow = work_of(fit.law(0), slow);
  const Work at_fast = work_of(fit.law(1), fast);
  EXPECT_LT(at_slow.viscous, 0.1 * (at_slow.viscous + at_slow.dry));
  EXPECT_LT(at_fast.viscous, 0.2 * (at_fast.viscous + at_fast.dry));
}

// With the torque turned round the dry friction, which cannot be negative, is held at zero, and the rest is
// the same law without it.
TEST_F(RealGrasper, IsNotViscous) {
  for (const auto* number : {"00", "33"}) {
    const auto with = fitting::fit("friction", fitted_view(spindle(number, resisting)), {.folds = 0});
    const auto without = fitting::fit("friction", fitted_view(spindle(number, "3.9811e-5 Nm")), {.folds = 0});
    EXPECT_EQ(of(without, "coulomb").value, 0.0) << number;
    EXPECT_EQ(of(without, "coulomb").upper, std::numeric_limits<double>::infinity()) << number;
    EXPECT_GT(without.rmse, 3.0 * with.rmse) << number;
  }
}

// Whether a force that depends on the direction of motion (two straight lines closing, two opening) or one
// that remembers where the punch was a moment ago foretells the cycles that were left out.
// By all rows, and with the velocity in hindsight.
TEST_F(RealFit, OfAPunchDependsOnTheWayInTwoRecordingsAndOnTheTimeInThree) {
  const std::map<std::string, std::string> preferred{{"7_blank_slow_1819", "piecewise"},
                                                     {"8_blank_fast_1821", "kelvin"},
                                                     {"9_meniscus_slow_1824", "piecewise"},
                                                     {"11_meniscus_fast_1826", "kelvin"},
                                                     {"15_skin_knee_lateral_slow_1900", "kelvin"}};
  for (const auto& [name, law] : preferred) {
    KERF_NEEDS_DATA("meniscus/" + name + ".txt");
    auto punch = imported("meniscus/" + name + ".txt", "time=5[ms],position=4[deg],force=2[gf]");
    punch.cycles = find_cycles(punch, {});
    const AxisSeries series = thinned(axis_series(punch, 0, contact_of(punch, 0)), 10);
    const fitting::FitOptions options{.law_options = {{"segments", 2.0}}, .folds = 12};
    const double by_way = fitting::fit("piecewise", fitted_view(series), options).cv_rmse;
    const double by_time = fitting::fit("kelvin", fitted_view(series), {.folds = 12}).cv_rmse;
    EXPECT_EQ(by_way < by_time ? "piecewise" : "kelvin", law) << name << ": " << by_way << " " << by_time;
    // Neither is good enough to be taken for the recording by a hand.
    EXPECT_GT(std::min(by_way, by_time), fitting::force_jnd.at(rms(series.force))) << name;
  }
}

TEST_F(RealFit, OfAPunchBlamesTheSpreadFromCycleToCycle) {  // finding L4
  for (const auto* name :
       {"7_blank_slow_1819", "8_blank_fast_1821", "9_meniscus_slow_1824", "11_meniscus_fast_1826"}) {
    const std::string file = std::string("meniscus/") + name + ".txt";
    KERF_NEEDS_DATA(file);
    auto punch = imported(file, "time=5[ms],position=4[deg],force=2[gf]");
    punch.cycles = find_cycles(punch, {});
    const RecordingFit fit = fit_recording(punch, {.models = {"hunt_crossley"}});
    ASSERT_EQ(fit.laws.size(), 1U) << name;
    EXPECT_THAT(fit.blame(fit.laws[0]), testing::HasSubstr("the spread from cycle to cycle is most to blame"))
        << name;
    EXPECT_LT(fit.recordings[0].counted, fit.recordings[0].samples / 2) << name << ": a tool put down";
    // A sensor's steps of 7 mN are nothing beside it.
    EXPECT_LT(fit.floor->noise_n, 0.01 * fit.floor->unlimited_n) << name;
  }
}

TEST_F(RealFit, OfAPunchWithFewGoodCyclesBlamesThatThereAreFew) {
  const std::string file = "meniscus/15_skin_knee_lateral_slow_1900.txt";
  KERF_NEEDS_DATA(file);
  auto punch = imported(file, "time=5[ms],position=4[deg],force=2[gf]");
  punch.cycles = find_cycles(punch, {});
  const RecordingFit good = fit_recording(punch, {.models = {"hunt_crossley"}});
  EXPECT_THAT(good.blame(good.laws.at(0)),
              testing::AllOf(testing::HasSubstr("too little data is most to blame"),
                             testing::HasSubstr("beside the spread from cycle to cycle")));
  const RecordingFit all =
      fit_recording(punch, {.models = {"hunt_crossley"}, .rows = {.cycles = {.by = CycleChoice::By::all}}});
  EXPECT_THAT(all.blame(all.laws.at(0)),
              testing::HasSubstr("the spread from cycle to cycle is most to blame"));
}

}  // namespace
}  // namespace kerf::bench
