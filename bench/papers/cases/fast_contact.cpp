#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/core.h>

#include <kerf/models/precontact.h>

#include "cases/devices.h"
#include "cases/each_case.h"
#include "cases/trace.h"
#include "stability/wall/wall_force.h"

namespace kerf::bench::cases::fast_contact {
namespace {

constexpr double stiffness_n_per_m = 1000.0;
constexpr double damping_n_s_per_m = 1.0;
constexpr double speed_m_s = 0.8;
constexpr double precontact_m = 3e-3;
constexpr int phases = 16;

/// The handle with the mass of a finger that has let go of all else.
SampledDevice thrown_handle() {
  SampledDevice device = scissors_handle();
  device.encoder_step_m = 0.0;
  device.hand.mass_kg = 0.1;
  return device;
}

/// models::Precontact over a wall at 0.
struct SoftContact {
  models::Precontact<double> law{.stiffness = stiffness_n_per_m, .width = precontact_m};
  double operator()(const AxisReading& reading) const noexcept {
    models::Precontact<double>::State state;
    return -law.step(state, {.penetration = reading.position_m - precontact_m}, 0.0);
  }
};

struct Bounce {
  double gained_j = 0.0;
  CaseTrace speed;
};

/// Thrown at the wall from a share of a tick in front of it, until it has left it again.
template <typename Force>
Bounce bounce(double speed, double share, Force force) {
  const SampledDevice device = thrown_handle();
  SampledLoop loop(device, force, {.position_m = -share * speed * device.period_s, .speed_m_s = speed});
  Bounce done;
  for (int tick = 0; tick < 1000; ++tick) {
    done.speed.add(tick * device.period_s, loop.motion().speed_m_s);
    if (tick > 1 && loop.motion().position_m < 0.0) break;
    loop.step();
  }
  const double out = loop.motion().speed_m_s;
  done.gained_j = 0.5 * device.moving_mass_kg() * (out * out - speed * speed);
  return done;
}

/// Most that is gained, over the moments at which a tick may find the contact [J].
template <typename Force>
double max_gained(double speed, Force force) {
  double most = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < phases; ++i) {
    most = std::max(most, bounce(speed, static_cast<double>(i) / phases, force).gained_j);
  }
  return most;
}

CaseOutcome judged(double gained_j, std::string figure) {
  return {.holds = gained_j <= 0.0, .measured = 1e3 * gained_j, .unit = "mJ", .figure = std::move(figure)};
}

}  // namespace

NamedCase run(std::uint64_t) {
  const WallForce stiff{{.stiffness_n_per_m = stiffness_n_per_m}};
  const WallForce damped{{.stiffness_n_per_m = stiffness_n_per_m, .damping_n_s_per_m = damping_n_s_per_m}};
  const SampledDevice device = thrown_handle();
  const double failing_j = max_gained(speed_m_s, stiff);
  const double slow_j = max_gained(0.25 * speed_m_s, stiff);
  const double holding_j = max_gained(speed_m_s, damped);
  const double precontact_j = max_gained(speed_m_s, SoftContact{});
  const double leak = 0.5 * stiffness_n_per_m * device.period_s - device.viscous_n_s_per_m;
  Chart picture =
      two_traces("Leaving a wall of 1000 N/m that was met at 0.8 m/s", bounce(speed_m_s, 0.5, stiff).speed,
                 "plain wall", bounce(speed_m_s, 0.5, damped).speed, "with 1 N·s/m");
  picture.y_label = "speed [m/s]";
  picture.curves.push_back(
      curve_of(bounce(speed_m_s, 0.5, SoftContact{}).speed, "pre-contact of 3 mm", Colour::green));
  picture.x_range = {0.028, 0.04};
  picture.y_range = {-0.84, -0.6};
  picture.horizontal = {{.at = -speed_m_s}};
  return {
      .where = "literature [AbbottOkamura2005]; the law precontact is of [Henry2004]",
      .what =
          "A wall that Coulomb friction keeps passive when it is met slowly throws back a fast tool faster "
          "than it came.",
      .remedy =
          fmt::format("Damping of {} N·s/m in the wall, more than the hold leaks. Meeting the wall "
                      "through 3 mm of pre-contact does not do: it bends the first millimetres, and what "
                      "leaks is K T v^2 / 2 along the whole way.",
                      damping_n_s_per_m),
      .limit = 0.0,
      .quantity = "energy gained in a bounce at 0.8 m/s, at the worst moment of a tick",
      .without = judged(failing_j, fmt::format("{:+.2f} mJ; {:+.2f} mJ at {:.1f} m/s", 1e3 * failing_j,
                                               1e3 * slow_j, 0.25 * speed_m_s)),
      .with = judged(holding_j, fmt::format("{:+.2f} mJ; with pre-contact instead {:+.2f} mJ",
                                            1e3 * holding_j, 1e3 * precontact_j)),
      .theory = fmt::format("A stroke of constant speed gains past f_c / (K T / 2 - b) = {:.2f} m/s, half a "
                            "swing past 4 / pi times that, {:.2f} m/s.",
                            device.coulomb_n / leak, 4.0 / std::numbers::pi * device.coulomb_n / leak),
      .picture = std::move(picture)};
}

}  // namespace kerf::bench::cases::fast_contact
