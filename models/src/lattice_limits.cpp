#include "lattice_limits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace kerf::models {
namespace {

constexpr double largest = std::numeric_limits<double>::max();
constexpr double smallest = std::numeric_limits<double>::min();
constexpr int max_substeps = 1'000'000;

void check(std::string_view name, double value, double lower, double upper) {
  if (value >= lower && value <= upper) return;
  std::ostringstream message;
  message << "option '" << name << "' of the lattice is " << value << ", expected a number ";
  if (upper < largest) {
    message << "from " << lower << " to " << upper;
  } else {
    message << (lower > 0.0 ? "above 0" : "not below 0");
  }
  throw std::invalid_argument(message.str());
}

/// The stiffest mode that cells can have: squared frequency w^2 [1/s^2] and decay w^2 tau [1/s].
struct Mode {
  double stiffness, damping;
};
Mode stiffest_mode(const LatticeOptions& options) noexcept {
  const double springs =
      4.0 * (options.stiffness_n_per_m + 2.0 * options.diagonal_stiffness_n_per_m) / options.node_mass_kg;
  const double bedding = options.bedding_n_per_m / options.node_mass_kg;
  return {springs + bedding, springs * options.damping_time_s + bedding * options.bedding_time_s};
}

}  // namespace

void check(const LatticeOptions& options) {
  check("columns", options.columns, 2, 1000);
  check("rows", options.rows, 2, 1000);
  check("spacing_m", options.spacing_m, smallest, largest);
  check("stiffness_n_per_m", options.stiffness_n_per_m, smallest, largest);
  check("diagonal_stiffness_n_per_m", options.diagonal_stiffness_n_per_m, 0.0, largest);
  check("node_mass_kg", options.node_mass_kg, smallest, largest);
  check("damping_time_s", options.damping_time_s, 0.0, largest);
  check("bedding_n_per_m", options.bedding_n_per_m, 0.0, largest);
  check("bedding_time_s", options.bedding_time_s, 0.0, largest);
}

double coupling_limit_unchecked(const LatticeOptions& options, double dt, double damping) noexcept {
  const Mode mode = stiffest_mode(options);
  const double room = 4.0 - dt * dt * mode.stiffness - 2.0 * dt * mode.damping;
  return std::max(0.0, 0.25 * options.node_mass_kg * room / (dt * dt) - 2.0 * damping / dt);
}

double stable_step(const LatticeOptions& options, double coupling_stiffness_n_per_m,
                   double coupling_damping_n_s_per_m) {
  check(options);
  Mode mode = stiffest_mode(options);
  // At the lightest node that cuts can leave, which has a quarter of the mass.
  mode.stiffness += 4.0 * coupling_stiffness_n_per_m / options.node_mass_kg;
  mode.damping += 4.0 * coupling_damping_n_s_per_m / options.node_mass_kg;
  return 4.0 / (mode.damping + std::sqrt(mode.damping * mode.damping + 4.0 * mode.stiffness));
}

int substeps(const LatticeOptions& options, double period_s) {
  const double number = std::ceil(period_s / (step_safety * stable_step(options)));
  if (number >= 1.0 && number <= max_substeps) return static_cast<int>(number);
  std::ostringstream message;
  message << "period_s is " << period_s << ", expected a time above 0 of at most " << max_substeps
          << " sub-steps of " << step_safety * stable_step(options) << " s";
  throw std::invalid_argument(message.str());
}

double coupling_limit(const LatticeOptions& options, double dt, double damping_n_s_per_m) {
  check(options);
  check("dt", dt, smallest, largest);
  check("damping_n_s_per_m", damping_n_s_per_m, 0.0, largest);
  return coupling_limit_unchecked(options, dt, damping_n_s_per_m);
}

}  // namespace kerf::models
