#pragma once

#include <array>
#include <vector>

#include "problem.h"
#include "ruptures/drops.h"

namespace kerf::fitting {

/// The force at which it does, F = q |v| + r.
struct RuptureLine {
  double per_speed = 0.0;
  double constant = 0.0;
};

/// k1, k2 and b of the element between two ruptures.
using ElementValues = std::array<double, 3>;

/// Samples as a law sees them that ruptures at a line.
struct BreakingSamples {
  BreakingSamples(const Problem& problem, const Samples& samples, const Weights& weights,
                  const RobustLoss& loss);

  const Samples& samples;
  const Weights& weights;
  RobustLoss loss;
  std::vector<double> speed;  ///< within the box of the law [m/s]
};

/// Ruptures a row or two sooner or later where the element leaves less.
[[nodiscard]] RuptureRows moved_to_least(const BreakingSamples& data, const ElementValues& element,
                                         const RuptureRows& rows);

/// What ruptures at a line, and what the law leaves then.
struct Broken {
  RuptureRows rows;
  double squares = 0.0;
};
[[nodiscard]] Broken broken_at(const BreakingSamples& data, const ElementValues& element,
                               const RuptureLine& line);

/// Of samples that are seen, these rows; of the others what ruptures at a line.
[[nodiscard]] RuptureRows completed(const BreakingSamples& data, const ElementValues& element,
                                    const RuptureLine& line, const RuptureRows& seen);

/// How much more is left at least where one rupture is a row sooner or later or is none, all else as it is.
[[nodiscard]] double rise_of_other_rows(const BreakingSamples& data, const ElementValues& element,
                                        const RuptureRows& rows);

}  // namespace kerf::fitting
