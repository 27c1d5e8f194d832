#pragma once

#include <kerf/drivers/protocols/woodenhaptics.h>
#include <kerf/mechanisms/woodenhaptics.h>

namespace kerf::emulators {

/// How the counters and motors of an emulated device are connected: told from the device's side, by its
/// firmware and by how encoders and motors are mounted, and by nothing that the driver knows.
///
/// A counter goes with its body as the quadrature table of the firmware says, turned round where the encoder
/// is mounted the other way. V1 has the usual table, V2 the reversed one (firmware/main.cpp of
/// haptikfabrikenapi); V3's firmware is not public, and its host program is V2's. How they are mounted: of a
/// WoodenHaptics, that program negates all three counts of a V1; of a Polhem, the counters where its makers
/// park it are (8327, -10926, 27140), and only with A, B and C all positive there is its arm above the base.
///
/// A positive current is a direction pin that is high (V1) or PWM above a half (V2, V3). Which way the motors
/// of a WoodenHaptics then turn its bodies is in hfabapi's flags for one, in the commit that corrects them:
/// (0, 1, 1), and where a flag is set a positive current lowers the angle. On the boards of V2 an encoder
/// counts up as its motor turns under a positive current: haptikfabrikenapi.h defines one flag for both.
[[nodiscard]] mechanisms::WoodenHaptics::Signs wiring_of(
    drivers::woodenhaptics::Generation generation,
    const mechanisms::WoodenHaptics::Configuration& model) noexcept;

}  // namespace kerf::emulators
