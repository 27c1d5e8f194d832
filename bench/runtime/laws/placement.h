#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <kerf/drivers/device.h>

#include "laws/law_file.h"

namespace kerf::bench {

/// The names of axes, or of what else has one, for messages: "theta, x_s". Clang 14 does not take the views
/// of GCC's library.
template <typename Named>
[[nodiscard]] std::string names_in(const std::vector<Named>& all) {
  std::string text;
  for (const Named& one : all) text += (text.empty() ? "" : ", ") + one.name;
  return text;
}

/// The axis of a device on which a law is rendered: the one it names, else the first with its units.
/// @throws std::invalid_argument if there is none, naming both units.
[[nodiscard]] std::size_t axis_for(const LawFile& law, const drivers::DeviceInfo& device);

/// The device's axis for every axis of a law: axis_for() a scalar law; for a spatial one those of the same
/// names.
/// @throws std::invalid_argument if the device lacks an axis, or has it in other units.
[[nodiscard]] std::vector<std::size_t> axes_for(const LawFile& law, const drivers::DeviceInfo& device);

/// As axes_for(), but of a scalar law too by the name of its axis: where a person picks a law for their hand,
/// nothing is put on another axis than it was made for. @throws std::invalid_argument.
[[nodiscard]] std::vector<std::size_t> named_axes_for(const LawFile& law, const drivers::DeviceInfo& device);

/// The axes that a law acts on, with their units; a scalar law has one.
[[nodiscard]] std::vector<models::LawAxis> axes_of(const LawFile& law);
/// Their places in a motion that has no others: 0, 1, ...
[[nodiscard]] std::vector<std::size_t> own_axes(const LawFile& law);

}  // namespace kerf::bench
