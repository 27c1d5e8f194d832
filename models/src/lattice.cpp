#include "kerf/models/lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string_view>

#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace kerf::models {
namespace {

constexpr double largest = std::numeric_limits<double>::max();
constexpr double smallest = std::numeric_limits<double>::min();
constexpr int most_substeps = 1'000'000;

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

double coupling_limit_unchecked(const LatticeOptions& options, double dt, double damping) noexcept {
  const Mode mode = stiffest_mode(options);
  const double room = 4.0 - dt * dt * mode.stiffness - 2.0 * dt * mode.damping;
  return std::max(0.0, 0.25 * options.node_mass_kg * room / (dt * dt) - 2.0 * damping / dt);
}

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

}  // namespace

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
  if (number >= 1.0 && number <= most_substeps) return static_cast<int>(number);
  std::ostringstream message;
  message << "period_s is " << period_s << ", expected a time above 0 of at most " << most_substeps
          << " sub-steps of " << step_safety * stable_step(options) << " s";
  throw std::invalid_argument(message.str());
}

double coupling_limit(const LatticeOptions& options, double dt, double damping_n_s_per_m) {
  check(options);
  check("dt", dt, smallest, largest);
  check("damping_n_s_per_m", damping_n_s_per_m, 0.0, largest);
  return coupling_limit_unchecked(options, dt, damping_n_s_per_m);
}

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

// ---- cuts ----
// The cells around a point are numbered counter-clockwise from the south-west one; the point is corner (i +
// 2) % 4 of cell i. Within a cell, corners i and i ^ 1 share a side along x, i and 3 - i one along y, i and i
// ^ 2 a diagonal.

template <typename Real>
std::array<int, 4> Lattice<Real>::cells_around(int point) const noexcept {
  const int column = point % options_.columns, row = point / options_.columns;
  const auto living_or_none = [&](int c, int r) {
    if (c < 0 || c >= cell_columns_ || r < 0 || r >= options_.rows - 1) return -1;
    return corner(cell(c, r), 0) >= 0 ? cell(c, r) : -1;
  };
  return {living_or_none(column - 1, row - 1), living_or_none(column, row - 1), living_or_none(column, row),
          living_or_none(column - 1, row)};
}

/// For each of the cells around a point the first cell of its fan, or -1.
template <typename Real>
std::array<int, 4> Lattice<Real>::fans(const std::array<int, 4>& around) const noexcept {
  const auto uncut = [&](const std::vector<std::uint8_t>& cut, std::size_t owner) {
    return around[owner] >= 0 && cut[index(around[owner])] == 0;
  };
  const std::array<bool, 4> joined_to_next{
      uncut(cut_right_, 0) && around[1] >= 0, uncut(cut_up_, 1) && around[2] >= 0,
      uncut(cut_right_, 3) && around[2] >= 0, uncut(cut_up_, 0) && around[3] >= 0};
  std::array<int, 4> fan{};
  for (int i = 0; i < 4; ++i) fan[index(i)] = around[index(i)] >= 0 ? i : -1;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!joined_to_next[i]) continue;
    const auto [first, second] = std::minmax(fan[i], fan[(i + 1) % 4]);
    std::replace(fan.begin(), fan.end(), int{second}, int{first});
  }
  return fan;
}

