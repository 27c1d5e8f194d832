#include "device_model/model_in_use.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <kerf/schema/recording.h>

#include "device_model/apply_model.h"
#include "files/json_number.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

/// Seconds since 1970 of "2026-01-31T12:00:00Z"; the readers have seen to its shape.
double seconds_of(std::string_view utc) {
  const auto number = [&](std::size_t at, std::size_t digits) {
    int value = 0;
    std::from_chars(utc.data() + at, utc.data() + at + digits, value);
    return value;
  };
  if (utc.size() < 19) throw std::invalid_argument(fmt::format("'{}' is no date in UTC", utc));
  const std::chrono::year_month_day day{std::chrono::year(number(0, 4)),
                                        std::chrono::month(static_cast<unsigned>(number(5, 2))),
                                        std::chrono::day(static_cast<unsigned>(number(8, 2)))};
  const auto days = std::chrono::sys_days(day).time_since_epoch();
  return 86400.0 * static_cast<double>(days.count()) + 3600.0 * number(11, 2) + 60.0 * number(14, 2) +
         number(17, 2);
}

std::string age_in_words(double days) {
  if (days < -1.0 / 24.0) return "dated in the future";
  if (days < 1.0) return "measured today";
  if (days < 2.0) return "measured yesterday";
  return fmt::format("measured {:.0f} days ago", std::floor(days));
}

std::string serial_in_words(const std::optional<std::string>& serial) {
  return serial ? fmt::format("serial number '{}'", *serial) : std::string("no serial number");
}

std::vector<std::string> doubts_of(const drivers::DeviceModel& model, const drivers::DeviceInfo& device,
                                   double age_days, double rate_hz) {
  std::vector<std::string> doubts;
  if (model.fits() == false) {
    const std::vector<std::string> why = model.why_not();
    doubts.push_back(fmt::format("the model does not fit the device that it was made of{}{}",
                                 why.empty() ? "" : ": ", fmt::join(why, "; ")));
  }
  if (age_days > model_lasts_days) {
    doubts.push_back(
        fmt::format("the model is {:.0f} days old, and cables and grease do not stay as they were: "
                    "'kerf identify {}' measures it anew",
                    std::floor(age_days), device.uri));
  }
  if (age_days < -1.0 / 24.0)
    doubts.push_back(
        fmt::format("the model is dated {}, in the future: is this machine's clock right?", model.date));
  if (model.model != device.model) {
    doubts.push_back(
        fmt::format("the model is of a device '{}', and this is '{}'", model.model, device.model));
  } else if (model.serial != device.serial) {
    doubts.push_back(fmt::format("the model is of the device with {}, and this one has {}",
                                 serial_in_words(model.serial), serial_in_words(device.serial)));
  }
  if (rate_hz > 0.0 && std::abs(model.rate_hz / rate_hz - 1.0) > 0.01) {
    doubts.push_back(
        fmt::format("the model was measured at {:g} Hz, and {:g} Hz is judged: its delay may be "
                    "another one there",
                    model.rate_hz, rate_hz));
  }
  return doubts;
}

