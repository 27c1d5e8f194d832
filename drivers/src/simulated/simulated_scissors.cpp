#include "kerf/drivers/simulated_scissors.h"

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "kerf/mechanisms/angle.h"

namespace kerf::drivers {
namespace {

constexpr double handle_inertia_kg_m2 = 2e-5;
constexpr double carriage_kg = 0.4;
constexpr double viscous_n_s_per_m = 0.2;
constexpr double coulomb_n = 0.1;

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
           .speed_limit = 50.0,
           .acceleration_limit = 20'000.0,
           .mechanics = Mechanics{.mass_kg = handle_inertia_kg_m2 /
                                             (SimulatedScissors::lever_m * SimulatedScissors::lever_m),
                                  .viscous_n_s_per_m = viscous_n_s_per_m,
                                  .coulomb_n = coulomb_n}},
          {.name = "x_s",
           .position_unit = "m",
           .force_unit = "N",
           .lever = 1.0,
           .resolution = 0.0152e-3,
           .lower = -0.05,
           .upper = 0.05,
           .force_limit = 159.0,
           .slew_limit = 20000.0,
           .speed_limit = 5.0,
           .acceleration_limit = 600.0,
           .mechanics = Mechanics{
               .mass_kg = carriage_kg, .viscous_n_s_per_m = viscous_n_s_per_m, .coulomb_n = coulomb_n}}};
}

const char* name_of(SimulatedScissors::Options::Motion motion) {
  using Motion = SimulatedScissors::Options::Motion;
  return motion == Motion::drawn ? "drawn" : motion == Motion::strokes ? "strokes" : "sine";
}

std::string as_toml(const SimulatedScissors::Options& options) {
  std::ostringstream text;
  text << "model = \"sim:scissors\"\nseed = " << options.mechanism.seed
       << "\nhand = " << (options.with_hand ? "true" : "false")
       << "\nnoise = " << (options.mechanism.with_noise ? "true" : "false")
       << "\nencoder = " << (options.mechanism.with_encoder ? "true" : "false")
       << "\n\n[hand_motion]\nopen = { value = " << options.hand.open_rad
       << ", unit = \"rad\" }\nclose = { value = " << options.hand.close_rad
       << ", unit = \"rad\" }\nstroke = { value = " << options.hand.stroke_s
       << ", unit = \"s\" }\npause = { value = " << options.hand.pause_s
       << ", unit = \"s\" }\nvariation = " << options.hand.variation
       << (options.motion == SimulatedScissors::Options::Motion::drawn
               ? ""
               : std::string("\ntarget = \"") + name_of(options.motion) + "\"\nbegins = \"" +
                     (options.begins_open ? "open" : "closed") + "\"")
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
  options.mechanism = SimulatedMechanism::Options::from(given);
  options.with_hand = given.flag("hand", true);
  HandOptions& hand = options.hand;
  hand.seed = options.mechanism.seed;
  hand.open_rad = given.number("open", {"deg", hand.open_rad, 1.0 * degree, 60.0 * degree});
  hand.close_rad = given.number("close", {"deg", hand.close_rad, -20.0 * degree, 59.0 * degree});
  hand.stroke_s = given.number("stroke", {"s", hand.stroke_s, 0.05, 100.0});
  hand.pause_s = given.number("pause", {"s", hand.pause_s, 0.0, 100.0});
  hand.variation = given.number("variation", {"1", hand.variation, 0.0, 0.3});
  hand.mass_kg = given.number("mass", {"kg", hand.mass_kg, 0.0, 5.0});
  hand.damping_n_s_per_m = given.number("damping", {"Ns/m", hand.damping_n_s_per_m, 0.0, 500.0});
  hand.stiffness_n_per_m = given.number("grip", {"N/m", hand.stiffness_n_per_m, 0.0, 5000.0});
  const std::string target = given.text("target").value_or("drawn");
  using Motion = Options::Motion;
  for (const Motion motion : {Motion::drawn, Motion::strokes, Motion::sine}) {
    if (target == name_of(motion)) options.motion = motion;
  }
  if (target != name_of(options.motion)) {
    throw DeviceError("device 'sim:scissors': option 'target' is '" + target +
                      "', expected drawn, strokes or sine");
  }
  const std::string begins = given.text("begins").value_or("open");
  if (begins != "open" && begins != "closed") {
    throw DeviceError("device 'sim:scissors': option 'begins' is '" + begins + "', expected open or closed");
  }
  options.begins_open = begins == "open";
  given.allow("fault");
  given.refuse_others();
  if (hand.close_rad >= hand.open_rad) {
    throw DeviceError("device 'sim:scissors': option 'close' must be a smaller angle than 'open'");
  }
  return options;
}

