#include "kerf/models/lattice.h"

#include <algorithm>
#include <cstdint>

#ifdef __SSE2__
#include <immintrin.h>
#endif

#include "lattice_limits.h"

namespace kerf::models {
namespace {

/// Numbers below the normal range count as zero while this lives.
class FlushDenormals {
 public:
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;
#ifdef __SSE2__
  FlushDenormals() noexcept : before_(_mm_getcsr()) {
    constexpr unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x0040;
    _mm_setcsr(before_ | flush_to_zero | denormals_are_zero);
  }
  ~FlushDenormals() { _mm_setcsr(before_); }

 private:
  unsigned before_;
#else
  FlushDenormals() noexcept {}
  ~FlushDenormals() {}
#endif
};

// The two loops over whole rows. Each array is a parameter of its own, as only there `__restrict` lets GCC
// vectorise.

/// w = u + tau_d v, and the sum and difference of its components, which the diagonals strain.
template <typename Real>
void weigh_points(int columns, Real tau, const Real* __restrict ux, const Real* __restrict uy,
                  const Real* __restrict vx, const Real* __restrict vy, Real* __restrict wx,
                  Real* __restrict wy, Real* __restrict sum, Real* __restrict difference) noexcept {
  for (int c = 0; c < columns; ++c) {
    const Real x = ux[c] + tau * vx[c], y = uy[c] + tau * vy[c];
    wx[c] = x;
    wy[c] = y;
    sum[c] = x + y;
    difference[c] = x - y;
  }
}

template <typename Real, typename Coefficients>
void update_points(int columns, const Coefficients k, const Real* __restrict x,
                   const Real* __restrict y_below, const Real* __restrict y, const Real* __restrict y_above,
                   const Real* __restrict sum_below, const Real* __restrict sum,
                   const Real* __restrict sum_above, const Real* __restrict dif_below,
                   const Real* __restrict dif, const Real* __restrict dif_above, Real* __restrict ux,
                   Real* __restrict uy, Real* __restrict vx, Real* __restrict vy) noexcept {
  for (int c = 1; c < columns - 1; ++c) {
    const Real along_x = k.side * (x[c + 1] + x[c - 1] - Real(2) * x[c]);
    const Real along_y = k.side * (y_above[c] + y_below[c] - Real(2) * y[c]);
    const Real rising = k.diagonal * (sum_above[c + 1] + sum_below[c - 1] - Real(2) * sum[c]);
    const Real falling = k.diagonal * (dif_above[c - 1] + dif_below[c + 1] - Real(2) * dif[c]);
    const Real bed_x = k.bedding * (ux[c] + k.bedding_time * vx[c]);
    const Real bed_y = k.bedding * (uy[c] + k.bedding_time * vy[c]);
    vx[c] += along_x + (rising + falling) - bed_x;
    vy[c] += along_y + (rising - falling) - bed_y;
    ux[c] += k.dt * vx[c];
    uy[c] += k.dt * vy[c];
  }
}

// Sums over a row. The terms are computed first, all of a kind at once, and then added in lanes that need not
// wait for each other.
constexpr int max_columns = 1000;
template <typename Real>
using Terms = std::array<Real, max_columns>;
template <typename Real>
double total(const Terms<Real>& terms, int count) noexcept {
  constexpr std::size_t lanes = 8;
  std::array<Real, lanes> sum{};
  const auto end = static_cast<std::size_t>(count);
  std::size_t i = 0;
  for (; i + lanes <= end; i += lanes) {
    for (std::size_t l = 0; l < lanes; ++l) sum[l] += terms[i + l];
  }
  for (; i < end; ++i) sum[0] += terms[i];
  double all = 0.0;
  for (const Real one : sum) all += static_cast<double>(one);
  return all;
}

/// What a strain or a displacement u adds to Strains, that in a step before was u - d: u (u - d) - share d^2.
template <typename Real>
Real across_step(Real u, Real d, Real share) noexcept {
  return u * u - d * (u + share * d);
}

/// Over the nodes of a row, times their corners: squared speeds, and Strains of the bedding.
template <typename Real, typename By>
std::array<double, 2> row_of_nodes(int columns, const By by, const std::uint8_t* __restrict corners,
                                   const Real* __restrict ux, const Real* __restrict uy,
                                   const Real* __restrict vx, const Real* __restrict vy) noexcept {
  Terms<Real> speed, bedding;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled as far as used
  for (int c = 0; c < columns; ++c) {
    const Real quarters = static_cast<Real>(corners[c]);
    speed[static_cast<std::size_t>(c)] = quarters * (vx[c] * vx[c] + vy[c] * vy[c]);
    bedding[static_cast<std::size_t>(c)] = quarters * (across_step(ux[c], by.dt * vx[c], by.bedding) +
                                                       across_step(uy[c], by.dt * vy[c], by.bedding));
  }
  return {total(speed, columns), total(bedding, columns)};
}

/// Over whole cells between a lower and an upper row of nodes: Strains of the sides and the diagonals.
template <typename Real, typename By>
std::array<double, 2> row_of_cells(int cells, const By by, const Real* __restrict ux0,
                                   const Real* __restrict uy0, const Real* __restrict vx0,
                                   const Real* __restrict vy0, const Real* __restrict ux1,
                                   const Real* __restrict uy1, const Real* __restrict vx1,
                                   const Real* __restrict vy1) noexcept {
  Terms<Real> side, diagonal;  // NOLINT(cppcoreguidelines-pro-type-member-init): likewise
  const auto upright = [&](int c) {
    return across_step(uy1[c] - uy0[c], by.dt * (vy1[c] - vy0[c]), by.spring);
  };
  for (int c = 0; c < cells; ++c) {
    side[static_cast<std::size_t>(c)] =
        across_step(ux0[c + 1] - ux0[c], by.dt * (vx0[c + 1] - vx0[c]), by.spring) +
        across_step(ux1[c + 1] - ux1[c], by.dt * (vx1[c + 1] - vx1[c]), by.spring) + Real(2) * upright(c);
    diagonal[static_cast<std::size_t>(c)] =
        across_step(ux1[c + 1] - ux0[c] + (uy1[c + 1] - uy0[c]),
                    by.dt * (vx1[c + 1] - vx0[c] + (vy1[c + 1] - vy0[c])), by.spring) +
        across_step(ux0[c + 1] - ux1[c] - (uy0[c + 1] - uy1[c]),
                    by.dt * (vx0[c + 1] - vx1[c] - (vy0[c + 1] - vy1[c])), by.spring);
  }
  // An upright side belongs to two cells, but for the first and the last.
  return {total(side, cells) + static_cast<double>(upright(cells) - upright(0)), total(diagonal, cells)};
}

}  // namespace

// ---- set-up ----

template <typename Real>
Lattice<Real>::Lattice(const LatticeOptions& options) : options_(options) {
  check(options);
  points_ = options.columns * options.rows;
  cell_columns_ = options.columns - 1;
  const std::size_t node_count = index(node_limit());
  for (auto* array : {&ux_, &uy_, &vx_, &vy_}) array->resize(node_count);
  for (auto* array : {&pull_x_, &pull_y_}) array->resize(node_count);
  corners_.resize(node_count);
  entry_.resize(node_count);
  stencils_.resize(node_count);
  next_.resize(node_count);
  pinned_.resize(index(points_));
  cut_right_.resize(index(cells()));
  cut_up_.resize(index(cells()));
  corner_node_.resize(4 * index(cells()));
  whole_row_.resize(index(options.rows - 1));
  row_buffers_.resize(12 * index(options.columns));
  reset();
}

template <typename Real>
void Lattice<Real>::reset() noexcept {
  for (auto* array : {&ux_, &uy_, &vx_, &vy_}) std::fill(array->begin(), array->end(), Real(0));
  std::fill(corners_.begin(), corners_.end(), std::uint8_t{0});
  std::fill(entry_.begin(), entry_.end(), -1);
  std::fill(cut_right_.begin(), cut_right_.end(), std::uint8_t{0});
  std::fill(cut_up_.begin(), cut_up_.end(), std::uint8_t{0});
  std::fill(whole_row_.begin(), whole_row_.end(), std::uint8_t{1});
  irregular_nodes_ = 0;
  nodes_ = points_;
  for (int cell = 0; cell < cells(); ++cell) {
    const int lower_left = cell / cell_columns_ * options_.columns + cell % cell_columns_;
    const int upper_left = lower_left + options_.columns;
    const std::array<int, 4> nodes{lower_left, lower_left + 1, upper_left + 1, upper_left};
    for (int i = 0; i < 4; ++i) {
      corner_node_[index(4 * cell + i)] = nodes[index(i)];
      ++corners_[index(nodes[index(i)])];
    }
  }
  for (int point = 0; point < points_; ++point) refresh(point);
}

template <typename Real>
bool Lattice<Real>::admits(const Coupling& coupling, double dt) const noexcept {
  if (!(dt > 0.0 && coupling.damping_n_s_per_m >= 0.0 && coupling.stiffness_n_per_m >= 0.0)) return false;
  const double limit = coupling_limit_unchecked(options_, dt, coupling.damping_n_s_per_m);
  return limit > 0.0 && coupling.stiffness_n_per_m <= limit;
}

template <typename Real>
bool Lattice<Real>::pin(int column, int row) noexcept {
  if (column < 0 || column >= options_.columns || row < 0 || row >= options_.rows) return false;
  const int point = row * options_.columns + column;
  pinned_[index(point)] = 1;
  for (int node = point; node < node_limit(); node += points_) vx_[index(node)] = vy_[index(node)] = Real(0);
  refresh(point);
  return true;
}

// ---- time ----

template <typename Real>
auto Lattice<Real>::coefficients(double dt) const noexcept -> Coefficients {
  const double per_mass = dt / options_.node_mass_kg;
  return {static_cast<Real>(dt),
          static_cast<Real>(per_mass * options_.stiffness_n_per_m),
          static_cast<Real>(per_mass * options_.diagonal_stiffness_n_per_m / 2.0),
          static_cast<Real>(per_mass * options_.bedding_n_per_m),
          static_cast<Real>(options_.damping_time_s),
          static_cast<Real>(options_.bedding_time_s)};
}

template <typename Real>
auto Lattice<Real>::row_buffer(int row) noexcept -> Row {
  const std::size_t columns = index(options_.columns);
  Real* const start = row_buffers_.data() + 4 * columns * (index(row) % 3);
  return {start, start + columns, start + 2 * columns, start + 3 * columns};
}

template <typename Real>
void Lattice<Real>::weigh(int row, Real spring_time) noexcept {
  const Row into = row_buffer(row);
  const std::size_t start = index(row) * index(options_.columns);
  weigh_points(options_.columns, spring_time, ux_.data() + start, uy_.data() + start, vx_.data() + start,
               vy_.data() + start, into.x, into.y, into.sum, into.difference);
}

/// Steps the inner points of a row as if they were regular.
template <typename Real>
void Lattice<Real>::update(int row, const Coefficients& by) noexcept {
  const Row here = row_buffer(row), below = row_buffer(row - 1), above = row_buffer(row + 1);
  const std::size_t start = index(row) * index(options_.columns);
  update_points(options_.columns, by, here.x, below.y, here.y, above.y, below.sum, here.sum, above.sum,
                below.difference, here.difference, above.difference, ux_.data() + start, uy_.data() + start,
                vx_.data() + start, vy_.data() + start);
}

template <typename Real>
auto Lattice<Real>::irregular(const Stencil& stencil, const Coefficients& by) const noexcept -> Moved {
  const Real *ux = ux_.data(), *uy = uy_.data(), *vx = vx_.data(), *vy = vy_.data();
  const Real tau = by.spring_time;
  const int own = stencil.node;
  Moved motion{ux[own], uy[own], Real(0), Real(0)};
  if (stencil.share == Real(0)) return motion;
  const auto x = [&](int node) { return ux[node] + tau * vx[node]; };
  const auto y = [&](int node) { return uy[node] + tau * vy[node]; };
  const auto &sx = stencil.along_x, &sy = stencil.along_y, &d = stencil.across;
  const Real own_x = x(own), own_y = y(own);
  const Real half = Real(0.5) * by.side;
  const Real along_x = half * (x(sx[0]) + x(sx[1]) + x(sx[2]) + x(sx[3]) - Real(4) * own_x);
  const Real along_y = half * (y(sy[0]) + y(sy[1]) + y(sy[2]) + y(sy[3]) - Real(4) * own_y);
  const Real rising = by.diagonal * ((x(d[0]) + y(d[0])) + (x(d[2]) + y(d[2])) - Real(2) * (own_x + own_y));
  const Real falling = by.diagonal * ((x(d[1]) - y(d[1])) + (x(d[3]) - y(d[3])) - Real(2) * (own_x - own_y));
  const Real bed_x = by.bedding * (motion.ux + by.bedding_time * vx[own]);
  const Real bed_y = by.bedding * (motion.uy + by.bedding_time * vy[own]);
  motion.vx = vx[own] + (stencil.share * (along_x + (rising + falling)) - bed_x);
  motion.vy = vy[own] + (stencil.share * (along_y + (rising - falling)) - bed_y);
  motion.ux += by.dt * motion.vx;
  motion.uy += by.dt * motion.vy;
  return motion;
}

template <typename Real>
void Lattice<Real>::substep(const Coefficients& by) noexcept {
  // The sweep spoils the irregular nodes among its points: theirs is computed before and written after.
  const std::size_t count = index(irregular_nodes_);
  for (std::size_t i = 0; i < count; ++i) next_[i] = irregular(stencils_[i], by);
  weigh(0, by.spring_time);
  weigh(1, by.spring_time);
  for (int row = 1; row < options_.rows - 1; ++row) {
    weigh(row + 1, by.spring_time);
    update(row, by);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t node = index(stencils_[i].node);
    ux_[node] = next_[i].ux;
    uy_[node] = next_[i].uy;
    vx_[node] = next_[i].vx;
    vy_[node] = next_[i].vy;
  }
}

/// Takes a coupling's force at a time after the tick's start, before the nodes move.
template <typename Real>
void Lattice<Real>::pull(Coupling& coupling, double time_s) noexcept {
  const Vector u = displacement(coupling.node), v = velocity(coupling.node);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (!coupling.along[axis]) continue;
    const double target = coupling.target_m[axis] + coupling.velocity_m_per_s[axis] * time_s;
    const double force = coupling.stiffness_n_per_m * (target - u[axis]) +
                         coupling.damping_n_s_per_m * (coupling.velocity_m_per_s[axis] - v[axis]);
    (axis == 0 ? pull_x_ : pull_y_)[index(coupling.node)] += force;
    coupling.force_n[axis] -= force;
  }
}