/// What a model lacks of the numbers that mechanics take.
std::string lacking(const drivers::AxisModel& axis) {
  std::vector<std::string_view> names;
  if (!axis.mass) names.emplace_back("mass");
  if (!axis.viscous) names.emplace_back("viscous");
  if (!axis.coulomb_up) names.emplace_back("coulomb_up");
  if (!axis.coulomb_down) names.emplace_back("coulomb_down");
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Puts an axis' numbers in; whether there were any.
bool put_in(const drivers::AxisModel& model, drivers::AxisInfo& axis, bool over, bool lower_ends) {
  const auto mechanics = model.mechanics();
  if (!mechanics || (!over && axis.mechanics)) return false;
  axis.mechanics = mechanics;
  if (lower_ends) {
    axis.mechanics->viscous_n_s_per_m = std::max(0.0, model.viscous->lower);
    if (model.mass->lower > 0.0) axis.mechanics->mass_kg = model.mass->lower;
  }
  if (model.delay && (over || axis.delay_s == 0.0)) axis.delay_s = model.delay->value;
  if (model.encoder_step && (over || axis.resolution == 0.0)) axis.resolution = model.encoder_step->value;
  if (model.velocity_corner && (over || !axis.velocity_corner_rad_s))
    axis.velocity_corner_rad_s = model.velocity_corner->value;
  return true;
}

bool same_units(const drivers::AxisModel& model, const drivers::AxisInfo& axis) {
  return model.position_unit == axis.position_unit && model.force_unit == axis.force_unit;
}

bool lacks_mechanics(const drivers::DeviceInfo& device) {
  return std::ranges::any_of(
      device.axes, [](const drivers::AxisInfo& axis) { return axis.force_limit > 0.0 && !axis.mechanics; });
}

std::string axes_of(const drivers::DeviceModel& model) {
  std::vector<std::string_view> names;
  for (const drivers::AxisModel& one : model.axes) names.emplace_back(one.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

double days_between(std::string_view from, std::string_view to) {
  return (seconds_of(to) - seconds_of(from)) / 86400.0;
}

namespace {

ModelInUse taken_from(drivers::DeviceInfo& device, ModelFile found, const TakeModel& how, bool named) {
  const std::string now = how.now.empty() ? schema::new_header("").created : how.now;
  ModelInUse use{.from = std::move(found), .axes = {}, .doubts = {}};
  const drivers::DeviceModel& model = use.from.model;
  use.age_days = days_between(model.date, now);
  use.doubts = doubts_of(model, device, use.age_days, how.rate_hz);
  bool has_an_axis = false;
  for (drivers::AxisInfo& axis : device.axes) {
    const drivers::AxisModel* const of = model.axis(axis.name);
    if (of == nullptr || !same_units(*of, axis)) continue;
    has_an_axis = true;
    if (put_in(*of, axis, named, how.lower_ends)) {
      use.axes.push_back(axis.name);
    } else if (!of->mechanics() && (named || !axis.mechanics)) {
      use.doubts.push_back(
          fmt::format("the model does not know {} of axis '{}', so that the axis stays unknown", lacking(*of),
                      axis.name));
    }
  }
  if (named && !has_an_axis) {
    throw std::invalid_argument(fmt::format("{}: the model has {}, and {} has no such axis of the same units",
                                            use.from.file.string(), axes_of(model), device.uri));
  }
  return use;
}

}  // namespace

ModelInUse apply_model(drivers::DeviceInfo& device, ModelFile model, const TakeModel& how) {
  return taken_from(device, std::move(model), how, true);
}

std::optional<ModelInUse> take_model(drivers::DeviceInfo& device, const TakeModel& how) {
  if (!how.file.empty()) return taken_from(device, read_model_file(how.file), how, true);
  if (!lacks_mechanics(device)) return std::nullopt;
  std::optional<ModelFile> found = KeptModels(KeptModels::usual_folder()).find(device, how.warn);
  if (!found) return std::nullopt;
  ModelInUse use = taken_from(device, *std::move(found), how, false);
  if (use.axes.empty()) return std::nullopt;
  return use;
}

std::string conditions_in_words(const drivers::DeviceModel& model, double age_days) {
  return fmt::format("{}, {}, at {:g} Hz{}{}{}", age_in_words(age_days), model.held ? "held" : "free",
                     model.rate_hz,
                     model.temperature_degc ? fmt::format(", at {:g} °C", *model.temperature_degc) : "",
                     model.conditions.empty() ? "" : ", ", model.conditions);
}

std::string in_words(const ModelInUse& use) {
  return fmt::format(
      "device model {} ({}): {}", use.from.file.string(),
      use.axes.empty() ? std::string("of no axis") : fmt::format("{}", fmt::join(use.axes, ", ")),
      conditions_in_words(use.from.model, use.age_days));
}

std::vector<std::string> lines_of(const ModelInUse& use) {
  std::vector<std::string> lines{in_words(use)};
  lines.insert(lines.end(), use.doubts.begin(), use.doubts.end());
  return lines;
}

json as_json(const std::optional<ModelInUse>& use) {
  if (!use) return nullptr;
  const drivers::DeviceModel& model = use->from.model;
  double worst = 0.0;
  bool has_error = false;
  for (const drivers::AxisModel& axis : model.axes) {
    if (!axis.validation.error) continue;
    has_error = true;
    worst = std::max(worst, *axis.validation.error);
  }
  return {{"file", use->from.file.string()},
          {"axes", use->axes},
          {"date", model.date},
          {"age_days", use->age_days},
          {"held", model.held},
          {"rate_hz", model.rate_hz},
          {"conditions", model.conditions},
          {"temperature_degc", json_number(model.temperature_degc)},
          {"model", model.model},
          {"serial", model.serial ? json(*model.serial) : json(nullptr)},
          {"fits", model.fits() ? json(*model.fits()) : json(nullptr)},
          {"error", has_error ? json_number(worst) : json(nullptr)},
          {"doubts", use->doubts},
          {"about", in_words(*use)}};
}

}  // namespace kerf::bench
