#include "kerf/models/scissors_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace kerf::models {
namespace {

constexpr int max_substeps = 1000;  // a tick; more than that no machine does in 1 ms
constexpr double longest_ticks = 2.0;
constexpr double following_rad_s = 10.0;
constexpr double following_m_s = 0.5;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr int max_columns = 8;         // of the strip that the blades press at once
constexpr double slack_columns = 2.0;  // beyond the blades' length that the strip reaches

int substeps_for(double largest_step_s, double period_s) {
  const double needed = std::ceil(period_s / (step_safety * largest_step_s));
  return static_cast<int>(std::clamp(needed, 1.0, static_cast<double>(max_substeps)));
}

}  // namespace

std::vector<OptionInfo> ScissorsMesh::options() {
  std::vector<OptionInfo> all{
      {"columns", 100.0, "nodes of the slab along the cut, 4 to 1000"},
      {"rows", 100.0, "nodes of the slab across it, 4 to 1000"},
      {"spacing", 1e-3, "h, between nodes [m]"},
      {"edge", 0.03, "x_m, near border of the slab, from the pivot at x_s = 0 [m]"},
      {"substeps", 0.0, "of the slab in a tick; 0: as many as its stiffest spring needs"},
      {"opening_speed", 0.02, "opening faster than this ends a cut [rad/s]"},
      {"lever", 0.28 / 7.58, "l_h, of the handle [m]"}};
  const auto scissors = ScissorsGeometry::options();
  all.insert(all.end(), scissors.begin(), scissors.end());
  return all;
}

std::vector<ParameterInfo> ScissorsMesh::parameters(const Options& given) {
  const OptionReader refuses_unknown(name, options(), given);
  constexpr auto logarithmic = Scale::logarithmic;
  return {
      {"stiffness", Quantity::spring, 1e-3, 1e7, logarithmic, "k, of a side of the slab"},
      {"diagonal_stiffness", Quantity::spring, 0.0, 1e7, Scale::linear, "kd, of a diagonal of the slab"},
      {"damping_time", Quantity::time, 0.0, 1.0, Scale::linear,
       "tau_d, damping over stiffness of any spring"},
      {"node_mass", Quantity::mass, 1e-9, 1.0, logarithmic, "m, of a whole node of the slab"},
      {"node_damping", Quantity::dashpot, 0.0, 1e5, Scale::linear,
       "of a whole node of the slab against the ground"},
      {"coupling_stiffness", Quantity::spring, 1e-3, 1e7, logarithmic, "kc, between scissors and slab"},
      {"coupling_damping", Quantity::dashpot, 0.0, 1e5, Scale::linear, "bc, of that coupling"},
      {"cutting_stiffness", Quantity::spring, 1e-3, 1e7, logarithmic, "of a side of the strip"},
      {"cutting_mass", Quantity::mass, 1e-9, 1.0, logarithmic, "of a whole node of the strip"},
      {"break_deflection", Quantity::length, 1e-9, 1.0, logarithmic, "squeeze at which an element breaks"}};
}