/// Adds to the step of a node what its couplings' forces, taken before, do to it.
template <typename Real>
void Lattice<Real>::kick(const Coupling& coupling, double dt) noexcept {
  const std::size_t node = index(coupling.node);
  if (!held(coupling.node)) {
    const double per_mass = dt / mass(coupling.node);
    const Real change_x = static_cast<Real>(per_mass * pull_x_[node]);
    const Real change_y = static_cast<Real>(per_mass * pull_y_[node]);
    vx_[node] += change_x;
    vy_[node] += change_y;
    ux_[node] += static_cast<Real>(dt) * change_x;
    uy_[node] += static_cast<Real>(dt) * change_y;
  }
  pull_x_[node] = pull_y_[node] = 0.0;
}

template <typename Real>
void Lattice<Real>::step(double dt, int substeps, std::span<Coupling> couplings) noexcept {
  const FlushDenormals while_stepping;
  const auto acts = [&](const Coupling& coupling) {
    return coupling.node >= 0 && coupling.node < node_limit() && alive(coupling.node);
  };
  const Coefficients by = coefficients(dt);
  for (Coupling& coupling : couplings) coupling.force_n = {};
  for (int i = 0; i < substeps; ++i) {
    for (Coupling& coupling : couplings) {
      if (acts(coupling)) pull(coupling, i * dt);
    }
    substep(by);
    for (const Coupling& coupling : couplings) {
      if (acts(coupling)) kick(coupling, dt);
    }
  }
  for (Coupling& coupling : couplings) {
    for (double& force : coupling.force_n) force /= std::max(substeps, 1);
  }
}

