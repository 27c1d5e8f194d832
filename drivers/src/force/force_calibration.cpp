#include "kerf/drivers/force_calibration.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <string_view>

#include <Eigen/LU>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include "kerf/drivers/toml_text.h"
#include "small_file.h"

namespace kerf::drivers {
namespace {

constexpr double pound_force_n = 4.4482216152605;  // exact, by definition
constexpr double inch_m = 0.0254;
constexpr std::size_t largest_calibration = 1U << 20U;  // bytes

struct UnitFactor {
  std::string_view name;
  double si;
};
constexpr std::array<UnitFactor, 3> force_units{{{"N", 1.0}, {"mN", 1e-3}, {"lbf", pound_force_n}}};
constexpr std::array<UnitFactor, 3> torque_units{
    {{"N·m", 1.0}, {"N·mm", 1e-3}, {"lbf·in", pound_force_n* inch_m}}};
constexpr std::array<UnitFactor, 2> signal_units{{{"V", 1.0}, {"mV", 1e-3}}};

/// Reads one file and says in it what is wrong where.
class Reader {
 public:
  Reader(const toml::table& root, const std::string& name) : root_(root), name_(name) {}

  ForceCalibration read() const {
    allow_only(root_, {"provenance", "serial", "units", "matrix", "bias", "axes"}, "a force calibration");
    ForceCalibration calibration;
    calibration.provenance =
        text(required(root_, "provenance", "a text in quotes: where the numbers come from"), "provenance");
    calibration.serial = serial();
    const toml::node& node = required(root_, "units", R"({ force = "N", torque = "N·m", signal = "V" })");
    if (!node.is_table()) refuse(node, R"('units' must be {{ force = "N", torque = "N·m", signal = "V" }})");
    const toml::table& units = *node.as_table();
    allow_only(units, {"force", "torque", "signal"}, "'units'");
    const double force = unit(units, "force", force_units);
    const double torque = unit(units, "torque", torque_units);
    const double signal = unit(units, "signal", signal_units);
    read_matrix(calibration.matrix);
    calibration.matrix.topRows<3>() *= force / signal;
    calibration.matrix.bottomRows<3>() *= torque / signal;
    const auto bias = six_numbers(required(root_, "bias", "six numbers: the signals without load"), "'bias'");
    for (std::size_t i = 0; i < max_axes; ++i)
      calibration.bias_v[static_cast<Eigen::Index>(i)] = signal * bias[i];
    read_axes(calibration.mounts);
    return calibration;
  }

 private:
  template <typename... Arguments>
  [[noreturn]] void refuse(const toml::node& node, fmt::format_string<Arguments...> format,
                           Arguments&&... arguments) const {
    throw DeviceError(fmt::format("{}:{}: {}", name_, node.source().begin.line,
                                  fmt::format(format, std::forward<Arguments>(arguments)...)));
  }

  void allow_only(const toml::table& table, std::initializer_list<std::string_view> keys,
                  std::string_view where) const {
    for (const auto& [key, node] : table) {
      if (std::find(keys.begin(), keys.end(), key.str()) != keys.end()) continue;
      refuse(node, "unknown key '{}' in {}; known are {}", key.str(), where, fmt::join(keys, ", "));
    }
  }

  const toml::node& required(const toml::table& table, std::string_view key,
                             std::string_view expected) const {
    const toml::node* node = table.get(key);
    if (node == nullptr)
      throw DeviceError(fmt::format("{}: '{}' is missing; expected {}", name_, key, expected));
    return *node;
  }

  std::string text(const toml::node& node, std::string_view key) const {
    if (!node.is_string()) refuse(node, "'{}' must be a text in quotes", key);
    return **node.as_string();
  }

  double number(const toml::node& node, std::string_view what) const {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value || !std::isfinite(*value)) refuse(node, "{} must be a finite number", what);
    return *value;
  }

  std::optional<std::uint32_t> serial() const {
    const toml::node* node = root_.get("serial");
    if (node == nullptr) return std::nullopt;
    const auto value = node->is_integer() ? node->value<std::int64_t>() : std::nullopt;
    if (!value || *value < 0 || *value > std::numeric_limits<std::uint32_t>::max()) {
      refuse(*node, "'serial' must be the number on the LabJack's label");
    }
    return static_cast<std::uint32_t>(*value);
  }

  template <std::size_t N>
  double unit(const toml::table& units, std::string_view key, const std::array<UnitFactor, N>& known) const {
    std::vector<std::string_view> names;
    for (const UnitFactor& one : known) names.push_back(one.name);
    const toml::node* node = units.get(key);
    if (node == nullptr) {
      throw DeviceError(fmt::format("{}: the unit of '{}' is missing in 'units'; expected {}", name_, key,
                                    fmt::join(names, " or ")));
    }
    const std::string given = text(*node, key);
    for (const UnitFactor& one : known) {
      if (one.name == given) return one.si;
    }
    refuse(*node, "the unit of '{}' is \"{}\", expected {}", key, given, fmt::join(names, " or "));
  }

  Axes six_numbers(const toml::node& node, std::string_view what) const {
    const toml::array* array = node.as_array();
    if (array == nullptr || array->size() != max_axes) {
      refuse(node, "{} must be {} numbers, found {}", what, max_axes, array == nullptr ? 0 : array->size());
    }
    Axes numbers{};
    for (std::size_t i = 0; i < max_axes; ++i)
      numbers[i] = number((*array)[i], fmt::format("{}[{}]", what, i));
    return numbers;
  }

