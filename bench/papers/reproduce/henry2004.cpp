#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include <fmt/core.h>

#include <kerf/models/blade.h>
#include <kerf/models/precontact.h>
#include <kerf/models/two_thresholds.h>

#include "reproduce/reproduce.h"
#include "scene/scalpel_paths.h"
#include "signal/quantiles.h"

namespace kerf::bench::henry2004 {
namespace {

using Eigen::Vector3d;
using models::BladeFidelity;

constexpr double period_s = 1e-3;

/// A scalpel's blade in the plane of y and z, 10 mm wide, 30 mm long, its tip 12 mm under the surface, edge
/// ahead on -y. Friction is five times as large across the blade as along it; [Henry2004] gives no numbers.
const models::BladeShape& scalpel() {
  static const models::BladeShape shape = models::BladeShape::parse(
      "0 -0.005 -0.112, 0 0.005 -0.112, 0 0.005 -0.082, 0 -0.005 -0.082", "0 -0.005 -0.112, 0 -0.005 -0.082");
  return shape;
}
constexpr models::BladeField friction{.edge = 20.0, .normal = 2e4, .tangential = 4e3};

/// Pose and twist over time, and the wrench that each fidelity gives.
struct Path {
  std::vector<double> time_s;
  std::vector<models::Pose> pose;
  std::vector<models::Twist> twist;
};

Path sampled(const std::vector<drivers::PoseKeyframe>& keyframes) {
  const drivers::PosePath pose_path({.keyframes = keyframes});
  Path path;
  for (double t = 0.0; t < keyframes.back().at_s; t += period_s) {
    const auto now = pose_path.at(t);
    const auto part = [](const drivers::Axes& axes, std::size_t from) {
      return Vector3d(axes[from], axes[from + 1], axes[from + 2]);
    };
    const Vector3d turned = part(now.position, 3);
    path.time_s.push_back(t);
    path.pose.push_back({.hand = part(now.position, 0), .rotation = models::rotation_of(turned)});
    path.twist.push_back(
        {.linear = part(now.velocity, 0), .angular = models::left_jacobian(turned) * part(now.velocity, 3)});
  }
  return path;
}

std::vector<models::Wrench> wrenches_along(const Path& path, BladeFidelity fidelity) {
  std::vector<models::Wrench> wrenches;
  for (std::size_t i = 0; i < path.time_s.size(); ++i) {
    wrenches.push_back(models::blade_wrench(scalpel(), friction, fidelity, path.pose[i], path.twist[i]));
  }
  return wrenches;
}

template <typename Get>
std::vector<double> series(const std::vector<models::Wrench>& wrenches, Get&& get) {
  std::vector<double> values;
  for (const models::Wrench& wrench : wrenches) values.push_back(get(wrench));
  return values;
}
double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

constexpr Colour axis_colours[] = {Colour::blue, Colour::vermillion, Colour::green};
constexpr const char* axis_names[] = {"x", "y", "z"};

template <typename Get>
Chart over_time(const Path& path, const std::string& title, const std::string& y_label, Get&& get) {
  Chart chart{.title = title, .x_label = "time [s]", .y_label = y_label};
  for (int axis = 0; axis < 3; ++axis) {
    Curve curve{.label = axis_names[axis], .x = path.time_s, .colour = axis_colours[axis]};
    for (std::size_t i = 0; i < path.time_s.size(); ++i) curve.y.push_back(get(i, axis));
    chart.curves.push_back(std::move(curve));
  }
  return chart;
}

void cut_and_push(Reproduction& paper) {
  const Path path = sampled(scalpel_t1());
  const auto wrenches = wrenches_along(path, {BladeFidelity::Kind::paper, 16});
  const auto milli_newton = [&](std::size_t i, int axis) { return 1e3 * wrenches[i].force[axis]; };
  paper.figures.push_back(
      {"t1_velocity", over_time(path, "T1: velocity (fig. 12)", "velocity [mm/s]",
                                [&](std::size_t i, int a) { return 1e3 * path.twist[i].linear[a]; })});
  paper.figures.push_back(
      {"t1_force", over_time(path, "T1: force on the hand (fig. 13)", "force [mN]", milli_newton)});
  paper.figures.push_back(
      {"t1_torque", over_time(path, "T1: torque at the hand (fig. 13)", "torque [mN·m]",
                              [&](std::size_t i, int a) { return 1e3 * wrenches[i].moment[a]; })});
  bool opposes = true;
  Vector3d cutting = Vector3d::Zero();
  Vector3d turning = Vector3d::Zero();
  double across = 0.0;
  for (std::size_t i = 0; i < wrenches.size(); ++i) {
    const double power = wrenches[i].force.dot(path.twist[i].linear);
    opposes = opposes && power <= 0.0;
    if (path.time_s[i] < 0.9) {
      cutting = cutting.cwiseMax(wrenches[i].force.cwiseAbs());
      turning = turning.cwiseMax(wrenches[i].moment.cwiseAbs());
    } else {
      across = std::max(across, std::abs(wrenches[i].force.x()));
    }
  }
  paper.add("While cutting along y the most important effort is along y, against the velocity",
            "5.1, fig. 13",
            fmt::format(
                "force up to {:.0f}, {:.0f}, {:.0f} mN along x, y, z; force times velocity never above zero",
                1e3 * cutting.x(), 1e3 * cutting.y(), 1e3 * cutting.z()),
            opposes && cutting.y() > cutting.x() && cutting.y() > cutting.z());
  paper.add("A torque around x is applied to the tool", "5.1, fig. 13",
            fmt::format("torque up to {:.1f}, {:.1f}, {:.1f} mN·m about x, y, z", 1e3 * turning.x(),
                        1e3 * turning.y(), 1e3 * turning.z()),
            turning.x() > turning.y() && turning.x() > turning.z());
  paper.add("The abnormal movement across the blade is harder at an equal speed", "5.1, fig. 13",
            fmt::format("{:.0f} mN across against {:.0f} mN along: {:.1f} times", 1e3 * across,
                        1e3 * cutting.y(), across / cutting.y()),
            across > 1.5 * cutting.y());
}

void turn(Reproduction& paper) {
  const Path path = sampled(scalpel_t2());
  const auto about_z = [](const models::Wrench& w) { return 1e6 * w.moment.z(); };
  const auto of_paper = series(wrenches_along(path, {BladeFidelity::Kind::paper, 16}), about_z);
  const auto of_strips = series(wrenches_along(path, {BladeFidelity::Kind::strips, 16}), about_z);
  const auto of_exact = series(wrenches_along(path, {BladeFidelity::Kind::exact}), about_z);
  Chart chart{
      .title = "T2: torque about the main axis (fig. 16)", .x_label = "time [s]", .y_label = "torque [uN·m]"};
  chart.curves.push_back(
      {.label = "exact", .x = path.time_s, .y = of_exact, .colour = Colour::blue, .width = 3.0});
  chart.curves.push_back(
      {.label = "strips(16)", .x = path.time_s, .y = of_strips, .colour = Colour::orange, .dashed = true});
  chart.curves.push_back({.label = "paper", .x = path.time_s, .y = of_paper, .colour = Colour::vermillion});
  paper.figures.push_back({"t2_torque", std::move(chart)});
  bool opposes = true;
  for (std::size_t i = 0; i < of_exact.size(); ++i) {
    opposes = opposes && of_exact[i] * path.twist[i].angular.z() <= 0.0;
  }
  paper.add(
      "The model gives no adequate torque for a turn about the main axis", "5.2, fig. 16",
      fmt::format("`paper`: at most {:.2g} uN·m; `exact`: {:.1f} uN·m", largest(of_paper), largest(of_exact)),
      largest(of_paper) < 1e-3 * largest(of_exact));
  paper.add("The expected feedback is a torque against the turn", "5.2",
            fmt::format("`exact` opposes it at every tick; `strips(16)` is within {:.2f} %",
                        100.0 * std::abs(largest(of_strips) / largest(of_exact) - 1.0)),
            opposes);
}

/// Error of an approximation against `exact` over random poses and twists: median and 95th percentile.
struct Spread {
  double median, high;
};
Spread spread_of(const std::vector<double>& values) {
  return {quantile(values, 0.5), quantile(values, 0.95)};
}

/// Poses in which the blade cuts the surface, with velocities up to 50 mm/s and turns up to a speed [rad/s].
struct Draw {
  models::Pose pose;
  models::Twist twist;
  models::Wrench exact;
};
std::vector<Draw> draw_poses(std::uint64_t seed, double turning_rad_s) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&] {
    const double x = uniform(random);
    const double y = uniform(random);
    return Vector3d(x, y, uniform(random));
  };
  std::vector<Draw> draws;
  while (draws.size() < 2000) {
    Draw draw;
    draw.pose.rotation = models::rotation_of(0.6 * vector());
    draw.pose.hand =
        Vector3d(0.0, 0.0, 0.012 * uniform(random)) - draw.pose.rotation * Vector3d(0.0, 0.0, -0.1);
    draw.twist = {.linear = 0.05 * vector(), .angular = turning_rad_s * vector()};
    draw.exact = models::blade_wrench(scalpel(), friction, {}, draw.pose, draw.twist);
    if (draw.exact.force.norm() > 1e-3) draws.push_back(draw);
  }
  return draws;
}