// ---- what can be read ----

template <typename Real>
double Lattice<Real>::mass(int node) const noexcept {
  return 0.25 * corners_[index(node)] * options_.node_mass_kg;
}

template <typename Real>
auto Lattice<Real>::position(int node) const noexcept -> Vector {
  const int point = node % points_;
  const int column = point % options_.columns, row = point / options_.columns;
  const Vector u = displacement(node);
  return {column * options_.spacing_m + u[0], row * options_.spacing_m + u[1]};
}

template <typename Real>
auto Lattice<Real>::displacement(int node) const noexcept -> Vector {
  return {static_cast<double>(ux_[index(node)]), static_cast<double>(uy_[index(node)])};
}

template <typename Real>
auto Lattice<Real>::velocity(int node) const noexcept -> Vector {
  return {static_cast<double>(vx_[index(node)]), static_cast<double>(vy_[index(node)])};
}

template <typename Real>
void Lattice<Real>::set_displacement(int node, const Vector& displacement_m) noexcept {
  if (!alive(node)) return;
  ux_[index(node)] = static_cast<Real>(displacement_m[0]);
  uy_[index(node)] = static_cast<Real>(displacement_m[1]);
}

template <typename Real>
void Lattice<Real>::set_velocity(int node, const Vector& velocity_m_per_s) noexcept {
  if (!alive(node) || held(node)) return;
  vx_[index(node)] = static_cast<Real>(velocity_m_per_s[0]);
  vy_[index(node)] = static_cast<Real>(velocity_m_per_s[1]);
}

