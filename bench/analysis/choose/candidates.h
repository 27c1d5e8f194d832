#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/schema/recording.h>

namespace kerf::bench {

/// What a law can tell of a cut beside a force that grows with the depth.
enum class Effect {
  rotation,    ///< of a blade: parts of it move at speeds and depths of their own
  loop,        ///< hysteresis: opening is felt otherwise than closing, at any speed
  relaxation,  ///< the force fades while the tool is held
  cutting,     ///< the tissue gives way, and the force falls
  rate,        ///< the force depends on the speed
  stiffening   ///< the force is no straight line over the depth
};
[[nodiscard]] std::string_view name_of(Effect effect) noexcept;
using Effects = std::set<Effect>;

/// A law as it may be chosen: with the options that make it simpler or richer.
struct CandidateLaw {
  std::string name;                      ///< "piecewise-3-loop"; of its law file, too
  std::string model;                     ///< in the registry
  std::vector<std::string> law_options;  ///< NAME=VALUE
  std::size_t parameters = 0;            ///< that are fitted
  Effects effects;
};

struct CandidateOptions {
  std::size_t max_segments = 12;  ///< of the piecewise law, 1 to 16
  std::size_t max_arms = 4;       ///< of the Maxwell law, 1 to 6
};

/// Every scalar law whose units fit an axis, from a straight line to tables of the recorded force, those with
/// fewest parameters first. Laws with a branch for each direction are among them only where there are cycles.
///
/// Variants: the exponential law without viscosity, with it, and with an offset too; the springpot alone and
/// beside a spring; Maxwell's with 2 arms and more (with one it is the Kelvin law); piecewise with 1 segment
/// and more, for both directions together and each by itself.
[[nodiscard]] std::vector<CandidateLaw> candidates_for(const schema::Axis& axis, bool has_cycles,
                                                       const CandidateOptions& options = {});

}  // namespace kerf::bench