struct Errors {
  Spread force, moment;
};
Errors errors_of(const std::vector<Draw>& draws, BladeFidelity fidelity) {
  std::vector<double> force, moment;
  for (const Draw& draw : draws) {
    const auto wrenches = models::blade_wrench(scalpel(), friction, fidelity, draw.pose, draw.twist);
    force.push_back((wrenches.force - draw.exact.force).norm() / draw.exact.force.norm());
    moment.push_back((wrenches.moment - draw.exact.moment).norm() / draw.exact.moment.norm());
  }
  return {spread_of(force), spread_of(moment)};
}
std::string as_text(const Errors& errors) {
  return fmt::format("force off by {:.3g} % (median), {:.3g} % (95th percentile); torque {:.3g} %, {:.3g} %",
                     100.0 * errors.force.median, 100.0 * errors.force.high, 100.0 * errors.moment.median,
                     100.0 * errors.moment.high);
}

void approximations(Reproduction& paper, std::uint64_t seed) {
  const auto draws = draw_poses(seed, 2.0);
  Chart chart{.title = "Error of the approximations against `exact`, 2,000 poses and twists",
              .x_label = "strips a surface",
              .y_label = "error of the force [%]",
              .log_x = true,
              .log_y = true};
  for (const auto kind : {BladeFidelity::Kind::paper, BladeFidelity::Kind::strips}) {
    const bool of_paper = kind == BladeFidelity::Kind::paper;
    const std::string name = of_paper ? "paper" : "strips";
    Curve median{.label = name + ", median", .colour = of_paper ? Colour::vermillion : Colour::blue};
    Curve high{.label = name + ", 95 % of poses below", .colour = median.colour, .dashed = true};
    for (std::size_t n = 1; n <= 64; n *= 2) {
      const Spread force = errors_of(draws, {kind, n}).force;
      for (auto* curve : {&median, &high}) curve->x.push_back(static_cast<double>(n));
      median.y.push_back(100.0 * force.median);
      high.y.push_back(100.0 * force.high);
    }
    chart.curves.push_back(std::move(median));
    chart.curves.push_back(std::move(high));
  }
  chart.horizontal.push_back({.at = 7.0, .label = "JND of force"});
  paper.figures.push_back({"approximation_error", std::move(chart)});
  const auto slow = draw_poses(seed, 0.1);
  paper.answer(
      "What do the approximations cost? One velocity for the whole tool, 16 strips, turns up to 2 rad/s",
      "3.4, left open", as_text(errors_of(draws, {BladeFidelity::Kind::paper, 16})));
  paper.answer("The same, turns up to 0.1 rad/s", "3.4, left open",
               as_text(errors_of(slow, {BladeFidelity::Kind::paper, 16})));
  paper.answer("And with a velocity for each of 16 strips, turns up to 2 rad/s?", "3.4, left open",
               as_text(errors_of(draws, {BladeFidelity::Kind::strips, 16})));
}

