#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include <kerf/drivers/device.h>

namespace kerf::bench {

/// Whether a push moves the handle the way that it should.
enum class PushVerdict : std::uint8_t {
  unknown,  ///< it did not move enough to tell
  right,
  wrong  ///< the other way, or along another axis
};
[[nodiscard]] std::string_view name_of(PushVerdict verdict) noexcept;
[[nodiscard]] std::optional<PushVerdict> verdict_named(std::string_view name) noexcept;

/// One push along an axis, and how far each axis then was from where it was going before.
struct Push {
  double direction = 1.0;  ///< 1 or -1
  drivers::Axes moved{};   ///< in the unit of position
};

/// What pushes along one axis have shown.
struct PushJudgement {
  PushVerdict verdict = PushVerdict::unknown;
  double moved = 0.0;                  ///< along the axis in the direction of the push: the mean of the pairs
  double uncertainty = 0.0;            ///< half of its interval
  std::optional<std::size_t> instead;  ///< the other axis that moved
};

/// As many pairs at least, and at most, as judge_pushes() takes.
inline constexpr std::size_t least_push_pairs = 3;
inline constexpr std::size_t most_push_pairs = 24;

/// Judges by pairs of pushes, one each way, that follow on each other: with x+ and x- for what moved,
///
///     d = (x+ - x-) / 2,   mean(d) +- t(n - 1) s(d) / sqrt(n)
///
/// so that what a hand does by itself, the same in both, drops out. The interval holds with 99.9 %, because
/// it is looked at again after each pair. `right` or `wrong` where all of it lies on one side, by at least
/// half an encoder step. If the axis shows nothing while another one of the same unit moves three times as
/// far as the axis can have moved, that is `wrong` as well. A last push without its other is left out.
/// Allocates nothing.
[[nodiscard]] PushJudgement judge_pushes(std::span<const Push> pushes, const drivers::DeviceInfo& device,
                                         std::size_t axis) noexcept;

}  // namespace kerf::bench
