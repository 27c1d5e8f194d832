#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <kerf/fitting/calibration/holds.h>

namespace kerf::fitting::calibration {

/// Why the loads cannot determine the matrix, in words: "no load along fy; add one". Empty if they can.
[[nodiscard]] std::string undetermined(const Holds& holds);

/// A load that could be put on next.
struct Candidate {
  std::string name;          ///< "+fx", "-z at 0, 0, 20 mm"
  std::vector<double> load;  ///< one number a component
};

struct NextLoad {
  std::size_t candidate = 0;
  double gain = 0.0;  ///< by which factor the determinant of the information grows
};

/// The candidate that adds most to the determinant of the information (D-optimal): of x^T (X^T X)^-1 x the
/// largest, with each component in shares of its full scale. A candidate may be put on where the loads so far
/// do not determine the matrix: then it is the one that mends most. Nothing without candidates.
[[nodiscard]] std::optional<NextLoad> next_load(const Holds& holds, const std::vector<Candidate>& candidates);

/// Holds that contradict all others.
struct Misfit {
  std::vector<std::size_t> holds;  ///< places in Holds::holds
  std::vector<double> told;        ///< load of the first of them by a calibration without them
  double ratio =
      0.0;  ///< told over given, least squares over all of them: -1 where it was put on the wrong way round
  bool proportional = false;  ///< what is told is `ratio` times what is given, within a tenth
};

/// Loads that do not fit the others: of single holds, all holds of a load and all of a placement the one that
/// takes most of the residuals with it, again and again, at most a quarter of the holds. One counts if the
/// test of a shift of its mean rejects at 1e-6 (over all that were tried), and what the others tell differs
/// from what is given by more than `tolerance` of full scale and five standard deviations of its own load.
[[nodiscard]] std::vector<Misfit> misfits(const Holds& holds, double tolerance = 0.02);

/// A component along which the signals are not straight, whatever the matrix.
struct Curvature {
  std::size_t component = 0;
  double largest = 0.0;        ///< of what a straight line errs by among the loads, either way [N, N·m]
  double at = 0.0;             ///< the load at which it does
  double at_full_scale = 0.0;  ///< of the same, at the largest load
};

/// Square and cube of a component's load beside the load itself: along which component the signals follow
/// them (a test of both at 1e-6, over all components and signals), and a straight line errs by more than
/// `tolerance` of full scale and five standard deviations of the loads. Components with fewer than five
/// different loads are not asked.
[[nodiscard]] std::vector<Curvature> curvatures(const Holds& holds, double tolerance = 0.002);

/// What is wrong with a signal.
struct SignalFault {
  enum class Kind : unsigned char {
    dead,       ///< no load moves it by more than five times what it scatters, or it never changes
    saturated,  ///< the same extreme number under loads that differ
  };
  Kind kind = Kind::dead;
  std::size_t signal = 0;
  double value = 0.0;                ///< where it is saturated; how far it moves at most, where it is dead
  std::vector<std::size_t> holds{};  ///< of the saturated ones
};

/// Signals that cannot be used as they are. `noise` of a hold's mean, one a signal, 0 if not known; `range`
/// beyond which a signal is at the end of it, infinity if not known.
[[nodiscard]] std::vector<SignalFault> signal_faults(const Holds& holds, const std::vector<double>& noise,
                                                     double range);

/// Pairs of holds that are the same to the last digit, load and signals: copies of a row.
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> copies(const Holds& holds);

}  // namespace kerf::fitting::calibration
