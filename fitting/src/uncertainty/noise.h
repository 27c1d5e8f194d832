#pragma once

#include <vector>

#include <Eigen/Core>

#include "uncertainty/blocks.h"

namespace kerf::fitting {

/// A recursive filter of first order, (1 - zero B) / (1 - pole B), B the shift by one.
struct Pair {
  double zero;
  double pole;
};

/// Stationary autoregressive noise, e_t + a_1 e_{t-1} + ... + a_q e_{t-q} = w_t, w white of variance s^2.
/// Kept as reflection coefficients, each within (-1, 1), so that it is always stable.
struct Autoregression {
  std::vector<double> reflections;
  std::vector<Pair> flicker;         ///< further filters, of a spectrum of 1/f; none for most noise
  double innovation_variance = 0.0;  ///< s^2

  [[nodiscard]] Eigen::Index order() const { return static_cast<Eigen::Index>(reflections.size()); }
  [[nodiscard]] Eigen::VectorXd coefficients() const;  ///< a_1 ... a_q
  [[nodiscard]] Eigen::MatrixXd covariance() const;    ///< of q values in a row
  [[nodiscard]] double variance() const;
  [[nodiscard]] double power_at_zero_frequency() const;  ///< of the filters: 1 / (1 + a_1 + ... + a_q)^2
};

/// Noise of many time scales: an autoregression of the rows, one of its innovations in blocks of `size` rows,
/// one of theirs, and so on. Each is left out where the one before leaves its own innovations white.
struct Stage {
  Eigen::Index size = 1;
  Autoregression model;
  double count = 0.0;  ///< of the values that it rests on, less those that the parameters took
};
struct Noise {
  std::vector<Stage> stages;

  [[nodiscard]] double variance_at_zero_frequency() const;
};

/// -2 log of the restricted likelihood of noise without flicker, less a constant, with the penalty of AICc.
/// Rows are (Q^T, residuals), Q an orthonormal basis of what the parameters can take.
[[nodiscard]] double deviance(const Eigen::MatrixXd& rows, const std::vector<Rows>& runs,
                              const Autoregression& noise);

/// Sums over `size` columns in a run, over the root of their number; what is left at the end is left out.
[[nodiscard]] Eigen::MatrixXd in_blocks(const Eigen::MatrixXd& rows, std::vector<Rows>& runs,
                                        Eigen::Index size);

/// Noise of the residuals' whole, from what least squares has left of them. Restricted maximum likelihood by
/// expectation maximisation: what the r parameters took out of the noise is put back as its expectation,
///
///     E[e e^T] = g g^T + Q C Q^T,   g the residuals of generalised least squares, C their covariance there,
///
/// so that Burg's sums run over 1 + r series. Without it residuals look whiter than the noise. The order is
/// that of least AICc.
///
/// Of more blocks than `most`, each stage is estimated by as many as that, in 16 stretches from all over
/// them, and filters all: the next stage, whose blocks are eight times as long, sees slower noise by all of
/// them once there are few enough. What a part does not say enters its stage's count, and so the degrees of
/// freedom. Source: [Burg1967], for segments as by [WaeleBroersen2000]; [Laird1987] for the expectation.
inline constexpr Eigen::Index most_blocks_looked_at = 32768;
[[nodiscard]] Noise noise_of(const Blocks& blocks, Eigen::Index most = most_blocks_looked_at);

}  // namespace kerf::fitting
