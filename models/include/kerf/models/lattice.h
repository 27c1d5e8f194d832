#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace kerf::models {

struct LatticeOptions {
  int columns = 100;                         ///< grid points along x, 2 to 1000
  int rows = 100;                            ///< grid points along y, 2 to 1000
  double spacing_m = 1e-3;                   ///< h between grid points, > 0
  double stiffness_n_per_m = 100.0;          ///< k of a spring along a side, > 0
  double diagonal_stiffness_n_per_m = 50.0;  ///< kd of a spring along a diagonal, >= 0
  double node_mass_kg = 1e-5;                ///< m of a whole node: area density times h^2, > 0
  double damping_time_s = 1e-4;              ///< tau_d: a spring's force is k (u + tau_d v), >= 0
  double bedding_n_per_m = 0.0;              ///< kb to the ground per whole node, >= 0
  double bedding_time_s = 0.0;               ///< tau_b: the bedding's force is kb (u + tau_b v), >= 0
};

/// Largest stable step of a lattice [s], whatever is cut from it or pinned in it:
///
///     dt^2 (s + kb/m) + 2 dt (s tau_d + kb/m tau_b) <= 4,   s = 4 (k + 2 kd) / m
///
/// s is the largest squared frequency of one free cell (its breathing mode; the others have 4 k/m, 8 kd/m or
/// 0), and bounds every assembly of cells: u'Ku / u'Mu = sum of the cells' u'Kc u over sum of their u'Mc u is
/// a mediant of Rayleigh quotients <= s, and pinning only narrows the u to choose from. Bedding adds kb/m to
/// every mode, as each corner has the same share of bedding as of mass. A lattice cut into single cells
/// reaches the limit; a whole one with k = kd is stable up to 1.19 times it without damping. With a
/// coupling it is coupling_limit() solved for dt. Throws std::invalid_argument where an option is out of
/// range.
[[nodiscard]] double stable_step(const LatticeOptions& options, double coupling_stiffness_n_per_m = 0.0,
                                 double coupling_damping_n_s_per_m = 0.0);

/// Share of the stable step that sub-steps are made of.
inline constexpr double step_safety = 0.9;

/// Sub-steps into which a period [s] is split, so that each is at most 0.9 of the stable step.
[[nodiscard]] int substeps(const LatticeOptions& options, double period_s);

/// Largest stiffness [N/m] of a coupling with the given damping [N s/m] at which steps of dt stay stable,
///
///     kc = (4 - dt^2 (s + kb/m) - 2 dt (s tau_d + kb/m tau_b)) m / (4 dt^2) - 2 bc / dt
///
/// and 0 where there is none. It holds for the lightest node that cuts can leave (one corner, m/4), hence for
/// every node and after any cut: dt^2 K + 2 dt C <= 4 M suffices for symmetric K and C, and the coupling adds
/// to the left side at one node only. Couplings at the same node count together.
[[nodiscard]] double coupling_limit(const LatticeOptions& options, double dt, double damping_n_s_per_m = 0.0);

/// A virtual coupling: a spring and damper from one node to a tool whose motion within the tick is linear.
struct Coupling {
  int node = -1;  ///< at a node that is not alive the coupling does nothing
  double stiffness_n_per_m = 0.0;
  double damping_n_s_per_m = 0.0;
  std::array<double, 2> target_m{};  ///< where the tool wants the node's displacement, at the tick's start
  std::array<double, 2> velocity_m_per_s{};  ///< of the target, during the tick
  std::array<bool, 2> along{true, true};     ///< the axes (x, y) in which it pulls
  std::array<double, 2> force_n{};           ///< result: on the tool, mean over the tick's sub-steps
};

