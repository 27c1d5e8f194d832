#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <span>
#include <string>
#include <string_view>

#include <kerf/device.h>

#include "kerf/drivers/uri.h"

/// What Kerf's own devices in the host have alike, which are classes behind kerf/device.h.
namespace kerf::host {

/// As much of a text as a field holds, with a zero behind it.
template <std::size_t size>
void tell(char (&field)[size], std::string_view text) noexcept {  // NOLINT(*-c-arrays): a field of C
  const std::size_t length = std::min(text.size(), size - 1);
  std::copy_n(text.begin(), length, field);
  field[length] = '\0';
}

/// What differs from one axis of a tip that moves in space to the next.
struct TipAxis {
  std::string_view name;
  double resolution_m = 0.0;
  double lower_m = 0.0;
  double upper_m = 0.0;
  double force_limit_n = 0.0;
};
/// Slew 2000 N/s, speed 5 m/s, acceleration 200 m/s^2: assumed of all of them.
inline void add_axis(kerf_device_facts_v1& facts, const TipAxis& told) noexcept {
  kerf_device_axis_v1& axis = facts.axes[facts.axis_count++];
  tell(axis.name, told.name);
  tell(axis.position_unit, "m");
  tell(axis.force_unit, "N");
  axis.resolution = told.resolution_m;
  axis.lower = told.lower_m;
  axis.upper = told.upper_m;
  axis.force_limit = told.force_limit_n;
  axis.slew_limit = 2000.0;
  axis.speed_limit = 5.0;
  axis.acceleration_limit = 200.0;
}

inline void add_channel(kerf_device_facts_v1& facts, std::string_view name, std::string_view unit,
                        std::uint32_t flags = 0) noexcept {
  kerf_device_channel_v1& channel = facts.channels[facts.channel_count++];
  tell(channel.name, name);
  tell(channel.unit, unit);
  channel.flags = flags;
}

/// The options of a URI from the values that open() is handed.
[[nodiscard]] inline drivers::UriOptions options_of(std::string_view device,
                                                    std::span<const char* const> names,
                                                    const char* const* values) {
  drivers::Uri given{.name = std::string(device), .options = {}};
  for (std::size_t i = 0; names[i] != nullptr; ++i) {
    if (values[i] != nullptr) given.options[names[i]] = values[i];
  }
  return drivers::UriOptions(std::move(given));
}

template <typename Own>
concept TakesForce = requires(Own& own, const double* force) {
  own.write(force);
  own.release();
};

template <typename Own>
constexpr double open_s_of() noexcept {
  if constexpr (requires { Own::open_s; }) return Own::open_s;
  return 0.0;
}
template <typename Own>
constexpr decltype(kerf_device_v1::write) write_of() noexcept {
  if constexpr (!TakesForce<Own>)
    return nullptr;
  else
    return [](void* device, const double* force) { return static_cast<Own*>(device)->write(force); };
}
template <typename Own>
constexpr decltype(kerf_device_v1::release) release_of() noexcept {
  if constexpr (!TakesForce<Own>)
    return nullptr;
  else
    return [](void* device) { static_cast<Own*>(device)->release(); };
}

/// Of a class with describe(facts), read(reading), trouble(), its name, the options of its URI, and
/// open(UriOptions&), which throws what is in the way; write(force) and release() where it takes a force;
/// open_s, the longest time of open(), where that is above 2 s.
template <typename Own>
constexpr kerf_device_v1 as_plugin(const char* about) noexcept {
  return {
      .abi = KERF_DEVICE_ABI,
      .size = sizeof(kerf_device_v1),
      .name = Own::name,
      .about = about,
      .options = Own::options.data(),
      .open_s = open_s_of<Own>(),
      .open = [](const char* const* values, char* why, std::size_t why_size) -> void* {
        try {
          drivers::UriOptions given = options_of(Own::name, Own::options, values);
          return Own::open(given).release();
        } catch (const std::exception& error) {
          const std::string_view text = error.what();
          const std::size_t length = std::min(text.size(), why_size - 1);
          std::copy_n(text.begin(), length, why);
          why[length] = '\0';
          return nullptr;
        }
      },
      .describe = [](void* device,
                     kerf_device_facts_v1* facts) { static_cast<Own*>(device)->describe(*facts); },
      .read = [](void* device,
                 kerf_device_reading_v1* reading) { return static_cast<Own*>(device)->read(*reading); },
      .write = write_of<Own>(),
      .release = release_of<Own>(),
      .close = [](void* device) { delete static_cast<Own*>(device); },  // NOLINT(*-owning-memory): of open()
      .trouble = [](void* device) { return static_cast<Own*>(device)->trouble(); }};
}

}  // namespace kerf::host
