#include "stability/controllers/controller_design.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

constexpr int angles_tried = 500;

/// The stiffest spring beside a damper that couples_any(); 0 where not even the damper does.
double stiffest_beside(const SampledDevice& device, double damping) {
  double good = 0.0;
  double bad = 4.0 * device.viscous_n_s_per_m / device.period_s;
  const double least = 1e-6 * bad;
  if (!couples_any(device, least, damping)) return 0.0;
  while (couples_any(device, bad, damping)) bad *= 2.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (good + bad);
    (couples_any(device, middle, damping) ? good : bad) = middle;
  }
  return good;
}

}  // namespace

bool couples_any(const SampledDevice& device, double stiffness_n_per_m, double damping_n_s_per_m) {
  using Complex = std::complex<double>;
  const double period_s = device.period_s;
  const double gain = device.velocity_gain();
  const double delay = whole_periods(device.delay_s, period_s);
  for (int i = 1; i <= angles_tried; ++i) {
    const double angle = std::numbers::pi * i / angles_tried;
    const Complex difference = 1.0 - std::polar(1.0, -angle);
    const Complex filter = gain / (1.0 - (1.0 - gain) * std::polar(1.0, -angle));
    const Complex coupling = damping_n_s_per_m * filter + stiffness_n_per_m * period_s / difference;
    const double has = (1.0 / coupling).real();
    if (has * 2.0 * device.viscous_n_s_per_m < 1.0 - std::cos((1.0 + delay) * angle)) return false;
  }
  return true;
}

ControllerDesign design_controller(WallController controller, const SampledDevice& device) {
  check(device);
  ControllerDesign design{.controller = controller, .device = device};
  if (controller == WallController::damping)
    design.most_damping_n_s_per_m = device.viscous_n_s_per_m / worst_of_damping(device);
  if (controller != WallController::coupling) return design;
  if (!(device.viscous_n_s_per_m > 0.0)) {
    throw std::invalid_argument(
        "a virtual coupling lives on the device's viscous friction, and it has none; give --viscous");
  }
  SampledDevice counted = device;
  counted.viscous_n_s_per_m *= friction_used;
  // Stiffness over damping has one hill: a coarse look over it, and a finer one about its top.
  double from = 0.0;
  double step = 2.0 * counted.viscous_n_s_per_m / 20.0;
  for (int look = 0; look < 3; ++look) {
    double best = design.coupling_damping_n_s_per_m;
    for (int i = 0; i <= 20; ++i) {
      const double damping = from + step * i;
      const double stiffness = stiffest_beside(counted, damping);
      if (stiffness > design.coupling_stiffness_n_per_m * (1.0 + 1e-6)) {
        design.coupling_stiffness_n_per_m = stiffness;
        best = damping;
      }
    }
    design.coupling_damping_n_s_per_m = best;
    from = std::max(0.0, best - step);
    step *= 0.1;
  }
  return design;
}

std::string in_words(const ControllerDesign& design, const TravelUnits& units) {
  switch (design.controller) {
    case WallController::none:
      return "the wall as it is";
    case WallController::damping:
      return fmt::format(
          "a damping of {:.3g} {}, the largest damper that the device's friction keeps passive in any "
          "hand",
          design.most_damping_n_s_per_m, units.damping());
    case WallController::coupling:
      return fmt::format(
          "a spring of {:.4g} {} and a damper of {:.3g} {}, the stiffest that couple any passive wall to "
          "any passive hand by {:.0f} % of the device's friction",
          design.coupling_stiffness_n_per_m, units.stiffness(), design.coupling_damping_n_s_per_m,
          units.damping(), 100.0 * friction_used);
    case WallController::passivity:
      return design.device.delay_s > 0.0 ? "damping where the wall gave energy that it had not stored; the "
                                           "device has a delay, and what "
                                           "brakes late may push"
                                         : "damping where the wall gave energy that it had not stored";
    case WallController::exact:
      break;
  }
  return "a force that does the work of the wall over the tick in which it is held, by the device's own "
         "motion";
}

}  // namespace kerf::bench