ScissorsMesh ScissorsMesh::make(std::span<const double> values, const Options& given) {
  const OptionReader reader(name, options(), given);
  const ScissorsGeometry scissors = ScissorsGeometry::make(reader);
  ScissorsMesh law;
  law.slab = {.columns = static_cast<int>(reader.count("columns", 4, 1000)),
              .rows = static_cast<int>(reader.count("rows", 4, 1000)),
              .spacing_m = reader.number("spacing", 1e-6, 1.0),
              .stiffness_n_per_m = values[0],
              .diagonal_stiffness_n_per_m = values[1],
              .node_mass_kg = values[3],
              .damping_time_s = values[2]};
  if (values[4] > 0.0) {
    // The lattice knows damping to the ground as that of a bedding; this one is too soft to be felt.
    law.slab.bedding_n_per_m = 1e-6 * values[0];
    law.slab.bedding_time_s = values[4] / law.slab.bedding_n_per_m;
  }
  const double reach = scissors.blade_length_m / law.slab.spacing_m + slack_columns;
  law.strip = {.columns = static_cast<int>(std::clamp(reach, 4.0, static_cast<double>(law.slab.columns))),
               .rows = 2,
               .spacing_m = law.slab.spacing_m,
               .stiffness_n_per_m = values[7],
               .diagonal_stiffness_n_per_m = 0.5 * values[7],
               .node_mass_kg = values[8],
               .damping_time_s = values[2]};
  law.coupling_stiffness = values[5];
  law.coupling_damping = values[6];
  law.contact_stiffness = 4.0 * values[7];
  law.contact_damping = std::sqrt(law.contact_stiffness * law.strip.node_mass_kg);
  law.break_deflection_m = values[9];
  if (!(law.break_deflection_m < 0.5 * law.slab.spacing_m)) {
    throw std::invalid_argument(
        "law 'scissors_mesh': break_deflection must be smaller than half the option 'spacing', the half "
        "thickness "
        "of the strip");
  }
  law.edge_m = reader.number("edge", -10.0, 10.0);
  law.lever_m = reader.number("lever", 1e-6, 10.0);
  law.opening_speed = reader.number("opening_speed", 0.0, 100.0);
  law.fixed_substeps = static_cast<int>(reader.count("substeps", 0, max_substeps));
  law.point = CuttingPoint(scissors);
  law.slab_step_s = stable_step(law.slab, law.coupling_stiffness, law.coupling_damping);
  law.strip_step_s = stable_step(law.strip, law.contact_stiffness, law.contact_damping);
  constexpr double tick_s = 1e-3;
  for (const auto& [what, step_s] :
       {std::pair{"slab", law.slab_step_s}, std::pair{"strip", law.strip_step_s}}) {
    if (tick_s <= step_safety * step_s * max_substeps) continue;
    throw std::invalid_argument("law 'scissors_mesh': the " + std::string(what) +
                                " is stable only in steps of " + std::to_string(1e9 * step_s) +
                                " ns; make it softer, heavier or less damped, or no machine follows it");
  }
  return law;
}

ScissorsMesh::State ScissorsMesh::initial_state() const {
  State state{.slab = Lattice<float>(slab), .strip = Lattice<float>(strip)};
  for (int row = 0; row < slab.rows; ++row) state.slab.pin(slab.columns - 1, row);
  for (int column = 0; column < slab.columns; ++column) {
    state.slab.pin(column, 0);
    state.slab.pin(column, slab.rows - 1);
  }
  state.strip_half_m.assign(static_cast<std::size_t>(strip.columns), 0.5 * strip.spacing_m);
  for (const int row : {0, 1}) state.strip.pin(strip.columns - 1, row);
  return state;
}

int ScissorsMesh::substeps(double period_s) const noexcept {
  return fixed_substeps > 0 ? fixed_substeps : substeps_for(slab_step_s, period_s);
}

void ScissorsMesh::choose_substeps(State& state, double period_s) const noexcept {
  const double nominal_s = state.nominal.after(period_s);
  const double stable_s = fixed_substeps > 0 ? strip_step_s : std::min(slab_step_s, strip_step_s);
  state.advance_s = std::min({period_s, longest_ticks * nominal_s, max_substeps * step_safety * stable_s});
  const double ticks = state.advance_s / nominal_s;
  state.slab_substeps = fixed_substeps > 0 && ticks > 1.01
                            ? static_cast<int>(std::ceil(ticks * fixed_substeps))
                            : substeps(state.advance_s);
  state.strip_substeps = substeps_for(strip_step_s, state.advance_s);
}

ScissorsMesh::Blades ScissorsMesh::blades_at(double theta, double x_s) const noexcept {
  const bool cut = point.cuts_at(theta);
  return {.theta = theta, .x_s = x_s, .x_c = cut ? point(theta) : 0.0, .cut = cut};
}

