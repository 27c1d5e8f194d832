#pragma once

#include <span>

#include <kerf/psychophysics/psychometric_fit.h>

namespace kerf::psychophysics {

/// Where the curve reaches the criterion, by a posterior: for trials whose levels followed the answers
/// (staircase, QUEST+).
///
///     P(threshold, slope, lapse | answers) ~ prior x product of psi^k (1 - psi)^(n - k)
///
/// prior: flat over ln(threshold) from a tenth of the least level to ten times the largest, over ln(slope)
/// from 1/2 to 10, and over the lapse rate from 0 to `largest_lapse` unless it is fixed. The value is the
/// median, the interval central and credible; an end that lies at the end of the prior's thresholds is 0
/// or infinity. Integrated by Gauss and Legendre over slopes and lapse rates within the box that the answers
/// leave, 10,605 curves: the ends agree with those of dense grids to 1e-3.
///
/// An adaptive design shows few levels, near the threshold, and the largest likelihood is then often that of
/// a curve too steep [Kaernbach2001], about which profile likelihood is too sure. Over a range of slopes
/// that people have it is not. How the levels were chosen does not matter to a posterior.
/// @throws std::invalid_argument: as fit_psychometric; a linear axis or overdispersion, which it does not
///         know.
[[nodiscard]] Threshold posterior_threshold(std::span<const Level> levels, const FitOptions& options);

}  // namespace kerf::psychophysics
