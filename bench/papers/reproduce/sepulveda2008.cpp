#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include <Eigen/LU>
#include <fmt/core.h>

#include <kerf/drivers/device.h>
#include <kerf/drivers/hand.h>
#include <kerf/models/fracture.h>
#include <kerf/models/orthogonal.h>

#include "reproduce/reproduce.h"

namespace kerf::bench::sepulveda2008 {
namespace {

using Eigen::Vector3d;
using models::Projection;
using Mode = models::Fracture<double>::Mode;

constexpr double period_s = 1e-3;
constexpr double surface_height_m = 0.09;
constexpr double yield_energy_j = 0.0153846120769;  // stored at 2 N by the in vivo law
constexpr double toughness_j_m2 = 2000.0;
constexpr double slow_m_s = 1e-3;  // so slow that the viscosity adds 20 mN at most
constexpr double width_m = 1e-3;   // with it Jc w = 2 N; [Sepulveda2008] gives the product alone

/// A closed loop of the simulated Premium, a hand that follows waypoints, and the law.
struct Experiment {
  std::vector<double> time_s, height_mm, phi_rate, force_n, tangential_n;
  std::vector<Vector3d> tip;
  std::vector<Mode> mode;
  double tangential_power_w = 0.0;  ///< largest that the tangential part ever gave
  /// Force that the other loop adds to the normal one, root mean square and largest [N], of each projection.
  double coupling_rms_n[2] = {0.0, 0.0};
  double coupling_max_n[2] = {0.0, 0.0};
  std::size_t contact_ticks = 0;
};

models::Orthogonal rendering(bool cutting, double tangential_damping) {
  std::vector<double> values{4.3e-7, 13.0, 20.0, tangential_damping};
  models::Options options{{"point", fmt::format("0 {} 0", surface_height_m)}};
  if (cutting) {
    values.insert(values.end(), {yield_energy_j, toughness_j_m2, width_m});
    options["interaction"] = std::string("cutting");
  }
  return models::Orthogonal::make(values, options);
}

/// What the tangential loop does to the normal one: phi'' as it is, against (J H^-1 J^T)(-lambda_d), as a
/// force.
double coupling_n(const models::SurfaceContact& contact, const mechanisms::Premium& arm,
                  const mechanisms::Premium::Dynamics& at, const Vector3d& q, const Vector3d& qd,
                  Projection projection, double lambda_d, double b1) {
  const Vector3d torque = models::orthogonal_torque(contact, at, qd, projection, lambda_d, b1);
  const double acceleration =
      contact.jacobian.dot(arm.acceleration(q, qd, torque)) + contact.jacobian_rate.dot(qd);
  const double mobility = contact.jacobian * at.inertia.inverse() * contact.jacobian.transpose();
  return (acceleration + mobility * lambda_d) / mobility;
}

/// Waypoints of the tip [m], reached by strokes of 1.5 s with 0.5 s of rest between.
using Waypoints = std::vector<Vector3d>;
constexpr double stroke_s = 1.5;
constexpr double leg_s = 2.0;

/// Moves the joints so that the tip follows the waypoints exactly: a scripted trajectory.
class Script {
 public:
  explicit Script(Waypoints path) : path_(std::move(path)) {}

  drivers::Sample at(double now_s) {
    const auto leg = std::min(static_cast<std::size_t>(now_s / leg_s), path_.size() - 2);
    const Vector3d chord = path_[leg + 1] - path_[leg];
    const auto stroke = drivers::MinimumJerk::at((now_s - leg_s * static_cast<double>(leg)) / stroke_s);
    const auto q = mechanisms::Premium::joint_angles(path_[leg] + stroke.position * chord);
    if (!q) throw std::runtime_error("a waypoint is out of the arm's reach");
    const Vector3d qd = mechanisms::Premium::jacobian(*q).inverse() * (stroke.speed / stroke_s * chord);
    drivers::Sample sample;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      sample.position[static_cast<std::size_t>(axis)] = (*q)[axis];
      sample.velocity[static_cast<std::size_t>(axis)] = qd[axis];
    }
    return sample;
  }
  void apply(const drivers::Axes&) {}

