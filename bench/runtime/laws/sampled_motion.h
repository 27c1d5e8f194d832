#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <kerf/models/motion.h>

namespace kerf::bench {

/// A motion tick by tick, on the axes of a device or of a law: what a script gives at a rate, and what was
/// recorded.
struct SampledMotion {
  std::vector<double> time_s;
  std::vector<double> period_s;  ///< since the tick before
  std::vector<models::SpatialMotion> sample;

  [[nodiscard]] std::size_t ticks() const noexcept { return sample.size(); }
};

/// Ticks at a rate, from 0 s on; all samples are zero.
[[nodiscard]] SampledMotion ticks_at(double rate_hz, std::size_t ticks);

/// The time since the sample before. The first has none before it; the next one's period stands in, since a
/// law only starts there, and 1 ms where there is no next one.
[[nodiscard]] std::vector<double> periods_of(std::span<const double> time_s);

/// The deepest penetration of a motion along one of its axes; 0 if it meets nothing.
[[nodiscard]] double deepest(const SampledMotion& motion, std::size_t axis, const models::Contact& contact);

}  // namespace kerf::bench