template <typename Real>
auto Lattice<Real>::force(int node) const noexcept -> Vector {
  // A step of unit length changes the velocity by the acceleration; a held node feels its force all the same.
  Stencil stencil = stencil_of(node);
  if (!alive(node)) return {};
  stencil.share = Real(4) / static_cast<Real>(corners_[index(node)]);
  const Moved after = irregular(stencil, coefficients(1.0));
  return {mass(node) * static_cast<double>(after.vx - vx_[index(node)]),
          mass(node) * static_cast<double>(after.vy - vy_[index(node)])};
}

template <typename Real>
double Lattice<Real>::kinetic_energy() const noexcept {
  return node_energy(0.0)[0];
}

template <typename Real>
double Lattice<Real>::potential_energy() const noexcept {
  return node_energy(0.0)[1] + spring_energy(0.0);
}

template <typename Real>
double Lattice<Real>::energy(double dt) const noexcept {
  const FlushDenormals while_summing;
  const auto [kinetic, bedding] = node_energy(dt);
  return kinetic + bedding + spring_energy(dt);
}

template <typename Real>
auto Lattice<Real>::step_before(double dt) const noexcept -> StepBefore {
  const double share = dt > 0.0 ? 0.5 / dt : 0.0;
  return {static_cast<Real>(dt), static_cast<Real>(share * options_.damping_time_s),
          static_cast<Real>(share * options_.bedding_time_s)};
}

