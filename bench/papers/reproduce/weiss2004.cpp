#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/core.h>

#include <kerf/mechanisms/angle.h>
#include <kerf/models/scissors_mesh.h>

#include "reproduce/reproduce.h"
#include "signal/quantiles.h"

namespace kerf::bench::weiss2004 {
namespace {

constexpr double period_s = 1e-3;

/// A slab of n by n nodes, 1 mm apart, soft enough for four sub-steps of its 1 ms tick.
models::ScissorsMesh slab_of(int n) {
  return models::ScissorsMesh::make(
      std::vector{20.0, 10.0, 1e-5, 1e-5, 1e-3, 20.0, 2e-3, 5000.0, 1e-3, 3e-4},
      {{"columns", static_cast<double>(n)}, {"rows", static_cast<double>(n)}, {"edge", 0.012}});
}

/// One cut, from 40 to 2 degrees at 60 deg/s.
struct Stroke {
  std::vector<double> angle_deg, handle_n;
  std::vector<int> front;
};
Stroke cut(const models::ScissorsMesh& law, models::ScissorsMesh::State& state) {
  Stroke stroke;
  const double rate = 60.0 * degree;
  for (double theta = 40.0 * degree; theta > 2.0 * degree; theta -= rate * period_s) {
    const auto force = law.step(state, {{theta, 0.0}, {-rate, 0.0}}, period_s);
    stroke.angle_deg.push_back(theta / degree);
    stroke.handle_n.push_back(force[0]);
    stroke.front.push_back(state.front);
  }
  return stroke;
}

void one_cut(Reproduction& paper) {
  const auto law = slab_of(40);
  auto state = law.initial_state();
  const int nodes = state.slab.nodes();
  const Stroke stroke = cut(law, state);
  Chart force{.title = "One cut: force at the handle",
              .x_label = "angle between the blades [deg]",
              .y_label = "force [N]"};
  force.curves.push_back({.x = stroke.angle_deg, .y = stroke.handle_n, .colour = Colour::blue});
  paper.figures.push_back({"cut_force", std::move(force)});
  // Pull the two banks apart a little, so that the cut is seen.
  for (int c = 0; c < law.slab.columns - 1; ++c) {
    for (int r = 0; r < law.slab.rows - 1; ++r) {
      if (c > state.front) continue;
      const double away = 1.5e-3 * (1.0 - static_cast<double>(c) / (state.front + 1));
      const int half = (law.slab.rows - 1) / 2;
      for (int corner = 0; corner < 4; ++corner) {
        state.slab.set_displacement(state.slab.node(state.slab.cell(c, r), corner),
                                    {0.0, r < half ? -away : away});
      }
    }
  }
  Chart mesh{.title = "The slab after the cut, its banks drawn apart",
             .x_label = "x, along the cut [mm]",
             .y_label = "y [mm]"};
  Curve points{.colour = Colour::blue, .mark = Mark::points, .width = 0.8};
  for (int node = 0; node < state.slab.node_limit(); ++node) {
    if (!state.slab.alive(node)) continue;
    const auto at = state.slab.position(node);
    points.x.push_back(1e3 * at[0]);
    points.y.push_back(1e3 * at[1]);
  }
  mesh.curves.push_back(std::move(points));
  mesh.height_px = 560;
  paper.figures.push_back({"slab", std::move(mesh)});
  bool one_by_one = true;
  for (std::size_t i = 1; i < stroke.front.size(); ++i) {
    one_by_one =
        one_by_one && stroke.front[i] - stroke.front[i - 1] <= 1 && stroke.front[i] >= stroke.front[i - 1];
  }
  paper.add("Elements break past a deflection, and the cut advances with them", "2.2",
            fmt::format("{} elements broken one at a time, up to {:.1f} N at the handle", stroke.front.back(),
                        *std::max_element(stroke.handle_n.begin(), stroke.handle_n.end())),
            one_by_one && stroke.front.back() > 5);
  paper.add("At the end of each cut the mesh is split and new nodes are formed", "2.1",
            fmt::format("{} sides split, {} new nodes", state.cuts, state.slab.nodes() - nodes),
            static_cast<int>(state.cuts) == state.front && state.slab.nodes() - nodes == state.front);
}

/// Time that 99 % of ticks stay below [s] while the scissors close on a slab.
double tick_time(const models::ScissorsMesh& law) {
  auto state = law.initial_state();
  std::vector<double> times;
  const double rate = 60.0 * degree;
  for (double theta = 30.0 * degree; times.size() < 200; theta -= rate * period_s) {
    const auto begin = std::chrono::steady_clock::now();
    (void)law.step(state, {{theta, 0.0}, {-rate, 0.0}}, period_s);
    times.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return quantile(std::move(times), 0.99);
}

void update_rate(Reproduction& paper) {
  Chart chart{.title = "Update rate against node count",
              .x_label = "nodes of the slab (4 sub-steps a tick)",
              .y_label = "update rate of 99 % of ticks [Hz]",
              .log_x = true,
              .log_y = true};
  Curve rate{.label = "measured", .colour = Colour::blue};
  Curve marks{.colour = Colour::blue, .mark = Mark::points};
  double at_1khz = 0.0;
  int substeps = 0;
  double largest_time = 0.0;
  for (const int n : {10, 20, 32, 45, 64, 90, 128, 180, 256, 362}) {
    const auto law = slab_of(n);
    const double time_s = tick_time(law);
    rate.x.push_back(static_cast<double>(n) * n);
    rate.y.push_back(1.0 / time_s);
    substeps = law.substeps(period_s);
    if (time_s <= period_s) at_1khz = static_cast<double>(n) * n;
    if (n == 128) largest_time = time_s;
  }
  marks.x = rate.x;
  marks.y = rate.y;
  chart.curves.push_back(std::move(rate));
  chart.curves.push_back(std::move(marks));
  chart.y_range = {200.0, 1e6};
  chart.horizontal.push_back({.at = 1000.0, .label = "1 kHz"});
  chart.horizontal.push_back({.at = 333.0, .label = "[Weiss2004]"});
  paper.figures.push_back({"update_rate", std::move(chart)});
  paper.answer("How many nodes at what rate? (333 Hz, number of nodes not given)", "3",
               fmt::format("99 % of ticks within 1 ms up to {:.0f} nodes, of 131,044 tried, with {} "
                           "sub-steps; {:.0f} us at 16,384 nodes",
                           at_1khz, substeps, 1e6 * largest_time));
  paper.add("The method can be rendered at the haptic rate of 1000 Hz", "2, 3",
            fmt::format("1 kHz up to {:.0f} nodes on this machine", at_1khz), at_1khz >= 400.0);
}

}  // namespace

Reproduction run(std::uint64_t) {
  Reproduction paper{.paper = "003", .key = "Weiss2004", .title = "Two-mesh model of cutting with scissors"};
  one_cut(paper);
  update_rate(paper);
  return paper;
}

}  // namespace kerf::bench::weiss2004