void contact_and_states(Reproduction& paper, std::uint64_t seed) {
  const models::Precontact<double> printed{1000.0, 0.005, true};
  const models::Precontact<double> smooth{1000.0, 0.005, false};
  Chart chart{.title = "Elastic feedback before contact (eq. 2, fig. 4)",
              .x_label = "position before and past the surface [mm]",
              .y_label = "force [N]"};
  chart.vertical.push_back({.at = 0.0, .label = "surface"});
  for (const auto* law : {&printed, &smooth}) {
    Curve curve{.label = law->paper ? "paper" : "smooth",
                .colour = law->paper ? Colour::vermillion : Colour::blue};
    models::Precontact<double>::State none;
    for (double x = -7e-3; x < 6e-3; x += 5e-5) {
      curve.x.push_back(1e3 * x);
      curve.y.push_back(law->step(none, {x, 0.0}, period_s));
    }
    chart.curves.push_back(std::move(curve));
  }
  paper.figures.push_back({"precontact", std::move(chart)});
  models::Precontact<double>::State none;
  const auto slope = [&](const models::Precontact<double>& law, double x) {
    return (law.step(none, {x + 1e-7, 0.0}, period_s) - law.step(none, {x - 1e-7, 0.0}, period_s)) / 2e-7;
  };
  paper.answer(
      "Is eq. 2 smooth where the tool meets the surface?", "eq. 2",
      fmt::format(
          "as printed the slope falls from {:.2f} K to {:.2f} K there; `smooth` has {:.2f} K on both sides",
          slope(printed, -1e-6) / 1000.0, slope(printed, 1e-6) / 1000.0, slope(smooth, 1e-6) / 1000.0));
  const auto transitions = [&](models::TwoThresholds machine) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> noise(-0.09, 0.09);
    models::TwoThresholds::State state;
    for (int tick = 0; tick < 2000; ++tick) {
      (void)machine.step(state, (tick < 1000 ? 1e-3 * tick : 2.0 - 1e-3 * tick) + noise(random));
    }
    return state.transitions;
  };
  const auto apart = transitions({.release_n = 0.4, .rupture_n = 0.6});
  const auto equal = transitions({.release_n = 0.5, .rupture_n = 0.5});
  paper.add(
      "Two thresholds F0 < F1 keep the states from alternating", "3.5, fig. 7",
      fmt::format("under noise of +-0.09 N, up and down once: {} transitions with a gap of 0.2 N, {} without",
                  apart, equal),
      apart == 2 && equal > 2);
}

}  // namespace

Reproduction run(std::uint64_t seed) {
  Reproduction paper{
      .paper = "000", .key = "Henry2004", .title = "Haptic interaction of a blade with soft tissue"};
  cut_and_push(paper);
  turn(paper);
  approximations(paper, seed);
  contact_and_states(paper, seed);
  return paper;
}

}  // namespace kerf::bench::henry2004
