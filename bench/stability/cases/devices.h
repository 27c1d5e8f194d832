#pragma once

#include "stability/sampled_device.h"

namespace kerf::bench {

/// The handle of `sim:scissors` at 1 kHz, with its encoder, friction and velocity filter, in no hand.
[[nodiscard]] SampledDevice scissors_handle();

/// The same without what makes a loop nonlinear: the encoder's steps and Coulomb friction.
[[nodiscard]] SampledDevice linear_handle();

/// Stylus grips within the range that literature gives (Fu and Cavusoglu 2012): in the middle of it, as
/// `sim:scissors` has it; and one hand that takes a firmer grip, so that its stiffness grows threefold.
inline constexpr HandImpedance stylus_grip{
    .mass_kg = 0.15, .damping_n_s_per_m = 5.0, .stiffness_n_per_m = 500.0};
inline constexpr HandImpedance loose_grip{
    .mass_kg = 0.1, .damping_n_s_per_m = 2.0, .stiffness_n_per_m = 200.0};
inline constexpr HandImpedance firm_grip{
    .mass_kg = 0.1, .damping_n_s_per_m = 3.0, .stiffness_n_per_m = 600.0};

}  // namespace kerf::bench
