#include "kerf/drivers/simulated_pose6.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "kerf/mechanisms/angle.h"

namespace kerf::drivers {
namespace {

constexpr Mechanics translating{.mass_kg = 0.15, .viscous_n_s_per_m = 0.2, .coulomb_n = 0.05};
constexpr Mechanics turning{.mass_kg = 2.5e-4, .viscous_n_s_per_m = 1e-3, .coulomb_n = 1e-3};

/// What a hand of unit mass, damping and stiffness is to a rotation, so that a stylus grip turns with
/// 2.5e-4 kg·m^2, 0.02 N·m·s/rad and 1 N·m/rad [m^2].
constexpr double turning_mass_m2 = 2.5e-4 / 0.15;
constexpr double turning_damping_m2 = 0.02 / 5.0;
constexpr double turning_stiffness_m2 = 1.0 / 500.0;
constexpr double reach_of_tool_m = 0.2;
constexpr double turn_of_tool_rad = 2.0;
constexpr double fade_in_s = 1.0;

/// One of the hand's sines: its frequency and where it begins.
struct Sway {
  double frequency_hz;
  double phase_rad;
};
constexpr std::array<Sway, max_axes> sways{
    {{0.23, 0.0}, {0.31, 1.0}, {0.47, 2.0}, {0.29, 3.0}, {0.41, 4.0}, {0.59, 5.0}}};

AxisInfo translation(std::string name) {
  return {.name = std::move(name),
          .position_unit = "m",
          .force_unit = "N",
          .resolution = 0.03e-3,
          .lower = -reach_of_tool_m,
          .upper = reach_of_tool_m,
          .force_limit = 8.5,
          .slew_limit = 2000.0,
          .speed_limit = 5.0,
          .acceleration_limit = 500.0,
          .mechanics = translating};
}

AxisInfo rotation(std::string name) {
  return {.name = std::move(name),
          .position_unit = "rad",
          .force_unit = "N·m",
          .resolution = 0.8e-3,
          .lower = -turn_of_tool_rad,
          .upper = turn_of_tool_rad,
          .force_limit = 0.515,
          .slew_limit = 100.0,
          .speed_limit = 50.0,
          .acceleration_limit = 7000.0,
          .mechanics = turning};
}

std::string as_toml(const SimulatedPose6::Options& options) {
  std::ostringstream text;
  text << "model = \"sim:pose6\"\nseed = " << options.mechanism.seed
       << "\nhand = " << (options.with_hand ? "true" : "false")
       << "\nnoise = " << (options.mechanism.with_noise ? "true" : "false")
       << "\nencoder = " << (options.mechanism.with_encoder ? "true" : "false")
       << "\n\n[hand_motion]\nmass = { value = " << options.hand_mass_kg
       << ", unit = \"kg\" }\ndamping = { value = " << options.hand_damping_n_s_per_m
       << ", unit = \"N·s/m\" }\nstiffness = { value = " << options.hand_stiffness_n_per_m
       << ", unit = \"N/m\" }\n";
  if (options.path) {
    text << "path = \"" << to_text(options.path->keyframes)
         << "\"\nrepeat = " << (options.path->repeat ? "true" : "false") << "\n";
    return text.str();
  }
  text << "reach = { value = " << options.reach_m
       << ", unit = \"m\" }\nswing = { value = " << options.swing_rad << ", unit = \"rad\" }\n";
  return text.str();
}

void refuse_unreachable(const PosePath::Options& path) {
  (void)PosePath(path);  // which refuses keyframes out of order
  for (const PoseKeyframe& keyframe : path.keyframes) {
    for (std::size_t at = 0; at < max_axes; ++at) {
      const double range = at < 3 ? reach_of_tool_m : turn_of_tool_rad;
      if (std::abs(keyframe.position[at]) <= range) continue;
      std::ostringstream message;
      message << "device 'sim:pose6': the keyframe at " << keyframe.at_s << " s is out of its range of "
              << 1e3 * reach_of_tool_m << " mm and " << turn_of_tool_rad << " rad";
      throw DeviceError(message.str());
    }
  }
}

}  // namespace

SimulatedPose6::Options SimulatedPose6::parse_options(Uri uri) {
  const bool swaying = uri.options.contains("reach") || uri.options.contains("swing");
  UriOptions given(std::move(uri));
  Options options;
  options.mechanism = SimulatedMechanism::Options::from(given);
  options.with_hand = given.flag("hand", true);
  options.reach_m = given.number("reach", {"m", options.reach_m, 0.0, 0.15});
  options.swing_rad = given.number("swing", {"deg", options.swing_rad, 0.0, 90.0 * degree});
  options.hand_mass_kg = given.number("mass", {"kg", options.hand_mass_kg, 0.0, 5.0});
  options.hand_damping_n_s_per_m =
      given.number("damping", {"Ns/m", options.hand_damping_n_s_per_m, 0.0, 500.0});
  options.hand_stiffness_n_per_m = given.number("grip", {"N/m", options.hand_stiffness_n_per_m, 0.0, 5000.0});
  const bool repeat = given.flag("repeat", false);
  if (const auto path = given.text("path")) {
    if (swaying) throw DeviceError("device 'sim:pose6': 'path' is in place of 'reach' and 'swing'; give one");
    options.path = {.keyframes = parse_keyframes(*path), .repeat = repeat};
    refuse_unreachable(*options.path);
  } else if (repeat) {
    throw DeviceError("device 'sim:pose6': 'repeat' is for a 'path'");
  }
  given.allow("fault");
  given.refuse_others();
  return options;
}

SimulatedPose6::SimulatedPose6(std::string_view uri, const Options& options, Surroundings surroundings)
    : options_(options),
      path_(options.path ? std::optional<PosePath>(*options.path) : std::nullopt),
      mechanism_({.uri = std::string(uri),
                  .model = "sim:pose6",
                  .about = "a tool of six degrees of freedom in a hand, simulated",
                  .axes = {translation("x"), translation("y"), translation("z"), rotation("rx"),
                           rotation("ry"), rotation("rz")},
                  .measures_force = true,
                  .simulated = true,
                  .configuration = as_toml(options)},
                 options.mechanism, std::move(surroundings)) {
  for (std::size_t at = 0; at < max_axes; ++at) {
    SimulatedAxis& axis = mechanism_.axis(at);
    const bool turns = at >= 3;
    const Mechanics& tool = turns ? turning : translating;
    axis.mass_kg = tool.mass_kg;
    axis.viscous_n_s_per_m = tool.viscous_n_s_per_m;
    axis.coulomb_n = tool.coulomb_n;
    if (path_) mechanism_.place(at, path_->at(0.0).position[at]);
    if (!options.with_hand) continue;
    axis.mass_kg += options.hand_mass_kg * (turns ? turning_mass_m2 : 1.0);
    axis.hand_stiffness_n_per_m = options.hand_stiffness_n_per_m * (turns ? turning_stiffness_m2 : 1.0);
    axis.hand_damping_n_s_per_m = options.hand_damping_n_s_per_m * (turns ? turning_damping_m2 : 1.0);
  }
}

void SimulatedPose6::wish_at(double time_s, SimulatedMechanism::Equilibria& wish) const noexcept {
  if (!options_.with_hand) return;
  if (path_) {
    const PosePath::Equilibrium pose = path_->at(time_s);
    for (std::size_t at = 0; at < max_axes; ++at) {
      wish[at] = {.travel_m = pose.position[at], .speed_m_s = pose.velocity[at]};
    }
    return;
  }
  const double fade = std::min(1.0, time_s / fade_in_s);
  for (std::size_t at = 0; at < max_axes; ++at) {
    const double amplitude = fade * (at < 3 ? options_.reach_m : options_.swing_rad);
    const double rate = 2.0 * std::numbers::pi * sways[at].frequency_hz;
    const double angle = rate * time_s + sways[at].phase_rad;
    wish[at] = {.travel_m = amplitude * std::sin(angle), .speed_m_s = amplitude * rate * std::cos(angle)};
  }
}

Status SimulatedPose6::read(double now_s, Sample& sample) noexcept {
  mechanism_.run_until(
      now_s, [this](double time_s, SimulatedMechanism::Equilibria& wish) { wish_at(time_s, wish); });
  mechanism_.measure(now_s, sample);
  return Status::ok;
}

}  // namespace kerf::drivers
