#pragma once

#include "stability/device/sampled_device.h"

namespace kerf::bench {

/// The handle of `sim:scissors` at 1 kHz, with its encoder, friction and velocity filter, in no hand.
[[nodiscard]] SampledDevice scissors_handle();

/// The same without what makes a loop nonlinear: the encoder's steps and Coulomb friction.
[[nodiscard]] SampledDevice linear_handle();

/// light_grip (in_hand.h) after it stiffened threefold, which took it to the end of that range.
inline constexpr HandImpedance stiffened_grip{
    .mass_kg = 0.1, .damping_n_s_per_m = 3.0, .stiffness_n_per_m = 600.0};

}  // namespace kerf::bench