ScissorsMesh::Seen ScissorsMesh::follow(State& state, const SpatialMotion& motion,
                                        double period_s) const noexcept {
  const bool at_the_tool = !state.started || (!state.trails && state.advance_s >= period_s);
  state.started = true;
  if (at_the_tool) return {blades_at(motion.position[0], motion.position[1]), motion.velocity[0]};
  const double theta = motion.position[0];
  const double x_s = motion.position[1];
  const double opened = std::max(0.0, theta - state.before.theta);
  state.before = blades_at(std::max(state.before.theta, theta), std::min(state.before.x_s, x_s));
  const double closes = theta - state.before.theta;  // <= 0
  const double advances = x_s - state.before.x_s;    // >= 0
  const auto in_time = [&](double following, double speed) {
    return std::max(following, 2.0 * std::abs(speed)) * state.advance_s;
  };
  const double turn = std::max(closes, -in_time(following_rad_s, motion.velocity[0]));
  const double travel = std::min(advances, in_time(following_m_s, motion.velocity[1]));
  state.trails = turn > closes || travel < advances;
  return {
      state.trails ? blades_at(state.before.theta + turn, state.before.x_s + travel) : blades_at(theta, x_s),
      (opened + turn) / state.advance_s};
}

int ScissorsMesh::front_node(const State& state) const noexcept {
  // The cells above the middle line; where the slab is still whole those below share the node.
  const int column = std::min(state.front, slab.columns - 2);
  return state.slab.node(state.slab.cell(column, middle_row()), state.front == column ? 0 : 1);
}

double ScissorsMesh::front_position(const State& state) const noexcept {
  return edge_m + state.slab.position(front_node(state))[0];
}

double ScissorsMesh::push_slab(State& state, const Blades& blades) const noexcept {
  const int node = front_node(state);
  const double now = blades.x_s + blades.x_c;
  const double before = state.before.cut ? state.before.x_s + state.before.x_c : now;
  const double at_rest = edge_m + slab.spacing_m * state.front;
  const double touching = edge_m + state.slab.position(node)[0];
  Coupling coupling{.node = node,
                    .stiffness_n_per_m = coupling_stiffness,
                    .damping_n_s_per_m = coupling_damping,
                    .target_m = {before - at_rest, 0.0},
                    .velocity_m_per_s = {(now - before) / state.advance_s, 0.0},
                    .along = {true, false}};
  const bool contact = std::max(now, before) > touching;
  const double dt = state.advance_s / state.slab_substeps;
  state.slab.step(dt, state.slab_substeps, contact ? std::span(&coupling, 1) : std::span<Coupling>());
  if (contact) {
    const double strain = now - at_rest - state.slab.displacement(node)[0];
    if (strain > 0.0) state.coupled_j += 0.5 * coupling_stiffness * strain * strain;
  }
  // A lattice that has diverged (too few sub-steps by hand) is a fault and no silence.
  if (!std::isfinite(coupling.force_n[0]) || !std::isfinite(state.slab.position(node)[0]))
    return not_a_number;
  return contact ? std::min(0.0, coupling.force_n[0]) : 0.0;
}

double ScissorsMesh::stored_energy(const State& state) const noexcept {
  return state.coupled_j + state.slab.energy(state.advance_s / state.slab_substeps) +
         (state.cutting ? state.strip.energy(state.advance_s / state.strip_substeps) : 0.0);
}

void ScissorsMesh::begin_cut(State& state, const Blades& blades) const noexcept {
  state.cutting = true;
  state.begun = state.front;
  state.strip_front = 0;
  state.strip_origin_m = front_position(state);
  state.strip.reset();
  for (std::size_t column = 0; column < state.strip_half_m.size(); ++column) {
    const double x = state.strip_origin_m + strip.spacing_m * static_cast<double>(column) - blades.x_s;
    state.strip_half_m[column] = std::clamp(point.half_gap(blades.theta, x), 0.0, 0.5 * strip.spacing_m);
  }
}

