#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <kerf/identification/axis_model.h>

namespace kerf::identification {

/// What an axis was told and what was read of it, a value a tick, in travel and force along it.
struct AxisData {
  double period_s = 1e-3;
  std::vector<double> position_m;   ///< NaN where there was no reading
  std::vector<double> commanded_n;  ///< as the device got it after the reading of the same tick
};

/// Readings that are simulated in one piece, from a motion of their own at their begin.
struct Shot {
  std::size_t begin = 0;
  std::size_t count = 0;
  std::size_t cluster = 0;  ///< shots of one cluster may err together: they repeat each other
  std::size_t place = 0;    ///< whose constant force acts
};

/// Numbers of the model that are estimated, in this order; then the offset of each place.
enum class Parameter : std::uint8_t { mass, viscous, coulomb, stiffness, delay, saturation };
inline constexpr std::size_t shared_parameters = 6;
inline constexpr std::array all_parameters{Parameter::mass,      Parameter::viscous, Parameter::coulomb,
                                           Parameter::stiffness, Parameter::delay,   Parameter::saturation};

/// The model, with a constant force for each place.
struct PlacedModel {
  AxisModel axis;  ///< its offset counts for nothing
  std::vector<double> offset_n{0.0};

  [[nodiscard]] AxisModel at(std::size_t place) const noexcept {
    AxisModel here = axis;
    here.offset_n = offset_n[place];
    return here;
  }
};
[[nodiscard]] double value_of(const AxisModel& model, Parameter parameter) noexcept;
[[nodiscard]] double& value_of(AxisModel& model, Parameter parameter) noexcept;

struct FitOptions {
  bool fit_friction = true;   ///< false: f stays as it is
  bool fit_stiffness = true;  ///< false: k stays as it is
  /// A saturation is estimated where the model begins with one; false: it stays as it is.
  bool fit_saturation = true;
  int iterations = 40;
};

/// The model that predicts readings best from commands that are known without error.
struct OutputErrorFit {
  PlacedModel model;
  /// Of mass, viscous, coulomb, stiffness, delay, saturation and the offsets; zero where one was not
  /// estimated.
  Eigen::MatrixXd covariance;
  double degrees_of_freedom = 0.0;     ///< of that covariance
  double rms_m = 0.0;                  ///< of the residuals
  std::vector<double> residual_m;      ///< a value a tick of the data; NaN outside of the shots
  std::vector<double> simulated_m;     ///< likewise
  std::vector<TickFriction> friction;  ///< of the tick that begins there; NaN outside of the shots
  std::vector<Motion> begins;          ///< of the shots
  bool converged = false;

  [[nodiscard]] double standard_error(std::size_t parameter) const;
  /// Half of the interval of 95 % of a parameter, by Student's t.
  [[nodiscard]] double half_width(std::size_t parameter) const;
};

/// Least squares of x - x(theta) over all shots [Ljung1999], by Gauss and Newton's steps with Marquardt's
/// damping. The state at the begin of each shot is estimated with the shot and eliminated.
///
/// The excitation is known to the bench, and so is what its own spring added: the force that the device got.
/// The axis answers to that force alone, so what was fed back from noisy readings does not bias the result as
/// long as the noise of a reading does not know that of the one before; rounding by an encoder in motion does
/// not, to a fraction of the encoder's step.
///
/// Covariance: that of the jackknife over clusters, by one step each [ShaoTu1995],
///
///     H^-1 (sum_c g_c g_c') H^-1 (C - 1) / C,   g_c = (I - H_c H^-1)^-1 J_c' r_c
///
/// It asks neither for white noise nor for an equal one, and forces that nobody commanded (a hand, a delay
/// that jitters) are in it as far as a shot lets them grow.
/// @throws std::invalid_argument if there are fewer clusters than parameters and two.
[[nodiscard]] OutputErrorFit fit_output_error(const AxisData& data, std::span<const Shot> shots,
                                              const PlacedModel& start, const FitOptions& options = {});

/// Residuals of a model over shots whose begins alone are fitted: what it predicts of other data.
[[nodiscard]] OutputErrorFit predict(const AxisData& data, std::span<const Shot> shots,
                                     const PlacedModel& model);

}  // namespace kerf::identification
