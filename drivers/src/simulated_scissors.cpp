#include "kerf/drivers/simulated_scissors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>

namespace kerf::drivers {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double handle_inertia_kg_m2 = 2e-5;
constexpr double carriage_kg = 0.4;
constexpr double sensor_noise_n = 0.02;
constexpr double sensor_step_n = 0.002;
constexpr double never = std::numeric_limits<double>::infinity();
constexpr double velocity_corner_rad_s = 2.0 * std::numbers::pi * 20.0;

double rounded_to(double value, double step) noexcept {
  return step > 0.0 ? step * std::round(value / step) : value;
}

std::vector<AxisInfo> scissors_axes() {
  return {{.name = "theta",
           .position_unit = "rad",
           .force_unit = "N",
           .lever = SimulatedScissors::lever_m,
           .resolution = 0.056 * degree,
           .lower = 0.0,
           .upper = 60.0 * degree,
           .force_limit = 7.58,
           .slew_limit = 2000.0,
           .speed_limit = 50.0},
          {.name = "x_s",
           .position_unit = "m",
           .force_unit = "N",
           .lever = 1.0,
           .resolution = 0.0152e-3,
           .lower = -0.05,
           .upper = 0.05,
           .force_limit = 159.0,
           .slew_limit = 20000.0,
           .speed_limit = 5.0}};
}

std::string as_toml(const SimulatedScissors::Options& options) {
  std::ostringstream text;
  text << "model = \"sim:scissors\"\nseed = " << options.seed
       << "\nhand = " << (options.with_hand ? "true" : "false")
       << "\nnoise = " << (options.with_noise ? "true" : "false")
       << "\nencoder = " << (options.with_encoder ? "true" : "false")
       << "\n\n[hand_motion]\nopen = { value = " << options.hand.open_rad
       << ", unit = \"rad\" }\nclose = { value = " << options.hand.close_rad
       << ", unit = \"rad\" }\nstroke = { value = " << options.hand.stroke_s
       << ", unit = \"s\" }\npause = { value = " << options.hand.pause_s
       << ", unit = \"s\" }\nvariation = " << options.hand.variation
       << "\nmass = { value = " << options.hand.mass_kg
       << ", unit = \"kg\" }\ndamping = { value = " << options.hand.damping_n_s_per_m
       << ", unit = \"N·s/m\" }\nstiffness = { value = " << options.hand.stiffness_n_per_m
       << ", unit = \"N/m\" }\n";
  return text.str();
}

}  // namespace

SimulatedScissors::Options SimulatedScissors::parse_options(Uri uri) {
  UriOptions given(std::move(uri));
  Options options;
  options.seed = given.count("seed", 1);
  options.with_hand = given.flag("hand", true);
  options.with_noise = given.flag("noise", true);
  options.with_encoder = given.flag("encoder", true);
  HandOptions& hand = options.hand;
  hand.seed = options.seed;
  hand.open_rad = given.number("open", {"deg", hand.open_rad, 1.0 * degree, 60.0 * degree});
  hand.close_rad = given.number("close", {"deg", hand.close_rad, -20.0 * degree, 59.0 * degree});
  hand.stroke_s = given.number("stroke", {"s", hand.stroke_s, 0.05, 100.0});
  hand.pause_s = given.number("pause", {"s", hand.pause_s, 0.0, 100.0});
  hand.variation = given.number("variation", {"1", hand.variation, 0.0, 0.3});
  hand.stiffness_n_per_m = given.number("grip", {"N/m", hand.stiffness_n_per_m, 0.0, 5000.0});
  given.allow("fault");
  given.refuse_others();
  if (hand.close_rad >= hand.open_rad) {
    throw DeviceError("device 'sim:scissors': option 'close' must be a smaller angle than 'open'");
  }
  return options;
}