  void read_matrix(Eigen::Matrix<double, 6, 6>& matrix) const {
    const toml::node& node = required(root_, "matrix", "six rows of six numbers: fx, fy, fz, tx, ty, tz");
    const toml::array* rows = node.as_array();
    if (rows == nullptr || rows->size() != max_axes) {
      refuse(node, "'matrix' must be {} rows, fx, fy, fz, tx, ty, tz; found {}", max_axes,
             rows == nullptr ? 0 : rows->size());
    }
    for (std::size_t row = 0; row < max_axes; ++row) {
      const auto numbers = six_numbers((*rows)[row], fmt::format("row {} of 'matrix'", wrench_names[row]));
      for (std::size_t column = 0; column < max_axes; ++column) {
        matrix(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) = numbers[column];
      }
    }
    // Scaled row by row, so that the choice of units makes no matrix singular.
    Eigen::Matrix<double, 6, 6> scaled = matrix;
    for (Eigen::Index row = 0; row < 6; ++row) scaled.row(row) /= std::max(1e-300, scaled.row(row).norm());
    if (std::abs(scaled.determinant()) < 1e-9) {
      refuse(node,
             "'matrix' is singular: six components cannot be told from these signals; is a row missing?");
    }
  }

  ForceMount mount(const std::string& axis, const toml::node& node) const {
    std::string component;
    double lever_m = 0.0;
    if (const toml::table* table = node.as_table()) {
      allow_only(*table, {"component", "lever_m"}, fmt::format("[axes] '{}'", axis));
      component = text(required(*table, "component", "one of fx to tz, perhaps with a minus"), "component");
      if (const toml::node* lever = table->get("lever_m")) {
        lever_m = number(*lever, "'lever_m'");
        if (!(lever_m > 0.0))
          refuse(*lever, "'lever_m' must be more than 0; a minus stands before the component");
      }
    } else {
      component = text(node, axis);
    }
    const bool minus = component.starts_with('-');
    const auto* found = std::ranges::find(wrench_names, std::string_view(component).substr(minus ? 1 : 0));
    if (found == wrench_names.end()) {
      refuse(node, "[axes] '{}' is \"{}\", expected one of {}, perhaps with a minus", axis, component,
             fmt::join(wrench_names, ", "));
    }
    return {.axis = axis,
            .component = static_cast<std::size_t>(found - wrench_names.begin()),
            .sign = minus ? -1.0 : 1.0,
            .lever_m = lever_m};
  }

  void read_axes(std::vector<ForceMount>& mounts) const {
    const toml::node* node = root_.get("axes");
    if (node == nullptr) return;
    if (!node->is_table()) refuse(*node, "'axes' must be a table: [axes]");
    for (const auto& [key, one] : *node->as_table()) mounts.push_back(mount(std::string(key.str()), one));
  }

  const toml::table& root_;
  const std::string& name_;
};

std::string row_text(const Eigen::Matrix<double, 1, 6>& row) {
  std::string text;
  for (const double number : row) text += (text.empty() ? "[" : ", ") + toml_number(number);
  return text + "]";
}

}  // namespace

Axes ForceCalibration::wrench(const Axes& volts) const noexcept {
  const Eigen::Matrix<double, 6, 1> signal =
      Eigen::Map<const Eigen::Matrix<double, 6, 1>>(volts.data()) - bias_v;
  Axes wrench{};
  Eigen::Map<Eigen::Matrix<double, 6, 1>>(wrench.data()).noalias() = matrix * signal;
  return wrench;
}

ForceCalibration parse_force_calibration(const std::string& text, const std::string& name) {
  try {
    const toml::table root = toml::parse(text, name);
    return Reader(root, name).read();
  } catch (const toml::parse_error& error) {
    throw DeviceError(fmt::format("{}:{}: {}", name, error.source().begin.line, error.description()));
  }
}

ForceCalibration read_force_calibration(const std::string& file) {
  const SmallFile read = read_small_file(file, largest_calibration);
  if (!read.problem.empty()) {
    throw std::invalid_argument(
        fmt::format("{}: the force calibration cannot be read ({}); is the path right? "
                    "examples/u6.calibration.toml is an example",
                    file, read.problem));
  }
  return parse_force_calibration(read.content, file);
}

std::string to_toml(const ForceCalibration& calibration) {
  std::string text = fmt::format("provenance = {}\n", toml_text(calibration.provenance));
  if (calibration.serial) text += fmt::format("serial = {}\n", *calibration.serial);
  text += "units = { force = \"N\", torque = \"N·m\", signal = \"V\" }\nmatrix = [\n";
  for (Eigen::Index row = 0; row < 6; ++row)
    text += fmt::format("  {},\n", row_text(calibration.matrix.row(row)));
  text += fmt::format("]\nbias = {}\n", row_text(calibration.bias_v.transpose()));
  if (calibration.mounts.empty()) return text;
  std::string mounts;
  for (const ForceMount& mount : calibration.mounts) {
    const std::string lever = mount.lever_m > 0.0 ? ", lever_m = " + toml_number(mount.lever_m) : "";
    mounts +=
        fmt::format("{}{} = {{ component = \"{}{}\"{} }}", mounts.empty() ? "" : ", ", toml_text(mount.axis),
                    mount.sign < 0.0 ? "-" : "", wrench_names[mount.component], lever);
  }
  return text + fmt::format("axes = {{ {} }}\n", mounts);
}

}  // namespace kerf::drivers
