#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <kerf/identification/output_error.h>

namespace kerf::identification {

/// Whole periods of one excitation at one place, one after the other.
struct Stretch {
  std::size_t begin = 0;   ///< tick
  std::size_t period = 0;  ///< ticks
  std::size_t periods = 0;
  std::size_t place = 0;
  bool validates = false;  ///< kept out of the fit

  [[nodiscard]] std::size_t end() const noexcept { return begin + period * periods; }
};

/// Into how many parts a stretch's periods are cut where each part, in all periods, is one cluster.
inline constexpr std::size_t parts_of_a_period = 8;

/// Cuts each period into so many shots, or into fewer of 36 ticks or more. Each begins where the axis moves
/// fastest within the first third after its cut: a state is told best where friction does not change its
/// sign. The same part of all periods of a stretch is one cluster: where nothing is random but an encoder's
/// rounding, periods repeat it exactly.
[[nodiscard]] std::vector<Shot> make_shots(const AxisData& data, std::span<const Stretch> stretches,
                                           std::size_t most_parts);

}  // namespace kerf::identification