SimulatedScissors::SimulatedScissors(std::string_view uri, const Options& options, Surroundings surroundings)
    : options_(options),
      surroundings_(std::move(surroundings)),
      strokes_(options.hand),
      noise_(options.seed),
      released_at_s_(never) {
  info_ = {.uri = std::string(uri),
           .model = "sim:scissors",
           .about = "haptic scissors of two degrees of freedom with a hand on them, simulated",
           .axes = scissors_axes(),
           .measures_force = true,
           .simulated = true,
           .configuration = as_toml(options)};
  const double hand_mass = options.with_hand ? options.hand.mass_kg : 0.0;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const AxisInfo& about = info_.axes[axis];
    axes_[axis].mass_kg = (axis == 0 ? handle_inertia_kg_m2 / (lever_m * lever_m) : carriage_kg) + hand_mass;
    axes_[axis].lower_m = about.lower * about.lever;
    axes_[axis].upper_m = about.upper * about.lever;
    if (!options.with_hand) continue;
    axes_[axis].hand_stiffness_n_per_m = options.hand.stiffness_n_per_m;
    axes_[axis].hand_damping_n_s_per_m = options.hand.damping_n_s_per_m;
  }
  states_[0].travel_m = options.hand.open_rad * lever_m;
}

void SimulatedScissors::step() noexcept {
  const double time_s = static_cast<double>(++steps_) * sub_step_s;
  const bool released = time_s > released_at_s_.load(std::memory_order_relaxed);
  const Strokes::Equilibrium wish = options_.with_hand ? strokes_.at(time_s) : Strokes::Equilibrium{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double lever = info_.axes[axis].lever;
    SimulatedAxis::State& state = states_[axis];
    axes_[axis].step(state,
                     {.equilibrium_m = axis == 0 ? wish.angle_rad * lever : 0.0,
                      .equilibrium_speed_m_s = axis == 0 ? wish.speed_rad_s * lever : 0.0,
                      .force_n = (released ? 0.0 : command_[axis]) + tissue_force_[axis]},
                     sub_step_s);
    // After the move, so that the sensor and the encoder speak of the same moment.
    if (const Tissue& tissue = surroundings_.tissue[axis]) {
      tissue_force_[axis] = tissue(state.travel_m / lever, state.speed_m_s / lever, sub_step_s);
    }
  }
}

void SimulatedScissors::measure(double elapsed_s, Sample& sample) noexcept {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const AxisInfo& about = info_.axes[axis];
    const double position =
        rounded_to(states_[axis].travel_m / about.lever, options_.with_encoder ? about.resolution : 0.0);
    if (was_read_ && elapsed_s > 0.0) {
      const double difference = (position - last_position_[axis]) / elapsed_s;
      velocity_[axis] += -std::expm1(-velocity_corner_rad_s * elapsed_s) * (difference - velocity_[axis]);
    }
    last_position_[axis] = position;
    sample.position[axis] = position;
    sample.velocity[axis] = velocity_[axis];
    sample.force_measured[axis] =
        options_.with_noise ? rounded_to(tissue_force_[axis] + sensor_noise_n * noise_(), sensor_step_n)
                            : tissue_force_[axis];
  }
  was_read_ = true;
}

Status SimulatedScissors::read(double now_s, Sample& sample) noexcept {
  const auto target = static_cast<std::uint64_t>(std::llround(std::max(0.0, now_s) / sub_step_s));
  while (steps_ < target) step();
  measure(now_s - last_read_s_, sample);
  last_read_s_ = now_s;
  return Status::ok;
}

Status SimulatedScissors::write(const Axes& force) noexcept {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (!std::isfinite(force[axis])) {
      command_ = {};
      return Status::fault;
    }
    const double limit = info_.axes[axis].force_limit;
    command_[axis] = std::clamp(force[axis], -limit, limit);
  }
  released_at_s_.store(never, std::memory_order_relaxed);
  return Status::ok;
}

void SimulatedScissors::release(double at_s) noexcept {
  double expected = never;
  released_at_s_.compare_exchange_strong(expected, at_s, std::memory_order_relaxed);
}

}  // namespace kerf::drivers
