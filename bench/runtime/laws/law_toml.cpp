#include "laws/law_toml.h"

#include <algorithm>
#include <cmath>

#include <fmt/ranges.h>

#include "units/units.h"

namespace kerf::bench {
namespace {

/// The numbers under `value` or `std_error` of a parameter: one, or an array of them.
std::vector<double> numbers(const Place& place, const toml::node& node, const std::string& what) {
  std::vector<double> values;
  if (const toml::array* array = node.as_array()) {
    for (const auto& element : *array) values.push_back(place.number(element, what));
  } else {
    values.push_back(place.number(node, what));
  }
  return values;
}

}  // namespace

toml::table parse_toml(const std::string& text, const std::string& name) {
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    throw std::invalid_argument(
        fmt::format("{}:{}: not TOML: {}", name, error.source().begin.line, error.description()));
  }
}

void Place::allow_only(const toml::table& table, std::span<const std::string_view> keys,
                       std::string_view where) const {
  for (const auto& [key, node] : table) {
    if (std::find(keys.begin(), keys.end(), key.str()) != keys.end()) continue;
    refuse(node, "unknown key '{}' in {}; known are {}", key.str(), where, fmt::join(keys, ", "));
  }
}

const toml::table& Place::table(const toml::table& parent, std::string_view key) const {
  const toml::node* node = parent.get(key);
  if (node == nullptr || !node->is_table()) refuse(node ? *node : parent, "expected a table [{}]", key);
  return *node->as_table();
}

std::string Place::text(const toml::table& parent, std::string_view key, std::string_view standard) const {
  const toml::node* node = parent.get(key);
  if (node == nullptr) return std::string(standard);
  if (!node->is_string()) refuse(*node, "'{}' must be a text in quotes", key);
  return **node->as_string();
}

double Place::number(const toml::node& node, std::string_view what) const {
  if (!node.is_number()) refuse(node, "{} must be a number", what);
  return *node.value<double>();
}

bool Place::flag(const toml::table& parent, std::string_view key, bool standard) const {
  const toml::node* node = parent.get(key);
  if (node == nullptr) return standard;
  if (!node->is_boolean()) refuse(*node, "'{}' must be true or false", key);
  return **node->as_boolean();
}

Measured Place::measured(const toml::node& node, const std::string& name, const std::string& expected) const {
  const toml::table* table = node.as_table();
  if (table == nullptr) {
    refuse(node, "'{}' must be written {{ value = ..., unit = \"{}\" }}", name, expected);
  }
  allow_only(*table, {"value", "unit", "std_error"}, fmt::format("'{}'", name));
  const toml::node* value = table->get("value");
  if (value == nullptr) refuse(node, "'{}' has no value", name);
  const toml::node* unit_node = table->get("unit");
  if (unit_node == nullptr) refuse(node, "'{}' has no unit; expected one such as \"{}\"", name, expected);
  const std::string given = text(*table, "unit", "");
  Unit unit;
  try {
    unit = parse_unit(given);
  } catch (const std::invalid_argument& error) {
    refuse(*unit_node, "'{}': {}", name, error.what());
  }
  if (unit.si != expected) {
    refuse(*unit_node, "'{}' is given in {}, expected {} or a multiple of it", name, given, expected);
  }
  Measured result{.values = numbers(*this, *value, "the value of '" + name + "'"), .std_errors = {}};
  if (const toml::node* errors = table->get("std_error")) {
    result.std_errors = numbers(*this, *errors, "the std_error of '" + name + "'");
    if (result.std_errors.size() != result.values.size()) {
      refuse(*errors, "'{}' has {} values and {} standard errors", name, result.values.size(),
             result.std_errors.size());
    }
  }
  for (double& number : result.values) number *= unit.factor;
  for (double& number : result.std_errors) number *= std::abs(unit.factor);
  return result;
}

}  // namespace kerf::bench
