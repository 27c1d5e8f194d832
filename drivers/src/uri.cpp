#include "kerf/drivers/uri.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "kerf/drivers/device.h"

namespace kerf::drivers {

Uri parse_uri(std::string_view text) {
  const auto question = text.find('?');
  Uri uri{.name = std::string(text.substr(0, question)), .options = {}};
  std::string_view rest = question == std::string_view::npos ? std::string_view{} : text.substr(question + 1);
  while (!rest.empty()) {
    const auto end = std::min(rest.find('&'), rest.size());
    const std::string_view option = rest.substr(0, end);
    const auto equals = option.find('=');
    if (equals == std::string_view::npos || equals == 0) {
      throw DeviceError("device '" + std::string(text) + "': '" + std::string(option) +
                        "' is not an option; expected NAME=VALUE, joined by '&'");
    }
    const auto [place, added] = uri.options.emplace(option.substr(0, equals), option.substr(equals + 1));
    if (!added)
      throw DeviceError("device '" + std::string(text) + "': option '" + place->first + "' stands twice");
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return uri;
}

bool names_a_file(std::string_view device, std::string_view option) noexcept {
  if (option == "firmware") return !device.starts_with("hapkit:");
  return option == "calibration" || (option == "model" && device == "sim:axis");
}

std::string to_text(const Uri& uri) {
  std::string text = uri.name;
  for (const auto& [name, value] : uri.options) {
    text += text.size() == uri.name.size() ? '?' : '&';
    text.append(name).append("=").append(value);
  }
  return text;
}

namespace {

/// A device that is named by what stands behind its colon.
struct PlaceScheme {
  std::string_view scheme;
  bool is_path;
};
constexpr std::array place_schemes{
    PlaceScheme{"net-ft:", false},   PlaceScheme{"onrobot:", false},     PlaceScheme{"t7:", false},
    PlaceScheme{"inverse3:", false}, PlaceScheme{"openhaptics:", false}, PlaceScheme{"dhd:", false},
    PlaceScheme{"bota:", true},      PlaceScheme{"optoforce:", true},    PlaceScheme{"ft300:", true},
    PlaceScheme{"woody-v4:", true},  PlaceScheme{"2diy:", true},         PlaceScheme{"hapkit:", true},
    PlaceScheme{"plugin:", true}};

}  // namespace

bool names_a_path(std::string_view device) noexcept {
  return std::ranges::any_of(
      place_schemes, [&](const PlaceScheme& one) { return one.is_path && device.starts_with(one.scheme); });
}

bool names_a_place(std::string_view device) noexcept {
  return std::ranges::any_of(place_schemes,
                             [&](const PlaceScheme& one) { return device.starts_with(one.scheme); });
}

double UriOptions::number_from(std::string_view text, const std::string& name,
                               const Quantity& quantity) const {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string_view unit = text.substr(static_cast<std::size_t>(end - text.data()));
  const double factor = quantity.unit == "deg" ? std::numbers::pi / 180.0 : 1.0;
  value *= factor;
  const bool plain = quantity.unit == "1" && unit.empty();
  const bool in_thousandths = (quantity.unit == "m" || quantity.unit == "s" || quantity.unit == "N") &&
                              unit.starts_with('m') && unit.substr(1) == quantity.unit;
  if (in_thousandths) value *= 1e-3;
  if (error != std::errc{} || (unit != quantity.unit && !plain && !in_thousandths) ||
      !(value >= quantity.lower && value <= quantity.upper)) {
    std::ostringstream message;
    message << "device '" << uri_.name << "': option '" << name << "' is '" << text << "', expected a number"
            << (quantity.unit == "1" ? "" : " with the unit ") << (quantity.unit == "1" ? "" : quantity.unit)
            << " from " << quantity.lower / factor << " to " << quantity.upper / factor;
    throw DeviceError(message.str());
  }
  return value;
}

double UriOptions::number(const std::string& name, const Quantity& quantity) {
  known_.push_back(name);
  const auto place = uri_.options.find(name);
  return place == uri_.options.end() ? quantity.standard : number_from(place->second, name, quantity);
}

std::vector<double> UriOptions::numbers(const std::string& name, const Quantity& quantity,
                                        std::size_t count) {
  known_.push_back(name);
  const auto place = uri_.options.find(name);
  if (place == uri_.options.end()) return {};
  std::vector<double> values;
  std::string_view rest = place->second;
  while (true) {
    const auto comma = std::min(rest.find(','), rest.size());
    values.push_back(number_from(rest.substr(0, comma), name, quantity));
    if (comma == rest.size()) break;
    rest.remove_prefix(comma + 1);
  }
  if (values.size() == 1) values.resize(count, values.front());
  if (values.size() != count) {
    throw DeviceError("device '" + uri_.name + "': option '" + name + "' has " +
                      std::to_string(values.size()) + " values, expected one or " + std::to_string(count) +
                      ", one an axis");
  }
  return values;
}

std::uint64_t UriOptions::count(const std::string& name, std::uint64_t standard) {
  constexpr double largest = 0x1p53;
  const double value = number(name, {"1", static_cast<double>(standard), 0.0, largest});
  if (value != std::floor(value)) {
    throw DeviceError("device '" + uri_.name + "': option '" + name + "' is '" + uri_.options.at(name) +
                      "', expected a whole number");
  }
  return static_cast<std::uint64_t>(value);
}

bool UriOptions::flag(const std::string& name, bool standard) {
  known_.push_back(name);
  const auto place = uri_.options.find(name);
  if (place == uri_.options.end()) return standard;
  if (place->second != "on" && place->second != "off") {
    throw DeviceError("device '" + uri_.name + "': option '" + name + "' is '" + place->second +
                      "', expected on or off");
  }
  return place->second == "on";
}

std::optional<std::string> UriOptions::text(const std::string& name) {
  known_.push_back(name);
  const auto place = uri_.options.find(name);
  if (place == uri_.options.end()) return std::nullopt;
  return place->second;
}

std::optional<std::string> UriOptions::file(const std::string& name) {
  if (!names_a_file(uri_.name, name))
    throw std::logic_error(name + " is not among the options that name files");
  return text(name);
}

void UriOptions::refuse_others() const {
  for (const auto& [name, value] : uri_.options) {
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    std::string all;
    for (const auto& known : known_) all += (all.empty() ? "" : ", ") + known;
    throw DeviceError("device '" + uri_.name + "' has no option '" + name + "'; it has " + all);
  }
}

}  // namespace kerf::drivers
