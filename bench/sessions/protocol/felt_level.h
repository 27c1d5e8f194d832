#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

// How strong a sample is felt, and whether anything but its law tells it from another.

namespace kerf::bench {

/// Below it a force is not felt: the smallest JND of force that simulated observers have unless said
/// otherwise.
inline constexpr double least_felt_force_n = 0.05;

/// What a hand got of a sample. Forces over all axes, torques at a lever of 10 mm; NaN: not known.
struct FeltLevel {
  double rms_n = std::numeric_limits<double>::quiet_NaN();   ///< while there was a force that can be felt
  double peak_n = std::numeric_limits<double>::quiet_NaN();  ///< largest force
  double limited_share = std::numeric_limits<double>::quiet_NaN();  ///< of the ticks, cut to a limit
  double vibration_n = std::numeric_limits<double>::quiet_NaN();    ///< rms from 20 Hz to 1 kHz
  /// Of the octave where it is most: its rms over the smallest vibration that a hand feels there.
  double vibration_thresholds = std::numeric_limits<double>::quiet_NaN();
};

/// The second of two samples less the first; NaN where one is not known.
struct FeltApart {
  double rms_jnds = 0.0;   ///< over the JND of a force at the mean of the two (fitting::force_jnd)
  double peak_jnds = 0.0;  ///< likewise
  double limited_share = 0.0;
  double vibration_db = 0.0;  ///< 20 log10 of the rms; infinite if one has none at all
  bool vibrates = false;      ///< one of the two has an octave above the threshold of a hand
};
[[nodiscard]] FeltApart felt_apart(const FeltLevel& first, const FeltLevel& second);

// Beyond these something else than the law may tell two samples apart.
inline constexpr double most_jnds_apart = 1.0;
inline constexpr double most_limited_apart = 0.001;  ///< at 1 kHz one tick in a second
/// Twice what a hand tells of the amplitude of a vibration far above its threshold, 1.5 dB ([Craig1972]).
inline constexpr double most_db_apart = 3.0;

[[nodiscard]] bool is_strength_apart(double jnds) noexcept;
[[nodiscard]] bool is_limit_apart(const FeltApart& apart) noexcept;
[[nodiscard]] bool is_vibration_apart(const FeltApart& apart) noexcept;

/// Where the JND comes from, in words.
[[nodiscard]] std::string_view jnd_of_levels_source() noexcept;

}  // namespace kerf::bench
