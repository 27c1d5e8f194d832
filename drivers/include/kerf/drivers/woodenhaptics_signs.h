#pragma once

#include <optional>

#include <kerf/drivers/protocols/woodenhaptics.h>
#include <kerf/mechanisms/woodenhaptics.h>

namespace kerf::drivers::woodenhaptics {

/// In which direction the counters and motors of a model go, as the programs of its makers take it on the
/// host. Nothing where no program speaks to such a model with reports of this generation.
///
/// V1: cWoodenDevice of CHAI3D (woody-experimental, 2016 to 2019). V2 and V3: kinematics.cpp and the
/// configurations of haptikfabrikenapi (2019 to 2021), which has one sign for counter and motor of a joint.
/// docs/devices.md has each sign with its source and what speaks against it; none was seen on hardware.
[[nodiscard]] std::optional<mechanisms::WoodenHaptics::Signs> signs_of(
    Generation generation, const mechanisms::WoodenHaptics::Configuration& model) noexcept;

}  // namespace kerf::drivers::woodenhaptics
