#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include <kerf/identification/output_error.h>
#include <kerf/identification/shots.h>

namespace kerf::identification {

/// gamma^2 of two signals, 0 to 1, with its interval of 95 %.
struct Coherence {
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
};

/// gamma^2 = |S_xr|^2 / (S_xx S_rr), with the interval of artanh(gamma), whose standard error is (2 n)^-1/2
/// [BendatPiersol2010]; n counts what is independent. 0 where a signal has nothing at this frequency.
[[nodiscard]] Coherence coherence_of(std::complex<double> cross, double one, double other,
                                     std::size_t independent);

/// How an axis answers at one frequency.
struct ResponseLine {
  double frequency_hz = 0.0;
  std::complex<double> response;  ///< position over commanded force [m/N]
  Coherence coherence;            ///< of position and excitation
  double relative_error = 0.0;    ///< standard error of the response over its size; from the coherence
};

/// Discrete Fourier coefficients of a period, at lines 0, 1, ..., `count` - 1: X_k = sum x_n exp(-2 pi i k n
/// / N).
[[nodiscard]] std::vector<std::complex<double>> coefficients(std::span<const double> values,
                                                             std::size_t count);

/// The frequency response at the excited lines, over all periods of all stretches:
///
///     G = S_xr / S_ur,   gamma^2 = |S_xr|^2 / (S_xx S_rr)
///
/// r is the excitation alone, u what was commanded with all that was fed back, x the position. Noise that the
/// feedback brings into u does not know r, so it is in neither cross spectrum: the loop biases nothing
/// [PintelonSchoukens2012]. Spectra are means over periods of whole length, without a window; the trend
/// between the ends of a period is taken off. The coherence's interval counts the stretches, because the
/// periods of one may repeat each other.
[[nodiscard]] std::vector<ResponseLine> frequency_response(const AxisData& data,
                                                           std::span<const double> excitation_n,
                                                           std::span<const Stretch> stretches,
                                                           std::span<const std::size_t> lines);

/// The model of the axis from the frequency domain.
struct FrequencyFit {
  PlacedModel model;
  Eigen::MatrixXd covariance;  ///< of mass, viscous, coulomb, stiffness, delay
  double degrees_of_freedom = 0.0;
  double compliance_m_per_n = 0.0;  ///< what gives at once beyond the model: a structure's 1 / stiffness
  double compliance_error_m_per_n = 0.0;  ///< its standard error

  [[nodiscard]] double half_width(std::size_t parameter) const;
};

/// Least squares of the position's coefficients at the excited lines, averaged over the periods of a stretch
/// after its first, on those of the exact sampled model:
///
///     X = H_0(z) (z^-D (W_b(d) z^-1 + W_a(d)) U + F) - C (zI - A)^-1 (M T / m, 0)
///         + C (zI - A)^-1 z (s_0 - s_N),   z = exp(i w T)
///
/// with the delayed command in two parts of a tick, the state at both ends of the period (two numbers a
/// stretch, eliminated), and the force of friction in each tick, F = f P its mean and M = f Q its moment
/// about the middle, whose patterns P and Q are those of the motion of the time domain's model. What weighs
/// is another part of the data than in the time domain: no reading between the lines, and means over periods.
/// Covariance: that of the jackknife over the stretches. Numbers are NaN where nothing is told: of a single
/// stretch, of a fit that does not come to rest, and of the friction of an axis whose motion has none in the
/// time domain.
[[nodiscard]] FrequencyFit fit_frequencies(const AxisData& data, std::span<const Stretch> stretches,
                                           std::span<const std::size_t> lines, const OutputErrorFit& time,
                                           const FitOptions& options = {});

}  // namespace kerf::identification
