#pragma once

#include <span>

#include <kerf/models/law.h>

namespace kerf::bench {

/// What a step of a scalar law costs along a motion, warm and alone [us]: the median of batches.
/// @throws std::invalid_argument for an empty motion.
[[nodiscard]] double step_cost_us(const models::Law& law, std::span<const models::Motion> motion,
                                  double period_s);

}  // namespace kerf::bench
