#include "regress/read_tolerance.h"

#include <stdexcept>

#include <fmt/core.h>

#include "files/named_file.h"

namespace kerf::bench {
namespace {

/// One limit: of forces, or of torques; per second if `per` says so.
void read_limit(const Place& place, const toml::node& node, std::string_view key, const std::string& per,
                compare::Limit& limit) {
  const toml::table* table = node.as_table();
  const std::string unit = table != nullptr ? place.text(*table, "unit", "") : "";
  const std::string force = unit.substr(0, unit.find('/'));
  const bool torque = force.find('m') != std::string::npos && force != "mN";
  const auto values = place.measured(node, std::string(key), (torque ? "N·m" : "N") + per).values;
  if (values.size() != 1 || !(values[0] >= 0.0)) place.refuse(node, "'{}' must be one number, >= 0", key);
  (torque ? limit.torque : limit.force) = values[0];
}

/// One limit or a list of two, of forces and torques.
void read_limits(const Place& place, const toml::table& table, std::string_view key, const std::string& per,
                 compare::Limit& limit) {
  const toml::node* given = table.get(key);
  if (given == nullptr) return;
  limit = {};
  if (const toml::array* list = given->as_array()) {
    for (const toml::node& node : *list) read_limit(place, node, key, per, limit);
  } else {
    read_limit(place, *given, key, per, limit);
  }
}

}  // namespace

double number_within(const Place& place, const toml::node& node, std::string_view what, double lower,
                     double upper) {
  const double value = place.number(node, fmt::format("'{}'", what));
  if (!(value >= lower && value <= upper))
    place.refuse(node, "'{}' is {}, expected a number from {:g} to {:g}", what, value, lower, upper);
  return value;
}

void read_tolerance(const Place& place, const toml::table& table, compare::Tolerance& tolerance) {
  const bool inexact = table.contains("absolute") || table.contains("relative") || table.contains("jnd");
  if (inexact) {
    tolerance.force_n = tolerance.torque_n_m = tolerance.relative = tolerance.jnd = {};
    tolerance.exact = false;
  }
  compare::Limit absolute{.force = tolerance.force_n, .torque = tolerance.torque_n_m};
  read_limits(place, table, "absolute", "", absolute);
  tolerance.force_n = absolute.force;
  tolerance.torque_n_m = absolute.torque;
  if (const toml::node* relative = table.get("relative"))
    tolerance.relative = number_within(place, *relative, "relative", 0.0, 1.0);
  if (const toml::node* jnd = table.get("jnd")) tolerance.jnd = number_within(place, *jnd, "jnd", 0.0, 100.0);
  if (const toml::node* vibration = table.get("vibration"))
    tolerance.vibration = number_within(place, *vibration, "vibration", 0.0, 1e6);
  read_limits(place, table, "slew", "/s", tolerance.slew);
  read_limits(place, table, "drift", "", tolerance.drift);
  read_limits(place, table, "peak", "", tolerance.peak);
  if (const toml::node* exact = table.get("exact")) {
    tolerance.exact = place.flag(table, "exact", false);
    if (tolerance.exact && inexact)
      place.refuse(*exact, "'exact' leaves no room for a tolerance; leave out either");
    if (tolerance.exact) tolerance = {.exact = true};
  }
}

compare::Tolerance read_tolerance_file(const std::filesystem::path& file) {
  const Place place(file.string());
  toml::table root = parse_toml(read_named_file(file), file.string());
  compare::Tolerance tolerance;
  read_tolerance(place, root, tolerance);
  if (!tolerance.has_limit_for("N") && !tolerance.has_limit_for("N·m"))
    throw std::invalid_argument(file.string() + ": it needs one of exact, absolute, relative and jnd");
  if (root.contains("channel")) {
    const compare::Tolerance of_all = tolerance;
    for (const auto& [key, node] : place.table(root, "channel")) {
      const std::string name(key.str());
      if (!node.is_table()) place.refuse(node, "expected [channel.{}]", name);
      place.allow_only(*node.as_table(), tolerance_keys, "[channel." + name + "]");
      compare::Tolerance own = of_all;
      read_tolerance(place, *node.as_table(), own);
      tolerance.channels.push_back({.channel = name, .tolerance = std::move(own)});
    }
    root.erase("channel");
  }
  place.allow_only(root, tolerance_keys, "a file of tolerances");
  return tolerance;
}

}  // namespace kerf::bench
