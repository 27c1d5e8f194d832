#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "protocol/guide/guided_motion.h"
#include "sealed/session_store.h"

// How well a hand kept to the target of a guide.

namespace kerf::bench {

/// Of each tick of a trial that was led, in Row::channels: the guide's clock [s], the target [the axis'
/// unit], the force of the guide that was added to the law's [the axis' unit], ahead of the device's limits.
inline constexpr std::size_t led_channels = 3;
[[nodiscard]] std::vector<schema::Channel> channels_of_guide(const schema::Axis& axis);

/// The axis along which a trial was led; none: it was not.
[[nodiscard]] std::optional<std::size_t> led_axis_of(const RecordedTrial& trial);

/// By how much the tool came later than the target in each slot [s]: where its way is most like the target's,
///
///     max over L of r(x(t), x_t(t - L)),   L from -1/4 to 1/2 of a cycle in steps of 5 ms, refined by a
///     parabola through the three about the largest
///
/// with Pearson's r, which minds no difference of extent. NaN: the slot played for less than half a cycle, r
/// is below 0.5, the largest r is at an end, or the trial was not led.
[[nodiscard]] std::vector<double> guide_lags_s(const RecordedTrial& trial, const GuidedMotion& guide,
                                               std::size_t slots);

}  // namespace kerf::bench
