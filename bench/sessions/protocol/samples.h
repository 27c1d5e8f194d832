#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "protocol/plan.h"
#include "run/run.h"

namespace kerf::bench {

/// A law with its gain, as the loop renders it.
struct PlayedLaw {
  LawFile law;
  double gain = 1.0;
};

/// The force of a law on a device times its gain, which the law alone does not have. @throws as axes_for().
[[nodiscard]] OtherRendering rendering_of(const PlayedLaw& law, const drivers::DeviceInfo& device);

/// What a sample renders at a level of the scale; NaN: as it is.
/// @throws std::invalid_argument where a parameter leaves its bounds at that level, naming both.
[[nodiscard]] PlayedLaw played(const Protocol& protocol, std::size_t sample, double level);

/// Where the parameter of a law stands that a scale names: "damping"; of "knot" all of knot[0], knot[1] ...
[[nodiscard]] std::vector<std::size_t> parameters_named(const models::Law& law, std::string_view name);

/// The two of a trial, in the order of its pair: pair[1] at the trial's level.
[[nodiscard]] std::vector<PlayedLaw> played(const Protocol& protocol, const TrialPlan& trial);

/// The protocol's motion on the axes of a law. @throws std::invalid_argument: it has none, or one axis for a
/// law of several; as sampled().
[[nodiscard]] SampledMotion motion_along(const Protocol& protocol, const LawFile& law);

/// Force on the law's axes along the protocol's motion, tick by tick from a fresh state: ticks x axes.
/// @throws std::invalid_argument: the protocol has no motion, or the law faults along it.
[[nodiscard]] std::vector<double> forces_along(const Protocol& protocol, const PlayedLaw& law);

/// Sets the gains of the samples so that peak or root mean square of the force along the protocol's motion
/// (over the axes, torques at a lever of 10 mm) is that of the first sample of each tissue. Nothing where the
/// protocol leaves them as they are. Also where it asks for what is felt: find_gains() calls it then. @throws
/// std::invalid_argument: no motion, a sample without force, a gain that is not from 1/20 to 20, or one
/// sample that would need two gains.
void match_loudness(Protocol& protocol);

}  // namespace kerf::bench
