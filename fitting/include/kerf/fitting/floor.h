#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kerf/fitting/fit.h"

namespace kerf::fitting {

/// What is possible at all on recordings, whatever the law [N]: errors on held-out folds, the same that laws
/// are judged by, of maps without an equation that are as fine as pays.
///
/// `position_n` is that of the best map of penetration and direction: means of the force in bins, linear
/// between them, for either direction by itself; the number of bins is the one of 8, 16, ... 256 that errs
/// least. `velocity_n` is that of bins that are straight lines in the velocity, where they pay, and of a map
/// of penetration and velocity of what that leaves (4 to 16 by 4 to 16 bins, velocities by their quantiles),
/// where it pays. With n cycles shown, e^2(n) = a + b/n: b is what maps of few cycles know badly, and sqrt(a)
/// = `unlimited_n` would be left of ever so many cycles; taken from all and from half of the training folds.
/// A map is chosen by the folds that it is judged by, so that these floors are rather too low.
/// `memory_n` is of what the last map leaves on held-out folds: what traces of the motion tell of it, changes
/// of the penetration and of its square that fade by six times from five periods to a quarter of the
/// recording, by their least squares on the other folds. A sum of such traces is what tissue that relaxes
/// does; a spread from cycle to cycle is none.
struct Floor {
  double position_n = 0.0;
  double velocity_n = 0.0;   ///< no more than position_n
  double unlimited_n = 0.0;  ///< no more than velocity_n
  double memory_n = 0.0;     ///< no more than velocity_n
  double noise_n = 0.0;      ///< of the sensor from row to row, its quantum's included
  double quantum_n = 0.0;    ///< smallest step of the force; 0: none is seen
  bool by_cycle = false;     ///< else by blocks of time
  std::size_t folds = 0;     ///< 0: nothing can be held out, and only noise and quantum are known

  /// A law that errs less on these folds than every map: it goes on where maps have seen nothing.
  void lower_to(double error_n) noexcept;
};

/// @throws std::invalid_argument if the series cannot be fitted at all.
[[nodiscard]] Floor floor_of(std::span<const Series> recordings, const FitOptions& options);

/// What an error on held-out data is made of [N]; the squares add up to that of the error.
struct ErrorParts {
  double loop = 0.0;    ///< rendered less fitted: filter and latency
  double law = 0.0;     ///< a map of position and direction would not leave it
  double hand = 0.0;    ///< its speed: such a map leaves it, one that knows the velocity too does not
  double memory = 0.0;  ///< what came before tells it, and neither position nor speed does
  double data = 0.0;    ///< too few cycles to know that map
  double spread = 0.0;  ///< cycles differ from each other at one position and velocity
  double sensor = 0.0;  ///< its noise and quantum
};
[[nodiscard]] ErrorParts parts_of(double rendered_n, double fitted_n, const Floor& floor);

/// One sentence that says what is to blame, in JNDs, the largest part first; empty for an error within the
/// JND, or where nothing could be held out.
[[nodiscard]] std::string blame(double rendered_n, double fitted_n, const Floor& floor, double jnd_n);

}  // namespace kerf::fitting
