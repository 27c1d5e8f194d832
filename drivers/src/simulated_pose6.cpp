#include "kerf/drivers/simulated_pose6.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

namespace kerf::drivers {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double tool_and_hand_kg = 0.3;
constexpr double tool_and_hand_kg_m2 = 5e-4;
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
          .lower = -0.2,
          .upper = 0.2,
          .force_limit = 8.5,
          .slew_limit = 2000.0,
          .speed_limit = 5.0};
}

AxisInfo rotation(std::string name) {
  return {.name = std::move(name),
          .position_unit = "rad",
          .force_unit = "N·m",
          .resolution = 0.8e-3,
          .lower = -2.0,
          .upper = 2.0,
          .force_limit = 0.515,
          .slew_limit = 100.0,
          .speed_limit = 50.0};
}

std::string as_toml(const SimulatedPose6::Options& options) {
  std::ostringstream text;
  text << "model = \"sim:pose6\"\nseed = " << options.mechanism.seed
       << "\nhand = " << (options.with_hand ? "true" : "false")
       << "\nnoise = " << (options.mechanism.with_noise ? "true" : "false")
       << "\nencoder = " << (options.mechanism.with_encoder ? "true" : "false")
       << "\n\n[hand_motion]\nreach = { value = " << options.reach_m
       << ", unit = \"m\" }\nswing = { value = " << options.swing_rad << ", unit = \"rad\" }\n";
  return text.str();
}

}  // namespace

SimulatedPose6::Options SimulatedPose6::parse_options(Uri uri) {
  UriOptions given(std::move(uri));
  Options options;
  options.mechanism = SimulatedMechanism::Options::from(given);
  options.with_hand = given.flag("hand", true);
  options.reach_m = given.number("reach", {"m", options.reach_m, 0.0, 0.15});
  options.swing_rad = given.number("swing", {"deg", options.swing_rad, 0.0, 90.0 * degree});
  given.allow("fault");
  given.refuse_others();
  return options;
}

SimulatedPose6::SimulatedPose6(std::string_view uri, const Options& options, Surroundings surroundings)
    : options_(options),
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
    axis.mass_kg = turns ? tool_and_hand_kg_m2 : tool_and_hand_kg;
    axis.viscous_n_s_per_m = turns ? 1e-3 : 0.2;
    axis.coulomb_n = turns ? 1e-3 : 0.05;
    if (!options.with_hand) continue;
    axis.hand_stiffness_n_per_m = turns ? 1.0 : 500.0;
    axis.hand_damping_n_s_per_m = turns ? 0.02 : 5.0;
  }
}

Status SimulatedPose6::read(double now_s, Sample& sample) noexcept {
  mechanism_.run_until(now_s, [this](double time_s, SimulatedMechanism::Equilibria& wish) {
    if (!options_.with_hand) return;
    const double fade = std::min(1.0, time_s / fade_in_s);
    for (std::size_t at = 0; at < max_axes; ++at) {
      const double amplitude = fade * (at < 3 ? options_.reach_m : options_.swing_rad);
      const double rate = 2.0 * std::numbers::pi * sways[at].frequency_hz;
      const double angle = rate * time_s + sways[at].phase_rad;
      wish[at] = {.travel_m = amplitude * std::sin(angle), .speed_m_s = amplitude * rate * std::cos(angle)};
    }
  });
  mechanism_.measure(now_s, sample);
  return Status::ok;
}

}  // namespace kerf::drivers
