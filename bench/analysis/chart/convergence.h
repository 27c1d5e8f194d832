#pragma once

#include <string>
#include <vector>

namespace kerf::bench {

/// A refinement of a law, and how far its force is from that of the finest one.
struct Refinement {
  std::string label;
  double factor = 1.0;     ///< how many times the elements a side, of the law as given
  double error_jnd = 0.0;  ///< root mean square, on the worst axis
};

/// What is known of a reference's own error.
struct Convergence {
  std::vector<Refinement> refinements;  ///< the last is the reference
  bool known = false;                   ///< there are enough of them to tell
  bool converges = false;
  double order = 0.0;         ///< p; NaN where refinements do not come nearer
  double estimate_jnd = 0.0;  ///< of the reference's own error; NaN likewise
  double expected_jnd = 0.0;  ///< what three times the elements would err by that order; NaN likewise
};

/// Extrapolates from refinements by 1, 2 and 4 whose last is the reference, as [Richardson1911]: with an
/// error of C h^p, those towards the finest are
///
///     e_1 = C (1 - 4^-p),  e_2 = C (2^-p - 4^-p),  so that  2^p = e_1 / e_2 - 1
///
/// and the finest's own error is e_2 / (2^p - 1). They come nearer where p > 0 and each is nearer to the
/// finest than the one before. The reference has converged only if the order is steady: what was refined by 3
/// errs as that order says, C (3^-p - 4^-p), within a quarter. Not known without these three.
[[nodiscard]] Convergence convergence_of(std::vector<Refinement> refinements);

/// That in one sentence.
[[nodiscard]] std::string convergence_in_words(const Convergence& convergence);

}  // namespace kerf::bench