 private:
  Waypoints path_;
};

/// A hand of 1500 N/m that pulls the simulated arm along the waypoints, and feels what is rendered.
class Hand {
 public:
  Hand(const Waypoints& path, std::uint64_t seed) {
    std::string uri = fmt::format("sim:premium?seed={}&stroke={}s&pause={}s&grip=1500N/m&path=", seed,
                                  stroke_s, leg_s - stroke_s);
    for (std::size_t i = 0; i < path.size(); ++i) {
      const Vector3d mm = 1e3 * path[i];
      uri += fmt::format("{}{:g}:{:g}:{:g}mm", i ? "," : "", mm.x(), mm.y(), mm.z());
    }
    device_ = drivers::open_device(uri);
  }
  drivers::Sample at(double now_s) {
    drivers::Sample sample;
    (void)device_->read(now_s, sample);
    return sample;
  }
  void apply(const drivers::Axes& torque) { (void)device_->write(torque); }

 private:
  std::unique_ptr<drivers::Device> device_;
};

template <typename Mover>
Experiment run(Mover&& mover, bool cutting, double b1, double seconds) {
  const models::Orthogonal law = rendering(cutting, b1);
  const models::Plane plane{.point = {0.0, surface_height_m, 0.0}, .normal = Vector3d::UnitY()};
  models::Orthogonal::State state;
  Experiment all;
  for (int tick = 0; tick < static_cast<int>(seconds / period_s); ++tick) {
    const drivers::Sample sample = mover.at(period_s * tick);
    models::SpatialMotion motion;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      motion.position[axis] = sample.position[axis];
      motion.velocity[axis] = sample.velocity[axis];
    }
    const models::AxisValues torque = law.step(state, motion, period_s);
    mover.apply({torque[0], torque[1], torque[2]});
    const Vector3d q(sample.position[0], sample.position[1], sample.position[2]);
    const Vector3d qd(sample.velocity[0], sample.velocity[1], sample.velocity[2]);
    const auto at = law.device.dynamics(q, qd);
    const auto contact = models::contact_with(plane, at, q, qd);
    all.time_s.push_back(period_s * tick);
    all.height_mm.push_back(1e3 * contact.phi);
    all.force_n.push_back(state.normal_force);
    all.phi_rate.push_back(contact.phi_rate);
    all.tip.push_back(at.tip);
    all.mode.push_back(state.fracture.mode);
    double tangential_n = 0.0;
    if (contact.phi < 0.0) {
      const double lambda_d = -state.normal_force;
      const Vector3d with = models::orthogonal_torque(contact, at, qd, Projection::consistent, lambda_d, b1);
      const Vector3d without =
          models::orthogonal_torque(contact, at, qd, Projection::consistent, lambda_d, 0.0);
      Vector3d along = at.jacobian.transpose().inverse() * (with - without);
      along.y() = 0.0;
      tangential_n = along.norm();
      all.tangential_power_w = std::max(all.tangential_power_w, qd.dot(with - without));
      ++all.contact_ticks;
      for (const auto projection : {Projection::paper, Projection::consistent}) {
        const auto i = static_cast<std::size_t>(projection);
        const double force = coupling_n(contact, law.device, at, q, qd, projection, lambda_d, b1);
        all.coupling_rms_n[i] += force * force;
        all.coupling_max_n[i] = std::max(all.coupling_max_n[i], std::abs(force));
      }
    }
    all.tangential_n.push_back(tangential_n);
  }
  for (double& square : all.coupling_rms_n)
    square = std::sqrt(square / static_cast<double>(std::max<std::size_t>(all.contact_ticks, 1)));
  return all;
}

