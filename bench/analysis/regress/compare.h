#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <kerf/schema/regression.h>

#include "regress/forces.h"
#include "regress/suite.h"

namespace kerf::bench {

/// One force beside the stored one.
struct ForceDifference {
  std::size_t tick = 0;
  std::size_t channel = 0;
  double expected = 0.0;
  double got = 0.0;
  double allowed = 0.0;  ///< by the tolerance; 0 where it has to be exact
  double jnds = 0.0;     ///< the difference, in JNDs of the expected force

  [[nodiscard]] double difference() const noexcept { return got - expected; }
};

/// What came of one channel.
struct ChannelComparison {
  schema::ForceChannel channel;
  std::size_t outside = 0;          ///< ticks outside the tolerance
  double largest_difference = 0.0;  ///< of all ticks, also those within the tolerance
  double largest_jnds = 0.0;
  double largest_expected = 0.0;  ///< largest of the stored forces
};

struct ForceComparison {
  bool passed = true;
  std::size_t expected_rows = 0;
  std::size_t got_rows = 0;
  std::size_t differing = 0;  ///< ticks that are not bit for bit the same
  std::size_t outside = 0;    ///< ticks with a channel outside the tolerance
  std::vector<ChannelComparison> channels;
  std::optional<ForceDifference> worst;  ///< the farthest outside the tolerance, else the largest difference
  std::vector<std::string> messages;     ///< why it did not pass, the gravest first
};

/// Compares forces with the stored ones, tick by tick and channel by channel. A different number of samples
/// does not pass, whatever the tolerance.
[[nodiscard]] ForceComparison compare_forces(const schema::StoredForces& stored, const RenderedForces& got,
                                             const Tolerance& tolerance);

/// What the difference looks like: silence, a force of the other sign or of another scale (radians and
/// degrees, N and gf, m and mm), a shift by some ticks, or samples missing from a tick on. One sentence each.
[[nodiscard]] std::vector<std::string> diagnose(const schema::StoredForces& stored,
                                                const RenderedForces& got);

}  // namespace kerf::bench
