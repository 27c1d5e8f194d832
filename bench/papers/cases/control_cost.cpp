#include "cases/control_cost.h"

#include <algorithm>
#include <cmath>

#include <kerf/drivers/hand.h>
#include <kerf/fitting/jnd.h>

#include "cases/controlled_wall.h"

namespace kerf::bench {
namespace {

constexpr double above_m = 8e-3;
constexpr double inside_m = 2e-3;
constexpr double stroke_s = 0.1;

/// Where a tap is: in within 0.1 s, there for 0.1 s, out again.
double tapped(double time_s) {
  const double in = drivers::MinimumJerk::at(time_s / stroke_s).position;
  const double out = drivers::MinimumJerk::at(time_s / stroke_s - 2.0).position;
  return -above_m + (above_m + inside_m) * (in - out);
}

void tap(const SampledDevice& device, ControlCost& cost) {
  const double stiffness = cost.stiffness_n_per_m;
  const WallForce own{{.stiffness_n_per_m = stiffness}};
  ControlledWall controlled(own, device, {stiffness});
  AxisSensor sensor(device);
  double squares = 0.0;
  double squares_jnd = 0.0;
  int inside = 0;
  for (double time_s = 0.0; time_s < 3.0 * stroke_s; time_s += device.period_s) {
    const AxisReading reading = sensor.read(tapped(time_s));
    const double rendered_n = controlled(reading);
    const double own_n = own(reading);
    const double difference_n = std::abs(rendered_n - own_n);
    const double jnd = difference_n / fitting::force_jnd.at(own_n);
    if (own_n == 0.0 && rendered_n == 0.0) continue;
    cost.worst_n = std::max(cost.worst_n, difference_n);
    cost.worst_jnd = std::max(cost.worst_jnd, jnd);
    squares += difference_n * difference_n;
    squares_jnd += jnd * jnd;
    ++inside;
  }
  cost.rms_n = std::sqrt(squares / inside);
  cost.rms_jnd = std::sqrt(squares_jnd / inside);
}

}  // namespace

ControlCosts control_costs() {
  const SampledDevice device = weighted_scissors();
  SampledDevice perfect = device;
  perfect.encoder_step_m = 0.0;
  perfect.velocity_corner_rad_s = 0.0;
  const double passive = 2.0 * device.viscous_n_s_per_m / device.period_s;
  ControlCosts costs;
  Curve worst{.label = "worst difference", .colour = Colour::vermillion, .width = 2.0};
  Curve rms{.label = "rms", .colour = Colour::blue, .width = 2.0};
  for (const double share : {0.5, 0.75, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0}) {
    ControlCost cost{.share = share, .stiffness_n_per_m = share * passive};
    const WallForce wall{{.stiffness_n_per_m = cost.stiffness_n_per_m}};
    cost.holds_without = ripple_n(lean_on(device, wall)) <= felt_n;
    cost.holds_with =
        ripple_n(lean_on(device, ControlledWall(wall, device, {cost.stiffness_n_per_m}))) <= felt_n;
    tap(perfect, cost);
    ControlCost stepped = cost;
    tap(device, stepped);
    cost.worst_with_encoder_n = stepped.worst_n;
    worst.x.push_back(share);
    worst.y.push_back(cost.worst_n);
    rms.x.push_back(share);
    rms.y.push_back(cost.rms_n);
    costs.rows.push_back(cost);
  }
  costs.picture = {.title = "What the passivity controller adds to a tap",
                   .x_label = "stiffness over 2 b / T",
                   .y_label = "force [N]",
                   .curves = {worst, rms},
                   .horizontal = {{.at = felt_n, .label = "0.05 N"}},
                   .y_range = {0.0, 0.1},
                   .legend_below = true,
                   .width_px = 640,
                   .height_px = 280};
  return costs;
}

}  // namespace kerf::bench