AxisValues ScissorsMesh::squeeze_strip(State& state, const Blades& blades) const noexcept {
  const auto distance = [&](int column) {
    return state.strip_origin_m + strip.spacing_m * column - blades.x_s;
  };
  const Blades& before = state.before.cut ? state.before : blades;
  std::array<Coupling, 2 * max_columns> couplings;
  std::size_t count = 0;
  for (int column = state.strip_front; column + 1 < strip.columns && count < couplings.size(); ++column) {
    const double gap = std::max(0.0, point.half_gap(blades.theta, distance(column)));
    const double gap_before =
        std::max(0.0, point.half_gap(before.theta, distance(column) + blades.x_s - before.x_s));
    const double half = state.strip_half_m[static_cast<std::size_t>(column)];
    const int cell = state.strip.cell(column, 0);
    const int lower = state.strip.node(cell, 0);
    const int upper = state.strip.node(cell, 3);
    if (gap >= half + std::max(state.strip.displacement(upper)[1], -state.strip.displacement(lower)[1]))
      break;
    for (const auto& [node, side] : {std::pair{lower, -1.0}, std::pair{upper, 1.0}}) {
      couplings[count++] = {.node = node,
                            .stiffness_n_per_m = contact_stiffness,
                            .damping_n_s_per_m = contact_damping,
                            .target_m = {0.0, side * (gap_before - half)},
                            .velocity_m_per_s = {0.0, side * (gap - gap_before) / state.advance_s},
                            .along = {false, true}};
    }
  }
  const std::span pressed(couplings.data(), count);
  state.strip.step(state.advance_s / state.strip_substeps, state.strip_substeps, pressed);
  const double psi = 0.5 * blades.theta + point.taper_angle();
  const double edge_distance = blades.x_c * std::sin(psi);
  AxisValues force{};
  for (const Coupling& one : pressed) {
    const double target = one.target_m[1] + one.velocity_m_per_s[1] * state.advance_s;
    const double strain = target - state.strip.displacement(one.node)[1];
    state.coupled_j += 0.5 * one.stiffness_n_per_m * strain * strain;
  }
  for (std::size_t i = 0; i < count; i += 2) {
    // Mean force on one blade; it only pushes.
    const double mean = 0.5 * (couplings[i + 1].force_n[1] - couplings[i].force_n[1]);
    const double f = mean < 0.0 ? 0.0 : mean;
    const double x = distance(state.strip_front + static_cast<int>(i / 2));
    force[0] += f * (x - edge_distance * std::sin(psi)) / (std::cos(psi) * std::cos(psi)) / lever_m;
    force[1] -= 2.0 * f * std::tan(psi);
  }
  return force;
}

void ScissorsMesh::break_elements(State& state, const Blades& blades) const noexcept {
  const int last = std::min(strip.columns - 2, state.strip_front + slab.columns - 1 - state.front);
  while (state.strip_front < last) {
    const int cell = state.strip.cell(state.strip_front, 0);
    const double squeezed = 0.5 * (state.strip.displacement(state.strip.node(cell, 0))[1] -
                                   state.strip.displacement(state.strip.node(cell, 3))[1]);
    const double x = state.strip_origin_m + strip.spacing_m * state.strip_front - blades.x_s;
    const bool breaks = squeezed >= break_deflection_m || point.half_gap(blades.theta, x) <= 0.0;
    if (!breaks) return;
    state.strip.remove_cell(cell);
    ++state.strip_front;
    ++state.front;
  }
}

void ScissorsMesh::end_cut(State& state) const noexcept {
  for (int column = state.begun; column < state.front; ++column) {
    const int above = state.slab.cell(column, middle_row());
    state.cuts += state.slab.cut_side(above, above - (slab.columns - 1)) ? 1U : 0U;
  }
  state.begun = state.front;
  state.cutting = false;
}

AxisValues ScissorsMesh::step(State& state, const SpatialMotion& motion, double period_s) const noexcept {
  choose_substeps(state, period_s);
  const auto [blades, rate] = follow(state, motion, period_s);
  const bool opening = rate > opening_speed;
  const bool at_the_end = state.front >= slab.columns - 1 || state.strip_front >= strip.columns - 2;
  if (state.cutting && (!blades.cut || opening || at_the_end)) end_cut(state);
  state.coupled_j = 0.0;
  AxisValues force{};
  if (!blades.cut) {
    state.slab.step(state.advance_s / state.slab_substeps, state.slab_substeps);
  } else {
    const double front = front_position(state);
    const bool closing = rate < 0.0;
    const bool within_reach =
        point.half_gap(blades.theta, front - blades.x_s) < 0.5 * strip.spacing_m && front > blades.x_s;
    if (!state.cutting && closing && within_reach && state.front < slab.columns - 1) begin_cut(state, blades);
    if (state.cutting) {
      force = squeeze_strip(state, blades);
      break_elements(state, blades);
    }
    force[1] += push_slab(state, blades);
  }
  state.before = blades;
  return force;
}

}  // namespace kerf::models
