#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include <kerf/models/lattice.h>
#include <kerf/models/law_facts.h>
#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>
#include <kerf/models/scissors.h>
#include <kerf/models/spatial.h>

namespace kerf::models {

/// How long a tick of a loop is, learned from the times that it steps by: the shortest median of three in
/// succession. Neither a late tick nor the short one after it passes for the nominal one.
class NominalTick {
 public:
  /// After a tick of this length [s].
  double after(double period_s) noexcept {
    if (last_s_[1] == 0.0) last_s_ = {period_s, period_s};
    const auto [least, most] = std::minmax(last_s_[0], last_s_[1]);
    shortest_s_ = std::min(shortest_s_, std::clamp(period_s, least, most));
    last_s_ = {last_s_[1], period_s};
    return shortest_s_;
  }

 private:
  std::array<double, 2> last_s_{};
  double shortest_s_ = std::numeric_limits<double>::infinity();
};

/// Scissors in a slab of tissue, by two lattices.
///
/// The slab lies in the plane of x (the direction of the cut) and y, its near border at x_m, its other three
/// borders held. Its front node is the one on the middle line where the slab is still whole. Where the
/// cutting point x_s + x_c(theta) pushes against it, a virtual coupling (spring kc, damper bc) moves the node
/// and gives the force on x_s; it never pulls the scissors forward.
///
/// The strip is one element thick (h) and lies in the plane of the scissors, x and z. It is made at the front
/// node when the blades begin to close on it, and destroyed at the end of the cut. Both blades press its
/// nodes to half the gap z(theta, x) between them; an element breaks once its front nodes are squeezed by
/// more than the break deflection or the blades have met there, and the cut advances by one node. Where the
/// blades are already closer than h when it is made, a column meets them at their gap of then: a strip begins
/// without energy. It stands still, and its forces do not load the slab, which feels the cutting point alone.
/// By virtual work its forces f on one blade are felt as
///
///     f_h = 1/l_h sum 2 f dz/dtheta,   f_t = sum 2 f dz/dx_s,   z = x tan psi - t'/cos psi,
///     2 dz/dtheta = (x - t' sin psi) / cos^2 psi   (= x for closed blades),   dz/dx_s = -tan psi
///
/// psi = theta/2 + atan kappa, t' the distance of a cutting edge from the pivot, x the distance of a node
/// from it. A cut ends when the scissors are closed, begin to open or reach the end of the slab or strip; the
/// slab is then split from where the cut began to its front.
///
/// Both lattices take semi-implicit Euler steps, as many a tick as their stiffest spring and their couplings
/// need (stable_step()). The option `substeps` says how many of the slab there are in a nominal tick
/// (NominalTick), and may be too few; a longer tick has more, so that none is longer than asked for by more
/// than 1 %.
///
/// A tick advances the mesh by at most two nominal ticks and 1000 stable sub-steps, however long it was, so
/// that the catching up of a law that keeps within half a period never costs the next deadline. For the rest
/// of the time the mesh is held: waves and relaxation of it come later by as much. What the tool opened or
/// drew back meanwhile the mesh sees at once, so that nothing is felt where there is no contact any more.
/// What it closed or went forward the mesh sees in the time advanced if that takes no more than 10 rad/s and
/// 0.5 m/s (about what a hand does) or twice the tool's own speed; else the blades that it sees follow at
/// that speed over the next ticks. Until they have caught up the forces are those of a tool that trails by so
/// much, and elements break one after the other as under a quick hand. A mesh that needs more than 1000
/// sub-steps in a nominal tick is held in every one: slower than it should be, and stable.
///
/// Axes: theta [rad], force in N at the handle, and x_s [m]. Source: [Weiss2004], section 2; differs from the
/// paper in sub-steps, in the virtual work and in borders that are held, of which the paper does not speak.
struct ScissorsMesh {
  static constexpr std::string_view name = "scissors_mesh";
  static constexpr std::string_view equation = "slab and strip of springs, cut node by node";
  static constexpr LawFacts facts{.fineness = Fineness::nodes};