Chart manifold_and_force(const Experiment& at, const std::string& title) {
  Chart chart{.title = title, .x_label = "time [s]", .y_label = "height [dm], force [N]"};
  Curve height{.label = "object manifold phi [dm]", .x = at.time_s, .colour = Colour::grey, .dashed = true};
  for (const double mm : at.height_mm) height.y.push_back(0.01 * mm);
  chart.curves.push_back(std::move(height));
  chart.curves.push_back(
      {.label = "normal force [N]", .x = at.time_s, .y = at.force_n, .colour = Colour::blue});
  chart.curves.push_back({.label = "tangential friction [N]",
                          .x = at.time_s,
                          .y = at.tangential_n,
                          .colour = Colour::vermillion});
  return chart;
}

const Waypoints experiment_1{{0.0, 0.1, 0.0},      {0.0, -0.015, 0.0},  {0.03, -0.015, 0.0},
                             {-0.03, -0.015, 0.0}, {0.0, -0.015, 0.03}, {0.0, -0.015, -0.03},
                             {0.0, 0.1, 0.0}};
const Waypoints experiment_2{{0.0, 0.1, 0.0},  {0.03, 0.1, 0.0},   {0.0, 0.1, 0.0},
                             {0.0, 0.1, 0.03}, {0.0, -0.045, 0.0}, {0.0, 0.1, 0.0}};

void deformation(Reproduction& paper, std::uint64_t seed) {
  const Experiment at = run(Script(experiment_1), false, 0.06, 13.0);
  const Experiment felt = run(Hand(experiment_1, seed), false, 0.06, 13.0);
  paper.figures.push_back(
      {"experiment_1", manifold_and_force(at, "Experiment 1: deformation with tangent friction (fig. 5)")});
  bool only_inside = true;
  double worst = 0.0;
  double deepest = 0.0;
  for (std::size_t i = 0; i < at.time_s.size(); ++i) {
    const double depth = -1e-3 * at.height_mm[i];
    if (depth <= 0.0) only_inside = only_inside && at.force_n[i] == 0.0 && at.tangential_n[i] == 0.0;
    if (depth > 0.0 && std::abs(at.phi_rate[i]) < slow_m_s) {
      worst = std::max(worst, std::abs(at.force_n[i] - 4.3e-7 * std::exp(13.0 * depth / 0.1)));
    }
    deepest = std::max(deepest, depth);
  }
  paper.add("The normal force grows exponentially with the depth, and there is none outside", "6, fig. 5",
            fmt::format("down to {:.0f} mm and {:.2f} N with the viscosity; slower than 1 mm/s off eq. 11 by "
                        "{:.0f} mN at most; zero outside",
                        1e3 * deepest, *std::max_element(at.force_n.begin(), at.force_n.end()), 1e3 * worst),
            only_inside && worst < 0.021);
  paper.answer(
      "What is B0 = 20, taken as N·s/m?", "6, no unit given",
      fmt::format(
          "most of the force at the speed of a hand: up to {:.1f} N on the way in, and a pull of {:.1f} N "
          "on the way out, of {:.2f} N of deformation",
          *std::max_element(at.force_n.begin(), at.force_n.end()),
          -*std::min_element(at.force_n.begin(), at.force_n.end()), 4.3e-7 * std::exp(13.0 * deepest / 0.1)));
  const double friction = *std::max_element(at.tangential_n.begin(), at.tangential_n.end());
  paper.add(
      "Tangent friction acts along the surface while in contact", "6, fig. 5",
      fmt::format("up to {:.2f} N; it never gives power (at most {:.1g} W)", friction, at.tangential_power_w),
      friction > 0.1 && at.tangential_power_w < 1e-9);
  paper.add("Normal and tangent are two decoupled loops (`paper` projection)", "4, eqs. 5-10",
            fmt::format("in closed loop with a hand, with `paper` the tangent pushes the normal by {:.1f} mN "
                        "rms, {:.1f} mN at most",
                        1e3 * felt.coupling_rms_n[0], 1e3 * felt.coupling_max_n[0]),
            felt.coupling_max_n[0] < 1e-6);
  paper.add("Normal and tangent are two decoupled loops (`consistent` projection)", "4, eqs. 5-10",
            fmt::format("with `consistent` by {:.1g} N at most, in the same motion", felt.coupling_max_n[1]),
            felt.coupling_max_n[1] < 1e-6);
}

