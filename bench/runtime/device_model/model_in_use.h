#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include <kerf/drivers/device.h>

#include "device_model/kept_models.h"

namespace kerf::bench {

/// A model that a verdict took numbers from, and what speaks against them.
struct ModelInUse {
  ModelFile from;
  std::vector<std::string> axes;    ///< whose numbers were taken
  std::vector<std::string> doubts;  ///< a line each: it is old, of another device or rate, or does not fit
  double age_days = 0.0;
};

/// How a model is taken.
struct TakeModel {
  std::string file{};    ///< as somebody named it; empty: the one that is kept of the device, if any
  double rate_hz = 0.0;  ///< at which the device is judged; 0: at none
  /// Of mass and viscous friction the lower ends of their intervals, for whoever counts on them to brake.
  bool lower_ends = false;
  std::string now{};                             ///< UTC, "2026-01-31T12:00:00Z"; empty: the clock's
  std::function<void(std::string_view)> warn{};  ///< told of kept files that cannot be read
};

/// Puts the numbers of a model into what a driver says of its axes: mass and friction, delay, encoder step
/// and the corner of its velocity's filter. The model that somebody named wins over the driver; one that is
/// kept fills in what the driver does not know, and is not looked for where every axis with force is known.
/// Nothing if nothing was taken.
/// @throws std::invalid_argument: the file that was named is none, or has no axis of the device.
[[nodiscard]] std::optional<ModelInUse> take_model(drivers::DeviceInfo& device, const TakeModel& how);

/// Older models are said to be old.
inline constexpr double model_lasts_days = 180.0;

/// From one moment to another, both in UTC as "2026-01-31T12:00:00Z" [days]; less than 0 backwards.
[[nodiscard]] double days_between(std::string_view from, std::string_view to);

/// "measured 40 days ago, held, at 1000 Hz", and the conditions.
[[nodiscard]] std::string conditions_in_words(const drivers::DeviceModel& model, double age_days);
/// One line: "device model falcon.device.toml (x, y): measured 40 days ago, ..."
[[nodiscard]] std::string in_words(const ModelInUse& use);
/// That line, and one for each doubt.
[[nodiscard]] std::vector<std::string> lines_of(const ModelInUse& use);
/// The object `device_model` of results; null where none was taken.
[[nodiscard]] nlohmann::ordered_json as_json(const std::optional<ModelInUse>& use);

}  // namespace kerf::bench
