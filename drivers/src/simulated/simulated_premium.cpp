#include "kerf/drivers/simulated_premium.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>

#include <Eigen/LU>

namespace kerf::drivers {
namespace {

using mechanisms::Premium;
using Vector = Premium::Vector;
using Matrix = Premium::Matrix;

constexpr double dt = SimulatedMechanism::sub_step_s;
constexpr double coulomb_n_m = 0.01;
constexpr double motor_limit_n_m = 0.129;
constexpr double counts_per_turn = 4000.0;
constexpr int sweeps = 8;  // the joints are so weakly coupled that each leaves a tenth of the error or less

AxisInfo joint(std::string name, std::size_t at) {
  const double ratio = Premium::gear_ratio[at];
  const Premium::Range& range = Premium::joint_range_rad[at];
  return {.name = std::move(name),
          .position_unit = "rad",
          .force_unit = "N·m",
          .resolution = 2.0 * std::numbers::pi / (counts_per_turn * ratio),
          .lower = range.lower,
          .upper = range.upper,
          .force_limit = motor_limit_n_m * ratio,
          .slew_limit = 400.0,
          .speed_limit = 25.0,
          .acceleration_limit = 2000.0};
}

/// Friction that stops each joint or, where it is too weak, takes what it can.
void rub(const Matrix& mobility, Vector& speed) noexcept {
  Vector impulse = Vector::Zero();
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (int at = 0; at < 3; ++at) {
      const double enough = impulse[at] - speed[at] / mobility(at, at);
      const double taken = std::clamp(enough, -dt * coulomb_n_m, dt * coulomb_n_m);
      speed += (taken - impulse[at]) * mobility.col(at);
      impulse[at] = taken;
    }
  }
}

/// Takes the speed that would carry an angle, or the fold between the arms, beyond its stop.
void stop(const Matrix& mobility, const Vector& q, Vector& speed) noexcept {
  const auto& range = Premium::joint_range_rad;
  const std::array<std::pair<Vector, Premium::Range>, 4> stops{
      {{Vector::UnitX(), range[0]},
       {Vector::UnitY(), range[1]},
       {Vector::UnitZ(), range[2]},
       {Vector(0.0, -1.0, 1.0), Premium::fold_range_rad}}};
  for (const auto& [direction, limits] : stops) {
    const double at = direction.dot(q);
    const double towards = direction.dot(speed);
    const double excess = towards - std::clamp(towards, (limits.lower - at) / dt, (limits.upper - at) / dt);
    if (excess == 0.0) continue;
    const Vector yielding = mobility * direction;
    speed -= excess / direction.dot(yielding) * yielding;
  }
}

std::string as_toml(const SimulatedPremium::Options& options) {
  const auto word = [](bool value) { return value ? "true" : "false"; };
  std::ostringstream text;
  text << "model = \"sim:premium\"\nseed = " << options.mechanism.seed
       << "\nhand = " << word(options.with_hand) << "\nnoise = " << word(options.mechanism.with_noise)
       << "\nencoder = " << word(options.mechanism.with_encoder)
       << "\nfriction = " << word(options.with_friction) << "\ngravity = " << word(options.arm.with_gravity)
       << "\npayload = { value = " << options.arm.payload_kg
       << ", unit = \"kg\" }\n\n[hand_motion]\nstroke = { value = " << options.path.stroke_s
       << ", unit = \"s\" }\npause = { value = " << options.path.pause_s
       << ", unit = \"s\" }\nmass = { value = " << options.hand_mass_kg
       << ", unit = \"kg\" }\ndamping = { value = " << options.hand_damping_n_s_per_m
       << ", unit = \"N·s/m\" }\nstiffness = { value = " << options.hand_stiffness_n_per_m
       << ", unit = \"N/m\" }\n";
  if (options.path.waypoints_m.empty()) {
    text << "reach = { value = " << options.reach_m << ", unit = \"m\" }\n";
    return text.str();
  }
  text << "path = { value = [";
  for (const Vector& place : options.path.waypoints_m) {
    text << "[" << place[0] << ", " << place[1] << ", " << place[2] << "], ";
  }
  text << "], unit = \"m\" }\n";
  return text.str();
}

Premium::Options with_hand_at_tip(const SimulatedPremium::Options& options) {
  Premium::Options arm = options.arm;
  if (options.with_hand) arm.payload_kg += options.hand_mass_kg;
  return arm;
}

TipPath::Options with_waypoints(const SimulatedPremium::Options& options) {
  TipPath::Options path = options.path;
  if (path.waypoints_m.empty()) path.waypoints_m = drawn_waypoints(options.mechanism.seed, options.reach_m);
  for (const Vector& place : path.waypoints_m) {
    if (Premium::joint_angles(place)) continue;
    std::ostringstream message;
    message << "device 'sim:premium': its tip cannot be at " << 1e3 * place[0] << ":" << 1e3 * place[1] << ":"
            << 1e3 * place[2] << "mm; waypoints within 40 mm of 0:0:0mm are safe";
    throw DeviceError(message.str());
  }
  return path;
}

}  // namespace