void cutting(Reproduction& paper, std::uint64_t seed) {
  const Experiment at = run(Script(experiment_2), true, 0.0, 11.0);
  paper.figures.push_back(
      {"experiment_2", manifold_and_force(at, "Experiment 2: cutting without tangent friction (fig. 6)")});
  const auto count = [&](Mode mode) { return std::count(at.mode.begin(), at.mode.end(), mode); };
  const auto fracture =
      static_cast<std::size_t>(std::find(at.mode.begin(), at.mode.end(), Mode::fracture) - at.mode.begin());
  if (fracture == at.mode.size()) {
    paper.add("The tissue yields and is cut", "6, fig. 7", "the hand never reached the yield point", false);
    return;
  }
  Chart chart{
      .title = "Deformation, fracture, cutting (fig. 7)", .x_label = "time [s]", .y_label = "force [N]"};
  Curve force{.label = "reaction force", .colour = Colour::blue, .mark = Mark::steps};
  std::size_t end = fracture + 1;
  while (end < at.mode.size() && at.mode[end] == Mode::cutting) ++end;
  const std::size_t from = fracture > 300 ? fracture - 300 : 0;
  for (std::size_t i = from; i < std::min(end + 150, at.mode.size()); ++i) {
    force.x.push_back(at.time_s[i]);
    force.y.push_back(at.force_n[i]);
  }
  chart.curves.push_back(std::move(force));
  chart.vertical.push_back({.at = at.time_s[fracture], .label = "fracture"});
  paper.figures.push_back({"fracture", std::move(chart)});
  paper.add(
      "Fracture lasts one sample of 1 ms", "6, fig. 7",
      fmt::format("{} sample of fracture with {:.0f} N, at {:.3f} s after {:.2f} N of deformation",
                  count(Mode::fracture), at.force_n[fracture], at.time_s[fracture], at.force_n[fracture - 1]),
      count(Mode::fracture) == 1 && at.force_n[fracture] == 0.0);
  bool two_newtons = true;
  for (std::size_t i = fracture + 1; i < end; ++i)
    two_newtons = two_newtons && (std::abs(at.force_n[i] - 2.0) < 1e-12 || at.force_n[i] == 0.0);
  paper.add("Cutting is felt as a constant 2 N", "6, fig. 7",
            fmt::format("{} samples of cutting at {:.3f} N", end - fracture - 1, at.force_n[fracture + 1]),
            two_newtons && end - fracture > 10);
  double after = 0.0;
  for (std::size_t i = end; i < std::min(end + 100, at.mode.size()); ++i) {
    after = std::max(after, at.force_n[i]);
  }
  paper.add("Then the force is zero", "6, fig. 7",
            fmt::format("at most {:.1g} N in the 100 samples after it", after), after < 1e-5);
  const Experiment felt = run(Hand(experiment_2, seed), true, 0.0, 11.0);
  const auto last = std::find(felt.mode.rbegin(), felt.mode.rend(), Mode::cutting).base() - felt.mode.begin();
  double met = 0.0;
  for (auto i = static_cast<std::size_t>(last);
       i < std::min<std::size_t>(static_cast<std::size_t>(last) + 100, felt.mode.size()); ++i) {
    met = std::max(met, felt.force_n[i]);
  }
  paper.answer(
      "And in closed loop, when the cut ends?", "not in the paper",
      fmt::format(
          "a hand of 1500 N/m that pushed with 2 N springs forward into the tip of the crack, and meets "
          "{:.1f} N of viscosity",
          met));
}

}  // namespace

Reproduction run(std::uint64_t seed) {
  Reproduction paper{
      .paper = "001", .key = "Sepulveda2008", .title = "Orthogonal decomposition on a 3-DOF haptic device"};
  deformation(paper, seed);
  cutting(paper, seed);
  return paper;
}

}  // namespace kerf::bench::sepulveda2008
