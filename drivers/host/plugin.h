#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <kerf/device.h>

namespace kerf::host {

/// What is wrong with the plug-in or its options, for the one who named it.
struct Refusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The names of a list that ends with a null pointer.
[[nodiscard]] std::vector<std::string_view> option_names(const kerf_device_v1& description);

/// Loads a shared object and checks what it says of itself. @throws Refusal
[[nodiscard]] const kerf_device_v1& load(const std::string& path);

/// What a plug-in said, without line ends and the like.
[[nodiscard]] std::string one_line(std::string text);

using Options = std::vector<std::pair<std::string, std::string>>;

/// Opens the device. @throws Refusal with its own reason, or for an option that it has not
[[nodiscard]] void* open_device(const kerf_device_v1& description, const Options& given);

}  // namespace kerf::host