template <typename Real>
auto Lattice<Real>::node_energy(double dt) const noexcept -> Vector {
  const StepBefore by = step_before(dt);
  double speed = 0.0, bedding = 0.0;
  const auto add = [&](std::size_t start, int columns) {
    const auto of = row_of_nodes(columns, by, corners_.data() + start, ux_.data() + start, uy_.data() + start,
                                 vx_.data() + start, vy_.data() + start);
    speed += of[0];
    bedding += of[1];
  };
  for (int row = 0; row < options_.rows; ++row) add(index(row * options_.columns), options_.columns);
  for (std::size_t i = 0; i < index(irregular_nodes_); ++i) {
    if (stencils_[i].node >= points_) add(index(stencils_[i].node), 1);
  }
  return {options_.node_mass_kg / 8.0 * speed, options_.bedding_n_per_m / 8.0 * bedding};
}

template <typename Real>
auto Lattice<Real>::strains_of(int cell, const StepBefore& by) const noexcept -> Strains {
  std::array<Vector, 4> u{}, d{};
  for (std::size_t i = 0; i < 4; ++i) {
    const int node = corner(cell, static_cast<int>(i));
    const Vector v = velocity(node);
    const double dt = static_cast<double>(by.dt);
    u[i] = displacement(node);
    d[i] = {dt * v[0], dt * v[1]};
  }
  // Of a spring from one corner to another, along a direction.
  const auto of = [&](std::size_t from, std::size_t to, double x, double y) {
    const auto strain = [&](const std::array<Vector, 4>& at) {
      return x * (at[to][0] - at[from][0]) + y * (at[to][1] - at[from][1]);
    };
    return across_step(strain(u), strain(d), static_cast<double>(by.spring));
  };
  return {.side = of(0, 1, 1.0, 0.0) + of(3, 2, 1.0, 0.0) + of(0, 3, 0.0, 1.0) + of(1, 2, 0.0, 1.0),
          .diagonal = of(0, 2, 1.0, 1.0) + of(3, 1, 1.0, -1.0)};
}

template <typename Real>
double Lattice<Real>::spring_energy(double dt) const noexcept {
  const StepBefore by = step_before(dt);
  Strains sum;
  for (int row = 0; row < options_.rows - 1; ++row) {
    if (whole_row_[index(row)] != 0) {
      const std::size_t low = index(row) * index(options_.columns), up = low + index(options_.columns);
      const auto of =
          row_of_cells(cell_columns_, by, ux_.data() + low, uy_.data() + low, vx_.data() + low,
                       vy_.data() + low, ux_.data() + up, uy_.data() + up, vx_.data() + up, vy_.data() + up);
      sum.side += of[0];
      sum.diagonal += of[1];
      continue;
    }
    const int first = row * cell_columns_;
    for (int cell = first; cell < first + cell_columns_; ++cell) {
      if (!living(cell)) continue;
      const Strains of = strains_of(cell, by);
      sum.side += of.side;
      sum.diagonal += of.diagonal;
    }
  }
  return options_.stiffness_n_per_m / 4.0 * sum.side +
         options_.diagonal_stiffness_n_per_m / 4.0 * sum.diagonal;
}

// The members that are defined here; lattice_cuts.cpp has the others.
template class Lattice<float>;
template class Lattice<double>;

}  // namespace kerf::models
