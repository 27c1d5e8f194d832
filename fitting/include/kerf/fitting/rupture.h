#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <kerf/models/law.h>

namespace kerf::fitting {

/// Measured ruptures: the force that tissue bore at a depth and a speed.
struct RuptureSamples {
  std::vector<double> depth_m;
  std::vector<double> speed_m_per_s;
  std::vector<double> force_n;
};

/// How the premises (centre and width of each membership) and consequents (p, q, r of each rule) are learned.
enum class Learning : std::uint8_t {
  variable_projection,  ///< Ceres on the premises; the consequents follow by least squares at every step
  back_propagation      ///< gradient descent on everything, step size after Jang [Jang1993]
};

struct RuptureOptions {
  std::size_t memberships = 3;  ///< an input, 1 to 5
  Learning learning = Learning::variable_projection;
  std::size_t iterations = 0;  ///< at most; 0: 200 of Ceres, 20,000 of back-propagation
};

/// A trained threshold, its box that of the samples.
struct RuptureFit {
  models::Law law;  ///< fuzzy_rupture
  double rmse_n = 0.0;
  double max_abs_n = 0.0;
  std::size_t iterations = 0;
  double seconds = 0.0;
  bool converged = false;
  std::string message;
};

/// Identifies a Takagi-Sugeno rupture threshold (models/fuzzy.h) from samples. Both ways begin with
/// memberships that are spread evenly and cross at 0.5, and are deterministic. No trend is assumed: force may
/// rise or fall with speed.
///
/// Variable projection eliminates the consequents c, which are linear: with the weights of the rules in Phi,
///
///     r(premises) = Phi c - F,  c = argmin |Phi c - F|^2 + e |c|^2,   dr = (I - Phi Phi+) dPhi c   (Kaufman)
///
/// Source: [FuzzyKelvin], section 2.2 (hybrid learning of ANFIS); [GolubPereyra1973]; [Kaufman1975].
/// @throws std::invalid_argument for samples that are not finite, a negative depth or speed, a constant depth
/// or
///         speed, or fewer samples than parameters.
[[nodiscard]] RuptureFit train_rupture(const RuptureSamples& samples, const RuptureOptions& options = {});

}  // namespace kerf::fitting