/// Gives each fan of a point its own node, after a side or a cell there has gone.
template <typename Real>
void Lattice<Real>::split(int point) noexcept {
  const std::array<int, 4> around = cells_around(point);
  const std::array<int, 4> fan = fans(around);
  std::array<bool, 4> in_use{}, given{};
  for (int i = 0; i < 4; ++i) {
    if (fan[index(i)] >= 0) in_use[index(corner(around[index(i)], (i + 2) % 4) / points_)] = true;
  }
  for (int slot = 0; slot < 4; ++slot) {
    const std::size_t node = index(slot * points_ + point);
    if (corners_[node] != 0) --nodes_;
    corners_[node] = 0;
    if (!in_use[index(slot)]) ux_[node] = uy_[node] = vx_[node] = vy_[node] = Real(0);
  }
  for (int first = 0; first < 4; ++first) {
    if (fan[index(first)] != first) continue;
    const int old = corner(around[index(first)], (first + 2) % 4);
    int own = old;
    if (given[index(old / points_)]) {
      const auto unused = std::find(in_use.begin(), in_use.end(), false) - in_use.begin();
      own = static_cast<int>(unused) * points_ + point;
      for (auto* array : {&ux_, &uy_, &vx_, &vy_}) (*array)[index(own)] = (*array)[index(old)];
    }
    in_use[index(own / points_)] = given[index(own / points_)] = true;
    ++nodes_;
    for (int i = first; i < 4; ++i) {
      if (fan[index(i)] != first) continue;
      corner_node_[index(4 * around[index(i)] + (i + 2) % 4)] = own;
      ++corners_[index(own)];
    }
  }
}

/// Whether the sweep by rows computes the point: free, and all around it as in a whole lattice.
template <typename Real>
bool Lattice<Real>::regular(int point) const noexcept {
  if (pinned_[index(point)] != 0) return false;
  for (const int cell : cells_around(point)) {
    if (cell < 0) return false;
    for (int i = 0; i < 4; ++i) {
      if (corner(cell, i) >= points_) return false;
    }
  }
  return true;
}

template <typename Real>
auto Lattice<Real>::stencil_of(int node) const noexcept -> Stencil {
  Stencil stencil;
  stencil.node = node;
  const int quarters = corners_[index(node)];
  stencil.share = quarters == 0 || held(node) ? Real(0) : Real(4) / static_cast<Real>(quarters);
  const std::array<int, 4> around = cells_around(node % points_);
  for (int i = 0; i < 4; ++i) {
    const int cell = around[index(i)], own = (i + 2) % 4;
    const bool ours = cell >= 0 && corner(cell, own) == node;
    stencil.along_x[index(i)] = ours ? corner(cell, own ^ 1) : node;
    stencil.along_y[index(i)] = ours ? corner(cell, 3 - own) : node;
    stencil.across[index(i)] = ours ? corner(cell, own ^ 2) : node;
  }
  return stencil;
}

template <typename Real>
void Lattice<Real>::refresh(int point) noexcept {
  if (entry_[index(point)] < 0 && regular(point)) return;
  for (int node = point; node < node_limit(); node += points_) {
    int& entry = entry_[index(node)];
    if (entry < 0 && node != point && !alive(node)) continue;
    if (entry < 0) entry = irregular_nodes_++;
    stencils_[index(entry)] = stencil_of(node);
  }
}

template <typename Real>
void Lattice<Real>::refresh_around(int point) noexcept {
  const int column = point % options_.columns, row = point / options_.columns;
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, options_.rows - 1); ++r) {
    for (int c = std::max(column - 1, 0); c <= std::min(column + 1, options_.columns - 1); ++c) {
      refresh(r * options_.columns + c);
    }
  }
}

template <typename Real>
bool Lattice<Real>::cut_side(int cell, int neighbour) noexcept {
  if (!living(cell) || !living(neighbour)) return false;
  const auto [first, second] = std::minmax(cell, neighbour);
  const bool beside = second == first + 1 && second % cell_columns_ != 0;
  if (!beside && second != first + cell_columns_) return false;
  std::uint8_t& cut = (beside ? cut_right_ : cut_up_)[index(first)];
  if (cut != 0) return false;
  cut = 1;
  // The far end of the side is the upper right point of the first cell.
  const int far = (first / cell_columns_ + 1) * options_.columns + first % cell_columns_ + 1;
  const int near = beside ? far - options_.columns : far - 1;
  for (const int point : {near, far}) split(point);
  for (const int point : {near, far}) refresh_around(point);
  return true;
}