SimulatedPremium::Options SimulatedPremium::parse_options(Uri uri) {
  UriOptions given(std::move(uri));
  Options options;
  options.mechanism = SimulatedMechanism::Options::from(given);
  options.with_hand = given.flag("hand", true);
  options.with_friction = given.flag("friction", true);
  options.arm.with_gravity = given.flag("gravity", true);
  options.arm.payload_kg = given.number("payload", {"kg", 0.0, 0.0, 1.0});
  if (const auto path = given.text("path")) options.path.waypoints_m = parse_waypoints(*path);
  options.reach_m = given.number("reach", {"m", options.reach_m, 0.0, 0.06});
  options.path.stroke_s = given.number("stroke", {"s", options.path.stroke_s, 0.05, 100.0});
  options.path.pause_s = given.number("pause", {"s", options.path.pause_s, 0.0, 100.0});
  options.hand_mass_kg = given.number("mass", {"kg", options.hand_mass_kg, 0.0, 5.0});
  options.hand_damping_n_s_per_m =
      given.number("damping", {"Ns/m", options.hand_damping_n_s_per_m, 0.0, 500.0});
  options.hand_stiffness_n_per_m = given.number("grip", {"N/m", options.hand_stiffness_n_per_m, 0.0, 5000.0});
  given.allow("fault");
  given.refuse_others();
  return options;
}

SimulatedPremium::SimulatedPremium(std::string_view uri, const Options& options, Surroundings surroundings)
    : options_(options),
      arm_(with_hand_at_tip(options)),
      path_(with_waypoints(options)),
      mechanism_({.uri = std::string(uri),
                  .model = "sim:premium",
                  .about = "a Phantom Premium 1.5 of three joints with a hand at its tip, simulated",
                  .axes = {joint("q1", 0), joint("q2", 1), joint("q3", 2)},
                  .channels = {{"tip_x", "m"}, {"tip_y", "m"}, {"tip_z", "m"}},
                  .measures_force = true,
                  .simulated = true,
                  .configuration = as_toml(options)},
                 options.mechanism, std::move(surroundings)) {
  const Vector begin = *Premium::joint_angles(path_.options().waypoints_m.front());
  for (std::size_t at = 0; at < 3; ++at) mechanism_.place(at, begin[static_cast<int>(at)]);
}

void SimulatedPremium::move(double time_s, SimulatedMechanism::States& states,
                            const Axes& force) const noexcept {
  const Vector q(states[0].travel_m, states[1].travel_m, states[2].travel_m);
  const Vector before(states[0].speed_m_s, states[1].speed_m_s, states[2].speed_m_s);
  const Premium::Dynamics now = arm_.dynamics(q, before);
  Matrix inertia = now.inertia + dt * now.coriolis;
  Vector impulse = now.inertia * before + dt * (Vector(force[0], force[1], force[2]) - now.gravity);
  if (options_.with_hand) {
    const double stiffness = options_.hand_stiffness_n_per_m;
    const double damping = options_.hand_damping_n_s_per_m;
    const TipPath::Equilibrium wish = path_.at(time_s);
    Vector pull = stiffness * (wish.position_m - now.tip) + damping * wish.speed_m_s;
    if (options_.arm.with_gravity) pull[1] += options_.hand_mass_kg * Premium::gravity_m_s2;
    inertia += dt * (damping + dt * stiffness) * now.jacobian.transpose() * now.jacobian;
    impulse += dt * now.jacobian.transpose() * pull;
  }
  if (options_.with_friction) inertia.diagonal().array() += dt * SimulatedPremium::viscous_n_m_s;
  const Matrix mobility = inertia.inverse();
  Vector speed = mobility * impulse;
  if (options_.with_friction) rub(mobility, speed);
  stop(mobility, q, speed);
  for (std::size_t at = 0; at < 3; ++at) {
    const Premium::Range& range = Premium::joint_range_rad[at];
    const double moved = speed[static_cast<int>(at)];
    states[at] = {.travel_m = std::clamp(states[at].travel_m + dt * moved, range.lower, range.upper),
                  .speed_m_s = moved};
  }
}

Status SimulatedPremium::read(double now_s, Sample& sample) noexcept {
  mechanism_.run_coupled_until(now_s, [this](double time_s, SimulatedMechanism::States& states,
                                             const Axes& force) { move(time_s, states, force); });
  mechanism_.measure(now_s, sample);
  const Vector tip = Premium::tip({sample.position[0], sample.position[1], sample.position[2]});
  std::copy_n(tip.data(), 3, sample.channels.begin());
  return Status::ok;
}

}  // namespace kerf::drivers