  LatticeOptions slab;
  LatticeOptions strip;
  double coupling_stiffness = 0.0;  ///< kc [N/m]
  double coupling_damping = 0.0;    ///< bc [N·s/m]
  double contact_stiffness = 0.0;   ///< of the blades against the strip [N/m]
  double contact_damping = 0.0;     ///< and its damping [N·s/m]
  double break_deflection_m = 0.0;
  double edge_m = 0.0;  ///< x_m
  double lever_m = 0.28 / 7.58;
  double opening_speed = 0.0;  ///< faster than this ends a cut [rad/s]
  int fixed_substeps = 0;      ///< of the slab in a nominal tick; 0: as many as needed
  double slab_step_s = 0.0;    ///< largest stable one with the coupling
  double strip_step_s = 0.0;   ///< with the blades' contact
  CuttingPoint point;

  /// Where the blades are. Within a tick they move linearly from the last one's place.
  struct Blades {
    double theta = 0.0;
    double x_s = 0.0;
    double x_c = 0.0;  ///< distance of the cutting point from the pivot
    bool cut = false;  ///< they have a cutting point at this angle
  };

  struct State {
    Lattice<float> slab;
    Lattice<float> strip;
    NominalTick nominal;
    double advance_s = 0.0;  ///< by which this tick advances the lattices
    int slab_substeps = 1;   ///< of it
    int strip_substeps = 1;
    Blades before;           ///< that the mesh saw in the last tick
    bool started = false;    ///< there was one
    bool trails = false;     ///< they are not yet where the tool is
    double coupled_j = 0.0;  ///< energy of the couplings that push
    bool cutting = false;
    int begun = 0;                     ///< column of the slab at which the cut began
    int front = 0;                     ///< column up to which it is cut
    int strip_front = 0;               ///< column of the strip
    double strip_origin_m = 0.0;       ///< where its first column stands, from the pivot at x_s = 0
    std::vector<double> strip_half_m;  ///< half the gap at which each of its columns meets the blades
    std::uint32_t cuts = 0;            ///< sides split so far
  };

  static std::vector<LawAxis> axes() { return {{"theta", "rad", "N"}, {"x_s", "m", "N"}}; }
  static std::vector<OptionInfo> options();
  static std::vector<ParameterInfo> parameters(const Options& given);
  static ScissorsMesh make(std::span<const double> values, const Options& given);

  /// Takes all memory.
  [[nodiscard]] State initial_state() const;
  AxisValues step(State& state, const SpatialMotion& motion, double period_s) const noexcept;

  /// Energy of both lattices, motion included, and of the couplings between them and the tool [J]: goes
  /// through all nodes, a quarter of what a tick of 10,000 nodes takes. Closing also moves the cutting point
  /// against the slab, which the handle does not feel: what the slab gains by it nobody paid for.
  [[nodiscard]] double stored_energy(const State& state) const noexcept;

  /// Sub-steps of the slab in a nominal tick.
  [[nodiscard]] int substeps(double period_s) const noexcept;

 private:
  [[nodiscard]] int middle_row() const noexcept { return (slab.rows - 1) / 2; }
  [[nodiscard]] int front_node(const State& state) const noexcept;
  [[nodiscard]] double front_position(const State& state) const noexcept;
  /// What the mesh sees of the tool.
  struct Seen {
    Blades blades;
    double rate = 0.0;  ///< of the angle [rad/s]
  };
  void choose_substeps(State& state, double period_s) const noexcept;
  [[nodiscard]] Blades blades_at(double theta, double x_s) const noexcept;
  Seen follow(State& state, const SpatialMotion& motion, double period_s) const noexcept;
  double push_slab(State& state, const Blades& blades) const noexcept;
  void begin_cut(State& state, const Blades& blades) const noexcept;
  AxisValues squeeze_strip(State& state, const Blades& blades) const noexcept;
  void break_elements(State& state, const Blades& blades) const noexcept;
  void end_cut(State& state) const noexcept;
};

}  // namespace kerf::models