/// A plane lattice of springs, dampers and point masses that can be cut (the mesh of trussed squares of
/// [Weiss2004]), for small displacements u about a grid of points:
///
///     m v' = f(u + tau_d v) - kb (u + tau_b v),   u' = v
///
/// f is linear: every spring acts along its direction at rest. All of it belongs to cells, the squares of
/// four grid points: a living cell gives each of its sides half a spring (k/2, so k between two cells), its
/// two diagonals one spring kd each, and each of its corners m/4 and kb/4. A cut therefore neither makes nor
/// loses mass or stiffness, and keeps within the stable step; removing a cell takes its own share and no
/// more.
///
/// A node is what moves. Around a grid point the living cells that hang together through uncut sides form
/// fans, and each fan owns one node, hence up to four at a point. Where a cut splits a fan, the new node
/// starts with the old one's displacement and velocity; a node whose fan is gone is dead, at rest, and its
/// index may be used again at the same point. Nodes 0 to points - 1 are those of the whole lattice, row by
/// row.
///
/// Time steps are semi-implicit Euler: v += dt a(u, v), then u += dt v. Whole surroundings are computed by
/// rows with a constant stencil; borders, pins and the banks of cuts by a list of nodes with their
/// neighbours, which a cut updates only around itself. The constructor takes all memory (some 450 bytes a
/// grid point in float, 620 in double); afterwards no step and no cut allocates. While it steps on x86,
/// numbers below the normal range count as zero: a bedded lattice come to rest is full of them, and took a
/// hundred times as long.
template <typename Real>
class Lattice {
 public:
  using Vector = std::array<double, 2>;

  /// Whole, at rest and free. Throws std::invalid_argument where an option is out of range.
  explicit Lattice(const LatticeOptions& options);

  /// Whole and at rest again; pins stay.
  void reset() noexcept;

  /// Advances by `substeps` steps of dt [s] and sets the couplings' forces. Stability is the caller's to ask
  /// for at set-up: `stable_step` and `admits`.
  void step(double dt, int substeps, std::span<Coupling> couplings = {}) noexcept;

  /// Whether a coupling is within `coupling_limit` for steps of dt.
  [[nodiscard]] bool admits(const Coupling& coupling, double dt) const noexcept;

  /// Holds the nodes of a grid point where they are, also those that a cut makes of them. False outside the
  /// grid.
  bool pin(int column, int row) noexcept;

  /// Cuts the side between two living cells. False, and nothing changes, where there is no such side or no
  /// longer.
  bool cut_side(int cell, int neighbour) noexcept;
  /// Removes a cell with its springs and its share of mass. False where there is no such cell or no longer.
  bool remove_cell(int cell) noexcept;

  [[nodiscard]] const LatticeOptions& options() const noexcept { return options_; }
  /// Cells are numbered row by row from the origin, also dead ones.
  [[nodiscard]] int cells() const noexcept { return cell_columns_ * (options_.rows - 1); }
  [[nodiscard]] int cell(int column, int row) const noexcept { return row * cell_columns_ + column; }
  [[nodiscard]] bool living(int cell) const noexcept { return valid(cell) && corner(cell, 0) >= 0; }
  /// Node at a corner of a cell from 0 to cells() - 1: 0 lower left, 1 lower right, 2 upper right, 3 upper
  /// left; -1 if the cell is dead.
  [[nodiscard]] int node(int cell, int corner_index) const noexcept { return corner(cell, corner_index); }

  /// Number of nodes alive; their indices are below `node_limit`.
  [[nodiscard]] int nodes() const noexcept { return nodes_; }
  [[nodiscard]] int node_limit() const noexcept { return 4 * points_; }
  [[nodiscard]] bool alive(int node) const noexcept { return corners_[index(node)] != 0; }

  [[nodiscard]] double mass(int node) const noexcept;      ///< [kg]
  [[nodiscard]] Vector position(int node) const noexcept;  ///< from the origin, displacement included [m]
  [[nodiscard]] Vector displacement(int node) const noexcept;
  [[nodiscard]] Vector velocity(int node) const noexcept;
  /// Force of springs, dampers and bedding on a node as it is now [N].
  [[nodiscard]] Vector force(int node) const noexcept;
  void set_displacement(int node, const Vector& displacement_m) noexcept;
  void set_velocity(int node, const Vector& velocity_m_per_s) noexcept;

  [[nodiscard]] double kinetic_energy() const noexcept;
  [[nodiscard]] double potential_energy() const noexcept;  ///< of springs and bedding
  /// What no step of dt within the limit lets grow, and none changes where nothing damps:
  ///
  ///     v'Mv / 2 + u'K(u - dt v) / 2 - dt v'Cv / 4
  ///
  /// The energy at which leapfrog sees the lattice; for dt = 0 the sum of the two above.
  [[nodiscard]] double energy(double dt) const noexcept;

