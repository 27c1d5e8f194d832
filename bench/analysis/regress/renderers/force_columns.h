#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "regress/renderers/outside_renderer.h"

namespace kerf::bench {

/// Where a renderer's answers have what.
struct ForceColumns {
  std::size_t key = 0;              ///< of time or tick, which says what a row belongs to
  std::vector<std::size_t> forces;  ///< of every axis
  std::size_t compute_time = 0;     ///< of the two that may be missing: the number of columns
  std::size_t fault = 0;
};

/// "fx[N]", "trz[N·m]".
[[nodiscard]] std::string force_column(const models::LawAxis& axis);

/// @param key `time[s]` or `tick`
/// @throws std::invalid_argument in one line: a column that is missing, there twice, or none of a renderer.
[[nodiscard]] ForceColumns force_columns(const std::vector<std::string>& names,
                                         const OutsideRenderer& renderer, std::string_view key);

/// @throws std::invalid_argument if forces that say what their sign, frame or quaternion is are of another
/// than the suite says.
void require_declared(std::string_view what, std::string_view value, const OutsideRenderer& renderer);

}  // namespace kerf::bench