template <typename Real>
bool Lattice<Real>::remove_cell(int cell) noexcept {
  if (!living(cell)) return false;
  const int lower_left = cell / cell_columns_ * options_.columns + cell % cell_columns_;
  const int upper_left = lower_left + options_.columns;
  for (int i = 0; i < 4; ++i) corner_node_[index(4 * cell + i)] = -1;
  for (const int point : {lower_left, lower_left + 1, upper_left, upper_left + 1}) split(point);
  for (const int point : {lower_left, lower_left + 1, upper_left, upper_left + 1}) refresh_around(point);
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
  double energy = 0.0;
  for (int node = 0; node < node_limit(); ++node) {
    const Vector v = velocity(node);
    energy += 0.5 * mass(node) * (v[0] * v[0] + v[1] * v[1]);
  }
  return energy;
}

template <typename Real>
double Lattice<Real>::potential_energy() const noexcept {
  double side = 0.0, diagonal = 0.0, bedding = 0.0;
  for (int cell = 0; cell < cells(); ++cell) {
    if (!living(cell)) continue;
    std::array<Vector, 4> u;
    for (int i = 0; i < 4; ++i) {
      u[index(i)] = displacement(corner(cell, i));
      bedding += u[index(i)][0] * u[index(i)][0] + u[index(i)][1] * u[index(i)][1];
    }
    const auto squared = [](double strain) { return strain * strain; };
    side += squared(u[1][0] - u[0][0]) + squared(u[2][0] - u[3][0]);
    side += squared(u[3][1] - u[0][1]) + squared(u[2][1] - u[1][1]);
    diagonal += squared(u[2][0] - u[0][0] + u[2][1] - u[0][1]);
    diagonal += squared(u[1][0] - u[3][0] - u[1][1] + u[3][1]);
  }
  return options_.stiffness_n_per_m / 4.0 * side + options_.diagonal_stiffness_n_per_m / 4.0 * diagonal +
         options_.bedding_n_per_m / 8.0 * bedding;
}

template <typename Real>
bool Lattice<Real>::consistent() const {
  std::vector<int> carried(index(node_limit()));
  for (int cell = 0; cell < cells(); ++cell) {
    for (int i = 0; i < 4; ++i) {
      const int node = corner(cell, i);
      if ((node >= 0) != living(cell) || node < -1 || node >= node_limit()) return false;
      if (node < 0) continue;
      const int column = cell % cell_columns_ + (i == 1 || i == 2 ? 1 : 0);
      const int row = cell / cell_columns_ + (i >= 2 ? 1 : 0);
      if (node % points_ != row * options_.columns + column) return false;
      ++carried[index(node)];
    }
  }
  int living_nodes = 0;
  for (int node = 0; node < node_limit(); ++node) {
    const std::size_t n = index(node);
    living_nodes += alive(node) ? 1 : 0;
    if (carried[n] != corners_[n]) return false;
    if (!alive(node) && (ux_[n] != 0 || uy_[n] != 0 || vx_[n] != 0 || vy_[n] != 0)) return false;
    if (pull_x_[n] != 0.0 || pull_y_[n] != 0.0) return false;
    if (entry_[n] >= irregular_nodes_) return false;
    if (entry_[n] >= 0 && stencils_[index(entry_[n])] != stencil_of(node)) return false;
    const bool needs_entry = (alive(node) || node < points_) && (node >= points_ || !regular(node));
    if (needs_entry && entry_[n] < 0) return false;
  }
  if (living_nodes != nodes_) return false;
  for (int point = 0; point < points_; ++point) {
    const std::array<int, 4> around = cells_around(point), fan = fans(around);
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < i; ++j) {
        if (fan[index(i)] < 0 || fan[index(j)] < 0) continue;
        const bool one_node = corner(around[index(i)], (i + 2) % 4) == corner(around[index(j)], (j + 2) % 4);
        if (one_node != (fan[index(i)] == fan[index(j)])) return false;
      }
    }
  }
  return true;
}

template class Lattice<float>;
template class Lattice<double>;

}  // namespace kerf::models
