#include "atlas/pictures/axis_ticks.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include <fmt/format.h>

namespace kerf::bench {

std::string short_number(double value) {
  std::string text = fmt::format("{:.3g}", value);
  if (const auto at = text.find("e+0"); at != std::string::npos) text.erase(at + 1, 2);
  if (const auto at = text.find("e-0"); at != std::string::npos) text.erase(at + 2, 1);
  return text;
}

std::string name_of_part(const AtlasAxis& axis, std::size_t part) {
  if (part < axis.values.size() && !std::isnan(axis.values[part])) return short_number(axis.values[part]);
  const std::string& name = axis.names[part];
  return name.ends_with(".h5") ? std::filesystem::path(name).stem().string() : name;
}

HeatAxis heat_axis(const AtlasAxis& axis, std::size_t width_px) {
  HeatAxis drawn{.label = with_unit(axis.column, axis.unit), .parts = axis.parts(), .ticks = {}};
  const bool listed = !axis.names.empty();
  const std::size_t ticks = listed ? axis.parts() : axis.edges.size();
  std::vector<std::string> names;
  std::size_t longest = 1;
  for (std::size_t i = 0; i < ticks; ++i) {
    names.push_back(listed ? name_of_part(axis, i) : short_number(axis.edges[i]));
    longest = std::max(longest, names.back().size());
  }
  const std::size_t room = width_px == 0 ? 12 : std::max<std::size_t>(2, width_px / (9 * longest + 8));
  const std::size_t stride = (ticks + room - 1) / room;
  for (std::size_t i = 0; i < ticks; i += stride)
    drawn.ticks.push_back({.at = static_cast<double>(i) + (listed ? 0.5 : 0.0), .name = names[i]});
  return drawn;
}

AtlasScale::AtlasScale(const AtlasColumn& column, double smallest, double largest)
    : names_(column.texts), values_(column.values), smallest_(smallest), largest_(largest) {
  logarithmic_ = smallest > 0.0 && largest / smallest > 100.0;
}

double AtlasScale::place(double value) const {
  if (std::isnan(value)) return value;
  if (!names_.empty()) {
    return names_.size() < 2 ? 0.5 : value / static_cast<double>(names_.size() - 1);
  }
  if (!(smallest_ < largest_)) return 0.5;
  const double within = std::clamp(value, smallest_, largest_);
  return logarithmic_ ? std::log(within / smallest_) / std::log(largest_ / smallest_)
                      : (within - smallest_) / (largest_ - smallest_);
}

std::vector<NamedTick> AtlasScale::ticks() const {
  constexpr std::size_t most = 6;
  std::vector<NamedTick> ticks;
  if (!names_.empty()) {
    const std::size_t stride = (names_.size() + most - 1) / most;
    for (std::size_t i = 0; i < names_.size(); i += stride) {
      const bool number = i < values_.size() && !std::isnan(values_[i]);
      const double at =
          names_.size() < 2 ? 0.5 : static_cast<double>(i) / static_cast<double>(names_.size() - 1);
      ticks.push_back({.at = at,
                       .name = number                       ? short_number(values_[i])
                               : names_[i].ends_with(".h5") ? std::filesystem::path(names_[i]).stem().string()
                                                            : names_[i]});
    }
    return ticks;
  }
  for (std::size_t i = 0; i < most; ++i) {
    const double share = static_cast<double>(i) / (most - 1);
    const double value = logarithmic_ ? smallest_ * std::pow(largest_ / smallest_, share)
                                      : smallest_ + share * (largest_ - smallest_);
    ticks.push_back({.at = smallest_ < largest_ ? share : 0.5, .name = short_number(value)});
    if (!(smallest_ < largest_)) break;
  }
  return ticks;
}

AtlasScale scale_of(const AtlasColumn& column, const std::vector<double>& numbers) {
  double smallest = std::numeric_limits<double>::infinity();
  double largest = -smallest;
  for (const double number : numbers) {
    if (!std::isfinite(number)) continue;
    smallest = std::min(smallest, number);
    largest = std::max(largest, number);
  }
  if (!(smallest <= largest)) smallest = largest = 0.0;
  return {column, smallest, largest};
}

}  // namespace kerf::bench
