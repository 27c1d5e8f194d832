#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <kerf/schema/regression.h>

#include "laws/law_file.h"
#include "laws/sampled_motion.h"

namespace kerf::bench {

/// The forces of a law along a path, as it gives them itself: resisting for a scalar law, those of the axes
/// for a spatial one.
struct RenderedForces {
  std::vector<schema::ForceChannel> channels;
  std::vector<double> force;  ///< N x D, row-major
  std::uint64_t faults = 0;
  std::optional<std::size_t> first_fault;  ///< its tick
  std::vector<double> compute_time_s{};    ///< of every tick; empty: it was not measured
  std::string compute_time_of{};           ///< "renderer", by which it is told, or "round trip"
  std::size_t late = 0;                    ///< ticks answered after the next was due, by the wall clock

  [[nodiscard]] std::size_t rows() const noexcept {
    return channels.empty() ? 0 : force.size() / channels.size();
  }
};

[[nodiscard]] RenderedForces render_forces(const LawFile& law, const SampledMotion& motion);

/// What a tick of a law costs along a motion, in rounds of a calibration loop: TickCost::mean_rounds.
/// @throws std::invalid_argument as tick_costs().
[[nodiscard]] double tick_cost(const LawFile& law, const SampledMotion& motion);

/// What a tick's cost depends on beside the code: "optimised" or "not optimised".
[[nodiscard]] std::string build_kind();

}  // namespace kerf::bench
