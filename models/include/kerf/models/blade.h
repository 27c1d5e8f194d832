#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <kerf/models/law_facts.h>
#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>
#include <kerf/models/rotation.h>
#include <kerf/models/spatial.h>
#include <kerf/models/two_thresholds.h>

namespace kerf::models {

/// Wrench or twist at a point: a vector and the moment, or angular velocity, that goes with it.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< at the hand point [N·m]
};
struct Twist {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< velocity of the hand point [m/s]
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< [rad/s]
};
struct Pose {
  Eigen::Vector3d hand = Eigen::Vector3d::Zero();          ///< hand point H [m]
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< of the tool's frame
};

/// A field of force per length of an edge and per area of a surface, against the velocity v of each point:
///
///     dF = -ke v dl,      dF = -(kn n n^T + kt (I - n n^T)) v ds
///
/// With displacements in place of velocities, the same field is elastic ([Henry2004], eq. 5).
struct BladeField {
  double edge = 0.0;        ///< ke [N·s/m² or N/m²]
  double normal = 0.0;      ///< kn [N·s/m³ or N/m³]
  double tangential = 0.0;  ///< kt
};

/// The shape of a blade in its own frame, whose origin is the hand point: one cutting edge and convex planar
/// polygons.
struct BladeShape {
  static constexpr std::size_t max_corners = 8;
  static constexpr std::size_t max_polygons = 8;

  struct Polygon {
    std::array<Eigen::Vector3d, max_corners> corner{};
    std::size_t corners = 0;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    Eigen::Vector3d across =
        Eigen::Vector3d::Zero();  ///< along the first side: strips lie side by side in that direction
  };
  std::array<Polygon, max_polygons> polygon{};
  std::size_t polygons = 0;
  std::array<Eigen::Vector3d, 2> edge{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  bool has_edge = false;

  /// Corners "x y z, x y z, ..." in metres, polygons divided by ";", and the two ends of the edge (empty: no
  /// edge). @throws std::invalid_argument: not numbers, fewer than 3 or more than 8 corners, more than 8
  /// polygons, not planar to 1e-6 of its size, not convex.
  static BladeShape parse(std::string_view polygons, std::string_view edge);
};

/// How the integrals over the blade are taken.
struct BladeFidelity {
  enum class Kind : std::uint8_t {
    paper,   ///< strips that all move with the velocity of the hand point ([Henry2004], eqs. 6-9): no torque
             ///< about the long axis
    strips,  ///< each strip moves with the velocity of the middle of its submerged length
    exact    ///< closed form in area, centroid and second moments of the submerged polygon
  };
  Kind kind = Kind::exact;
  std::size_t strips = 16;  ///< a polygon, for `paper` and `strips`
};

/// Wrench at the hand point of a field over the part of a blade that is under the plane z = 0.
///
/// `exact`: with r = p - c from the centroid c of the submerged polygon, v(p) = v_c + w x r is linear in r,
/// so
///
///     F   = -A K v_c
///     M_c = -(kt w_n tr(S) n + kn (S u) x n),   S = int r r^T ds,   u = n x w,   w_n = n . w
///
/// and for the submerged edge, of length d and direction t: F = -ke d v_c, M_c = -ke d^3/12 (w - t (t . w)).
/// No discretisation: it holds at any size, pose and twist.
[[nodiscard]] Wrench blade_wrench(const BladeShape& shape, const BladeField& field,
                                  const BladeFidelity& fidelity, const Pose& pose,
                                  const Twist& twist) noexcept;

/// Blade in a half-space of tissue z < 0: pose and twist of the hand point in, wrench at it out.
///
///     elastic:  the field of displacements since the tissue last held, until |F| > F1
///     cutting:  the viscous field, until |F| < F0 < F1
///
/// Without the option `thresholds` the blade always cuts. Axes: x, y, z [m] of the hand point, rx, ry, rz the
/// rotation vector of the tool's frame [rad]; its rates become the angular velocity by the left Jacobian of
/// the rotation, and the moment becomes the generalised torque of these axes by its transpose, so that force
/// times velocity is the power.
///
/// The hold. Let w = -S s be the wrench of the elastic field for a displacement s, and E = s.S s / 2 what the
/// field holds; S is that of the part that is submerged, in the tool's frame a constant but for that. The
/// strain s goes with the tool, ds = dp + the slip below, p the pose:
///
///     dE = s.S dp + s.dS s / 2 + s.S ds_slip
///
/// The first term is the work of the hand. The second nobody pays for where more of the blade comes to be
/// submerged. What comes to be submerged is not strained yet, so that the mean strain falls: by as much as
/// that part has of the whole,
///
///     ds_slip = -s (dE at constant s)+ / E
///
/// so that E falls where it would have risen, and never grows by more than the work. The force stays what it
/// was when unstrained blade comes in, and falls by its share when strained blade comes out. The option `form
/// = "paper"` takes s as the rigid motion since the tissue last held, R R_0^T as a rotation vector and the
/// path of the hand point, over whatever is submerged now: a hand that draws the blade along when shallow and
/// back when deep is given energy. The two agree where the wetted area stays, up to turns of the strain. Not
/// passive in either form is `fidelity = "paper"`, whose wrench does not know how a turn moves the blade.
///
/// Source: [Henry2004], eqs. 3-9 and section 3.5; differs from the paper in the slip, in the fidelities
/// `strips` and `exact`, and in the split of K'v into Kn and Kt, which the paper gives as a function of
/// direction without numbers.
struct Blade {
  static constexpr std::string_view name = "blade";
  static constexpr std::string_view equation = "dF = -Kv v dl - (Kn n n^T + Kt (I - n n^T)) v ds, z < 0";
  static constexpr LawFacts facts{.search = Search::blade, .fineness = Fineness::strips};

  BladeField viscous;
  BladeField elastic;
  TwoThresholds thresholds;
  bool has_thresholds = false;
  bool paper = false;  ///< the hold does not slip
  BladeFidelity fidelity;
  BladeShape shape;

  struct State {
    TwoThresholds::State mode;
    bool in_tissue = false;
    Pose anchor;            ///< where the tissue began to hold; unless `paper`, where the last tick was
    Twist strain;           ///< s in the tool's frame; unused by `paper`
    double stored_j = 0.0;  ///< E
  };

  static std::vector<LawAxis> axes();
  static std::vector<OptionInfo> options();
  static std::vector<ParameterInfo> parameters(const Options& given);
  static Blade make(std::span<const double> values, const Options& given);

  /// E while the tissue holds [J]; none while it is cut.
  [[nodiscard]] double stored_energy(const State& state) const noexcept { return state.stored_j; }

  /// One tick in the frame of the tissue; blade_wrench() with the state machine around it.
  Wrench step(State& state, const Pose& pose, const Twist& twist) const noexcept;

  AxisValues step(State& state, const SpatialMotion& motion, double period_s) const noexcept;

  /// Whether any point of the blade is under the plane.
  [[nodiscard]] bool touches(const Pose& pose) const noexcept;

 private:
  /// The strain at a pose, in the tissue's frame, after what came to be submerged has diluted it.
  [[nodiscard]] Twist carried_strain(const State& state, const Pose& pose) const noexcept;
  /// Wrench of the hold, whose strain and energy go into the state.
  Wrench hold(State& state, const Pose& pose) const noexcept;
  static void begin_to_hold(State& state, const Pose& pose) noexcept;
};

}  // namespace kerf::models
