#include "kerf/models/parameter.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace kerf::models {

std::string unit_of(Quantity quantity, std::string_view force_unit, std::string_view position_unit) {
  const std::string force(force_unit);
  const std::string position(position_unit);
  switch (quantity) {
    case Quantity::force:
      return force;
    case Quantity::position:
      return position;
    case Quantity::velocity:
      return position + "/s";
    case Quantity::stiffness:
      return force + "/" + position;
    case Quantity::damping:
      return force + "·s/" + position;
    case Quantity::ratio:
      return "1";
    case Quantity::length:
      return "m";
    case Quantity::mass:
      return "kg";
    case Quantity::time:
      return "s";
    case Quantity::angular_frequency:
      return "1/s";
    case Quantity::torque:
      return "N·m";
    case Quantity::energy:
      return "J";
    case Quantity::toughness:
      return "J/m²";
    case Quantity::load:
      return "N";
    case Quantity::spring:
      return "N/m";
    case Quantity::dashpot:
      return "N·s/m";
    case Quantity::joint_damping:
      return "N·m·s/rad";
    case Quantity::edge_damping:
      return "N·s/m²";
    case Quantity::surface_damping:
      return "N·s/m³";
    case Quantity::edge_stiffness:
      return "N/m²";
    case Quantity::surface_stiffness:
      return "N/m³";
  }
  return "1";
}

OptionReader::OptionReader(std::string_view model, const std::vector<OptionInfo>& known, const Options& given)
    : model_(model) {
  for (const OptionInfo& option : known) values_[option.name] = option.standard;
  for (const auto& [name, value] : given) {
    const auto place = values_.find(name);
    if (place == values_.end()) {
      std::ostringstream message;
      message << "law '" << model << "' has no option '" << name << "'";
      if (known.empty()) {
        message << "; it takes none";
      } else {
        message << "; it takes";
        for (std::size_t i = 0; i < known.size(); ++i) message << (i ? ", " : " ") << known[i].name;
      }
      throw std::invalid_argument(message.str());
    }
    place->second = value;
  }
}

const OptionValue& OptionReader::value(std::string_view name) const { return values_.find(name)->second; }

double OptionReader::number(std::string_view name, double lower, double upper) const {
  const auto* number = std::get_if<double>(&value(name));
  if (number == nullptr || !(*number >= lower && *number <= upper)) {
    std::ostringstream message;
    message << "option '" << name << "' of law '" << model_ << "' must be a number from " << lower << " to "
            << upper;
    throw std::invalid_argument(message.str());
  }
  return *number;
}

bool OptionReader::flag(std::string_view name) const {
  const auto* flag = std::get_if<bool>(&value(name));
  if (flag == nullptr) {
    throw std::invalid_argument("option '" + std::string(name) + "' of law '" + model_ +
                                "' must be true or false");
  }
  return *flag;
}

std::string OptionReader::text(std::string_view name) const {
  const auto* text = std::get_if<std::string>(&value(name));
  if (text == nullptr) {
    throw std::invalid_argument("option '" + std::string(name) + "' of law '" + model_ + "' must be a text");
  }
  return *text;
}

std::string OptionReader::choice(std::string_view name,
                                 std::initializer_list<std::string_view> allowed) const {
  std::string given = text(name);
  if (std::find(allowed.begin(), allowed.end(), given) != allowed.end()) return given;
  std::ostringstream message;
  message << "option '" << name << "' of law '" << model_ << "' must be ";
  for (const auto* word = allowed.begin(); word != allowed.end(); ++word) {
    message << (word == allowed.begin()     ? ""
                : word + 1 == allowed.end() ? " or "
                                            : ", ")
            << '"' << *word << '"';
  }
  message << ", not \"" << given << '"';
  throw std::invalid_argument(message.str());
}

std::size_t OptionReader::count(std::string_view name, std::size_t lower, std::size_t upper) const {
  const double given = number(name, static_cast<double>(lower), static_cast<double>(upper));
  if (given != std::floor(given)) {
    std::ostringstream message;
    message << "option '" << name << "' of law '" << model_ << "' must be a whole number, not " << given;
    throw std::invalid_argument(message.str());
  }
  return static_cast<std::size_t>(given);
}

}  // namespace kerf::models