  /// Whether every invariant of the cells, fans, nodes and stencils holds. Slow: for tests.
  [[nodiscard]] bool consistent() const;

 private:
  /// Neighbours of an irregular node in the cells around it (south-west, south-east, north-east, north-west):
  /// along the side in x, along the side in y, across the diagonal. The node itself stands where a cell is
  /// not of its fan.
  struct Stencil {
    int node = -1;
    Real share{};  ///< mass of a whole node over this one's; 0 for a node that is held or dead
    std::array<int, 4> along_x{}, along_y{}, across{};
    bool operator==(const Stencil&) const = default;
  };
  struct Moved {
    Real ux, uy, vx, vy;
  };
  struct Row {
    Real *x, *y, *sum, *difference;
  };
  /// dt, dt k/m, dt kd/2m, dt kb/m, tau_d, tau_b
  struct Coefficients {
    Real dt, side, diagonal, bedding, spring_time, bedding_time;
  };
  static constexpr std::size_t index(int i) noexcept { return static_cast<std::size_t>(i); }
  [[nodiscard]] bool valid(int cell) const noexcept { return cell >= 0 && cell < cells(); }
  [[nodiscard]] int corner(int cell, int i) const noexcept { return corner_node_[index(4 * cell + i)]; }

  [[nodiscard]] std::array<int, 4> cells_around(int point) const noexcept;
  [[nodiscard]] std::array<int, 4> fans(const std::array<int, 4>& around) const noexcept;
  [[nodiscard]] bool regular(int point) const noexcept;
  [[nodiscard]] bool held(int node) const noexcept { return pinned_[index(node % points_)] != 0; }
  [[nodiscard]] Stencil stencil_of(int node) const noexcept;
  void split(int point) noexcept;
  void refresh(int point) noexcept;
  void refresh_around(int point) noexcept;

  /// Sums that stiffnesses make an energy of: of u w - share (u - w)^2, where u is a strain now, w that of a
  /// step before, and the share a damping time over 2 dt.
  struct Strains {
    double side = 0.0, diagonal = 0.0;
  };
  /// dt, and the shares of springs and bedding.
  struct StepBefore {
    Real dt, spring, bedding;
  };
  [[nodiscard]] StepBefore step_before(double dt) const noexcept;
  [[nodiscard]] Strains strains_of(int cell, const StepBefore& by) const noexcept;
  [[nodiscard]] double spring_energy(double dt) const noexcept;
  [[nodiscard]] Vector node_energy(double dt) const noexcept;  ///< of motion, of the bedding
  [[nodiscard]] Coefficients coefficients(double dt) const noexcept;
  Row row_buffer(int row) noexcept;
  [[nodiscard]] Moved irregular(const Stencil& stencil, const Coefficients& by) const noexcept;
  void weigh(int row, Real spring_time) noexcept;
  void update(int row, const Coefficients& by) noexcept;
  void substep(const Coefficients& by) noexcept;
  void pull(Coupling& coupling, double time_s) noexcept;
  void kick(const Coupling& coupling, double dt) noexcept;

  LatticeOptions options_;
  int points_ = 0;
  int cell_columns_ = 0;
  int nodes_ = 0;
  // By node: slot s of point p is node s * points_ + p.
  std::vector<Real> ux_, uy_, vx_, vy_;
  std::vector<double> pull_x_, pull_y_;  ///< of the couplings, in the present sub-step
  std::vector<std::uint8_t> corners_;    ///< cells' corners that the node carries: mass in quarters
  std::vector<int> entry_;               ///< place in stencils_, or -1
  // By point, by cell.
  std::vector<std::uint8_t> pinned_;
  std::vector<std::uint8_t> cut_right_, cut_up_;  ///< the cell's right and upper side
  std::vector<int> corner_node_;                  ///< four a cell
  std::vector<std::uint8_t> whole_row_;           ///< of cells, all on nodes of the whole lattice
  // Irregular nodes, in the order in which they became so.
  std::vector<Stencil> stencils_;
  std::vector<Moved> next_;
  int irregular_nodes_ = 0;
  std::vector<Real> row_buffers_;  ///< u + tau_d v of three rows
};

extern template class Lattice<float>;
extern template class Lattice<double>;

}  // namespace kerf::models
