#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <kerf/identification/output_error.h>
#include <kerf/identification/shots.h>

namespace kerf::identification {

/// What a model without it may miss of an axis.
enum class Missing : std::uint8_t { backlash, cogging, flexible_link };
[[nodiscard]] std::string_view name_of(Missing missing) noexcept;

/// How much of what the model leaves, beyond an encoder's rounding, each explains after all other numbers
/// were fitted again, 0 to 1, in the windows of first_model():
///
///     cogging        <w, sin(2 pi x / p)> c + <w, cos(2 pi x / p)> c'   the period p that explains most
///     flexible link  m2 <w'', y> - B <w', y> + K <w, y>,   m2 y'' = (k (x - y) + c (x' - y')) - B y' - K y
///                    a mass behind a spring k that the readings x move; the k and c that explain most; B and
///                    K are zero but in a hand
///     backlash       m <w'', sign x'> c      the reading is half of the play behind or ahead
///
/// Play between the motor, where the encoder is, and the handle does not show in that column: the handle
/// flies from flank to flank, and no two flights are alike. But what it does to the motor comes in blows,
/// between which the motor's mass m1 is alone. `blows` is the kurtosis of m1 x'' + b x' + f sign x' - u - o
/// for the m1 < m of which it is largest: 3 of a normal force, and not far from it of what a link or a
/// multisine does.
struct Explanation {
  Missing missing = Missing::backlash;
  double share = 0.0;
  double size = 0.0;      ///< the play [m], the amplitude [N], the compliance 1 / k [m/N]; 0: not told
  double period_m = 0.0;  ///< of cogging
  double blows = 0.0;     ///< of backlash
};

/// Play comes in blows of which this or more is the kurtosis.
inline constexpr double least_blows = 4.3;

/// The likeliest first: what explains 0.9; else backlash where there are blows; else what explains most.
[[nodiscard]] std::vector<Explanation> explanations(const AxisData& data, std::span<const Stretch> stretches,
                                                    const PlacedModel& model, bool held,
                                                    double encoder_step_m);

}  // namespace kerf::identification
