#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <kerf/fitting/jnd.h>

#include "stability/maps.h"

namespace kerf::bench {

/// A spring K held by a sampled device, in the numbers of Diolaiti and others [Diolaiti2006]:
///
///     viscous b / (K T),  coulomb f_c / (K delta)
///
/// with the device's own friction b and f_c, the period T and the encoder step delta. What is left of the
/// system then is stiffness K T^2 / M, and the delay t_d / T.
struct PlanePoint {
  double viscous = 0.0;
  double coulomb = 0.0;  ///< infinite without encoder steps
};

/// Where a device stands with a wall of `stiffness` [N/m].
[[nodiscard]] PlanePoint plane_point(const SampledDevice& device, double stiffness) noexcept;
/// The other way round: the device, with the friction at which that wall stands there.
[[nodiscard]] SampledDevice device_at(PlanePoint point, const SampledDevice& device, double stiffness);

/// The lines of the plane. A spring held from tick to tick, late by t_d, gives K (T / 2 + t_d) v^2 to a slow
/// motion, and viscous friction takes b v^2:
///
///     b / (K T) >= 1/2 + t_d / T
///
/// At rest between two steps of the encoder the nearest forces of the wall are K delta / 2 away from what it
/// should be, and Coulomb friction holds as much:
///
///     f_c / (K delta) >= 1/2
struct PlaneLines {
  double viscous = 0.5;
  double coulomb = 0.5;
};
[[nodiscard]] PlaneLines plane_lines(const SampledDevice& device) noexcept;

/// What the lines divide the plane into.
enum class PlaneRegion : std::uint8_t {
  passive,        ///< beyond both: no energy is given, all motion ends
  bounded_cycle,  ///< viscous enough: encoder steps feed a limit cycle as small as they are
  locked,         ///< Coulomb friction stops small motions; large ones grow
  unstable        ///< within both
};
[[nodiscard]] PlaneRegion plane_region(PlanePoint point, PlaneLines lines) noexcept;
[[nodiscard]] std::string_view name_of(PlaneRegion region) noexcept;

/// What a simulated wall did.
enum class PlaneBehaviour : std::uint8_t {
  dies_away,    ///< from a few steps and from far
  locked,       ///< from a few steps; from far it grows
  small_cycle,  ///< a limit cycle that a hand does not feel
  cycle,        ///< one that it feels
  grows
};
inline constexpr std::array plane_behaviours{PlaneBehaviour::dies_away, PlaneBehaviour::locked,
                                             PlaneBehaviour::small_cycle, PlaneBehaviour::cycle,
                                             PlaneBehaviour::grows};
[[nodiscard]] std::string_view name_of(PlaneBehaviour behaviour) noexcept;
/// @throws std::invalid_argument for no such name.
[[nodiscard]] PlaneBehaviour plane_behaviour_named(std::string_view name);
/// Whether a behaviour is what a region says.
[[nodiscard]] bool agree(PlaneBehaviour behaviour, PlaneRegion region) noexcept;

/// How a point is tried: two-sided, with a constant push of half a step's force, so that the balance lies
/// between two steps of the encoder, where no reading is right; begun at rest so many steps away from it.
struct PlaneTrial {
  double near_steps = 3.0;
  double far_steps = 1000.0;
  double felt_n = fitting::force_jnd.threshold;  ///< rms of a force about its mean that a hand feels
};

/// A motion about its balance goes on from where the energy that the wall gives a swing of amplitude A is
/// what Coulomb friction takes, pi w A^2 (K (T/2 + t_d) - b) = 4 f_c A. In the plane, for small K T^2 / M:
///
///     b / (K T) = 1/2 + t_d / T - 4 f_c / (pi K delta sqrt(K T^2 / M) A / delta)
[[nodiscard]] double swing_line(const SampledDevice& device, double stiffness, double coulomb,
                                double amplitude_steps) noexcept;

/// Simulates a device, as it is, with a wall of `stiffness` [N/m]. @throws std::invalid_argument without an
/// encoder step.
[[nodiscard]] PlaneBehaviour plane_behaviour(const SampledDevice& device, double stiffness,
                                             const PlaneTrial& trial = {});

/// Behaviour over the plane, and of a device with walls.
struct PlaneMap {
  SampledDevice device;
  double stiffness_n_per_m = 0.0;  ///< of the map: for other walls K T^2 / M differs
  PlaneTrial trial;
  Grid2 grid;                         ///< viscous (columns) and coulomb (rows)
  std::vector<PlaneBehaviour> cells;  ///< row by row
  struct Wall {
    double stiffness_n_per_m = 0.0;
    PlanePoint at;
    PlaneBehaviour behaviour = PlaneBehaviour::dies_away;  ///< with its own K T^2 / M
  };
  std::vector<Wall> walls;

  /// Share of the cells that did what their region says.
  [[nodiscard]] double agreement() const;
};

/// `stiffnesses`: of the device's own points; the map is that of the first. The grid reaches from 0.05 to 5
/// and to all points. @throws std::invalid_argument as plane_behaviour() and check(); std::system_error if it
/// was stopped.
[[nodiscard]] PlaneMap plane_map(const SampledDevice& device, std::span<const double> stiffnesses,
                                 std::size_t cells, const PlaneTrial& trial, const MapOptions& options);

}  // namespace kerf::bench