SimulatedScissors::SimulatedScissors(std::string_view uri, const Options& options, Surroundings surroundings)
    : options_(options),
      mechanism_({.uri = std::string(uri),
                  .model = "sim:scissors",
                  .about = "haptic scissors of two degrees of freedom with a hand on them, simulated",
                  .axes = scissors_axes(),
                  .measures_force = true,
                  .simulated = true,
                  .configuration = as_toml(options)},
                 options.mechanism, std::move(surroundings)),
      strokes_(options.hand) {
  const double hand_mass = options.with_hand ? options.hand.mass_kg : 0.0;
  for (const std::size_t at : {0U, 1U}) {
    SimulatedAxis& axis = mechanism_.axis(at);
    const Mechanics& device = *mechanism_.info().axes[at].mechanics;
    axis.mass_kg = device.mass_kg + hand_mass;
    axis.viscous_n_s_per_m = device.viscous_n_s_per_m;
    axis.coulomb_n = device.coulomb_n;
    if (!options.with_hand) continue;
    axis.hand_stiffness_n_per_m = options.hand.stiffness_n_per_m;
    axis.hand_damping_n_s_per_m = options.hand.damping_n_s_per_m;
  }
  mechanism_.place(0, handle_at(0.0).angle_rad * lever_m);
}

Strokes::Equilibrium SimulatedScissors::handle_at(double time_s) noexcept {
  const HandOptions& hand = options_.hand;
  if (options_.motion == Options::Motion::drawn) return strokes_.at(time_s);
  const double from = options_.begins_open ? hand.open_rad : hand.close_rad;
  const double way = (options_.begins_open ? 1.0 : -1.0) * (hand.close_rad - hand.open_rad);
  if (options_.motion == Options::Motion::sine) {
    const double omega = std::numbers::pi / hand.stroke_s;
    return {.angle_rad = from + 0.5 * way * (1.0 - std::cos(omega * time_s)),
            .speed_rad_s = 0.5 * way * omega * std::sin(omega * time_s)};
  }
  const double number = std::floor(time_s / (hand.pause_s + hand.stroke_s));
  const bool is_back = std::fmod(number, 2.0) != 0.0;
  const MinimumJerk progress =
      MinimumJerk::at((time_s - number * (hand.pause_s + hand.stroke_s) - hand.pause_s) / hand.stroke_s);
  return {.angle_rad = is_back ? from + way * (1.0 - progress.position) : from + way * progress.position,
          .speed_rad_s = (is_back ? -way : way) * progress.speed / hand.stroke_s};
}

Status SimulatedScissors::read(double now_s, Sample& sample) noexcept {
  mechanism_.run_until(now_s, [this](double time_s, SimulatedMechanism::Equilibria& wish) {
    if (!options_.with_hand) return;
    const Strokes::Equilibrium handle = handle_at(time_s);
    wish[0] = {.travel_m = handle.angle_rad * lever_m, .speed_m_s = handle.speed_rad_s * lever_m};
  });
  mechanism_.measure(now_s, sample);
  return Status::ok;
}

}  // namespace kerf::drivers
