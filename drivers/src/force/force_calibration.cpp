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

  ForceCalibration read() {
    allow_only(root_,
               {"provenance", "serial", "units", "matrix", "bias", "axes", "components", "date",
                "serial_number", "temperature", "stale_after", "quality"},
               "a force calibration");
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
    read_components(calibration);
    read_matrix(calibration);
    calibration.matrix.topRows<3>() *= force / signal;
    calibration.matrix.bottomRows<3>() *= torque / signal;
    const auto bias = numbers(required(root_, "bias", "six numbers: the signals without load"), "'bias'");
    for (std::size_t i = 0; i < max_axes; ++i)
      calibration.bias_v[static_cast<Eigen::Index>(i)] = signal * bias[i];
    read_circumstances(calibration, signal);
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

  /// Six, or of a sensor with fewer components as many as the first list has; the others are zero.
  Axes numbers(const toml::node& node, std::string_view what) {
    const toml::array* array = node.as_array();
    const std::size_t found = array == nullptr ? 0 : array->size();
    if (signals_ == 0 && has_components_ && found >= 1 && found <= max_axes) signals_ = found;
    const std::size_t expected = signals_ == 0 ? max_axes : signals_;
    if (found != expected) refuse(node, "{} must be {} numbers, found {}", what, expected, found);
    Axes numbers{};
    for (std::size_t i = 0; i < found; ++i) numbers[i] = number((*array)[i], fmt::format("{}[{}]", what, i));
    return numbers;
  }

  void read_components(ForceCalibration& calibration) {
    const toml::node* node = root_.get("components");
    if (node == nullptr) return;
    has_components_ = true;
    rows_.clear();
    calibration.tells.fill(false);
    const toml::array* names = node->as_array();
    if (names == nullptr || names->empty()) refuse(*node, "'components' must be a list of names: [\"fz\"]");
    for (const toml::node& one : *names) {
      const std::string name = text(one, "components");
      const auto* found = std::ranges::find(wrench_names, std::string_view(name));
      const auto at = static_cast<std::size_t>(found - wrench_names.begin());
      if (found == wrench_names.end() || calibration.tells.at(at)) {
        refuse(one, "'components' holds \"{}\", expected some of {}, each once", name,
               fmt::join(wrench_names, ", "));
      }
      calibration.tells.at(at) = true;
      rows_.push_back(at);
    }
  }

  void read_matrix(ForceCalibration& calibration) {
    const toml::node& node = required(root_, "matrix", "six rows of six numbers: fx, fy, fz, tx, ty, tz");
    const toml::array* rows = node.as_array();
    if (rows == nullptr || rows->size() != rows_.size()) {
      std::vector<std::string_view> names;
      for (const std::size_t row : rows_) names.emplace_back(wrench_names.at(row));
      refuse(node, "'matrix' must be {} rows, {}; found {}", rows_.size(), fmt::join(names, ", "),
             rows == nullptr ? 0 : rows->size());
    }
    // Scaled row by row, so that the choice of units makes no matrix singular.
    Eigen::Matrix<double, Eigen::Dynamic, 6> scaled(static_cast<Eigen::Index>(rows_.size()), 6);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(rows_[i]);
      const Axes values = numbers((*rows)[i], fmt::format("row {} of 'matrix'", wrench_names.at(rows_[i])));
      calibration.matrix.row(row) = Eigen::Map<const Eigen::Matrix<double, 1, 6>>(values.data());
      const double size = std::max(1e-300, calibration.matrix.row(row).norm());
      scaled.row(static_cast<Eigen::Index>(i)) = calibration.matrix.row(row) / size;
    }
    const double volume = std::sqrt(std::max(0.0, (scaled * scaled.transpose()).eval().determinant()));
    if (volume < 1e-9) {
      refuse(node, "'matrix' is singular: {} components cannot be told from these signals; is a row missing?",
             rows_.size() == max_axes ? std::string("six") : std::to_string(rows_.size()));
    }
  }

  /// When, by which transducer, how warm, and what [quality] says of the signals.
  void read_circumstances(ForceCalibration& calibration, double signal) {
    if (const toml::node* node = root_.get("date")) {
      const auto day = node->value<toml::date>();
      const auto date =
          !day ? std::chrono::year_month_day{}
               : std::chrono::year_month_day{std::chrono::year{day->year}, std::chrono::month{day->month},
                                             std::chrono::day{day->day}};
      if (!date.ok()) refuse(*node, "'date' must be a day, without quotes: 2026-11-28");
      calibration.date = date;
    }
    if (const toml::node* node = root_.get("serial_number"))
      calibration.serial_number = text(*node, "serial_number");
    if (const toml::node* node = root_.get("temperature"))
      calibration.temperature = number(*node, "'temperature'");
    if (const toml::node* node = root_.get("stale_after")) {
      calibration.stale_after_days = number(*node, "'stale_after'");
      if (!(calibration.stale_after_days > 0.0)) refuse(*node, "'stale_after' must be more than 0 days");
    }
    const toml::node* node = root_.get("quality");
    if (node == nullptr) return;
    if (!node->is_table()) refuse(*node, "'quality' must be a table: [quality]");
    const auto volts = [&](const char* key) -> std::optional<Axes> {
      const toml::node* list = node->as_table()->get(key);
      if (list == nullptr) return std::nullopt;
      Axes found = numbers(*list, fmt::format("'{}' of [quality]", key));
      for (double& one : found) one *= signal;
      return found;
    };
    calibration.noise_v = volts("noise");
    calibration.bias_half_width_v = volts("bias_half_width");
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
    const auto found = signed_component(component);
    if (!found) {
      refuse(node, "[axes] '{}' is \"{}\", expected one of {}, perhaps with a minus", axis, component,
             fmt::join(wrench_names, ", "));
    }
    return {.axis = axis, .component = found->component, .sign = found->sign, .lever_m = lever_m};
  }

  void read_axes(std::vector<ForceMount>& mounts) const {
    const toml::node* node = root_.get("axes");
    if (node == nullptr) return;
    if (!node->is_table()) refuse(*node, "'axes' must be a table: [axes]");
    for (const auto& [key, one] : *node->as_table()) mounts.push_back(mount(std::string(key.str()), one));
  }

  const toml::table& root_;
  const std::string& name_;
  std::vector<std::size_t> rows_{0, 1, 2, 3, 4, 5};  ///< components that the rows of the matrix are
  bool has_components_ = false;
  std::size_t signals_ = 0;  ///< numbers of a row; 0: not known yet
};

std::string list_text(const Axes& values) {
  std::vector<std::string> texts;
  for (const double one : values) texts.push_back(toml_number(one));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

/// What is optional, but the mounts.
std::string circumstances_text(const ForceCalibration& calibration) {
  std::string text;
  if (calibration.date) {
    const auto& date = *calibration.date;
    text += fmt::format("date = {:04}-{:02}-{:02}\n", static_cast<int>(date.year()),
                        static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
    text += fmt::format("stale_after = {}\n", toml_number(calibration.stale_after_days));
  }
  if (calibration.serial_number)
    text += fmt::format("serial_number = {}\n", toml_text(*calibration.serial_number));
  if (calibration.temperature)
    text += fmt::format("temperature = {}\n", toml_number(*calibration.temperature));
  std::vector<std::string> quality;
  if (calibration.noise_v) quality.push_back("noise = " + list_text(*calibration.noise_v));
  if (calibration.bias_half_width_v)
    quality.push_back("bias_half_width = " + list_text(*calibration.bias_half_width_v));
  if (!quality.empty()) text += fmt::format("quality = {{ {} }}\n", fmt::join(quality, ", "));
  return text;
}

std::string row_text(const Eigen::Matrix<double, 1, 6>& row) {
  std::string text;
  for (const double number : row) text += (text.empty() ? "[" : ", ") + toml_number(number);
  return text + "]";
}

}  // namespace

std::optional<SignedComponent> signed_component(std::string_view text) noexcept {
  const bool minus = text.starts_with('-');
  const auto* found = std::ranges::find(wrench_names, text.substr(minus ? 1 : 0));
  if (found == wrench_names.end()) return std::nullopt;
  return SignedComponent{.component = static_cast<std::size_t>(found - wrench_names.begin()),
                         .sign = minus ? -1.0 : 1.0};
}

Axes ForceCalibration::wrench(const Axes& volts) const noexcept {
  const Eigen::Matrix<double, 6, 1> signal =
      Eigen::Map<const Eigen::Matrix<double, 6, 1>>(volts.data()) - bias_v;
  Axes wrench{};
  Eigen::Map<Eigen::Matrix<double, 6, 1>>(wrench.data()).noalias() = matrix * signal;
  for (std::size_t i = 0; i < max_axes; ++i) {
    if (!tells[i]) wrench[i] = std::numeric_limits<double>::quiet_NaN();
  }
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

std::vector<std::string> doubts_of(const ForceCalibration& calibration, const std::string& file,
                                   std::chrono::sys_days today, const std::string& transducer) {
  std::vector<std::string> doubts;
  if (calibration.date) {
    const auto age = (today - std::chrono::sys_days(*calibration.date)).count();
    if (static_cast<double>(age) > calibration.stale_after_days) {
      doubts.push_back(
          fmt::format("{}: the calibration is {} days old, and stale after {:g}; 'kerf calibrate' makes "
                      "a new one",
                      file, age, calibration.stale_after_days));
    }
  }
  if (calibration.serial_number && !transducer.empty() && *calibration.serial_number != transducer) {
    doubts.push_back(fmt::format("{}: the calibration is of the transducer {}, and this one is {}", file,
                                 *calibration.serial_number, transducer));
  }
  return doubts;
}

std::optional<std::string> moved_bias(const ForceCalibration& calibration, const std::string& file,
                                      const Axes& mean_v, double readings) {
  if (!calibration.noise_v || !(readings > 0.0)) return std::nullopt;
  constexpr double deviations = 5.0;
  constexpr double of_half_width = 1.96;
  double farthest = 0.0;
  for (std::size_t i = 0; i < max_axes; ++i) {
    const double known =
        calibration.bias_half_width_v ? (*calibration.bias_half_width_v)[i] / of_half_width : 0.0;
    const double allowed = deviations * std::hypot((*calibration.noise_v)[i] / std::sqrt(readings), known);
    const double off = std::abs(mean_v[i] - calibration.bias_v[static_cast<Eigen::Index>(i)]);
    if (allowed > 0.0 && off > allowed) farthest = std::max(farthest, off / allowed * deviations);
  }
  if (!(farthest > 0.0)) return std::nullopt;
  const Axes wrench = calibration.wrench(mean_v);
  std::string told;
  for (std::size_t i = 0; i < max_axes; ++i) {
    if (calibration.tells[i])
      told += fmt::format("{}{} {:.2g}", told.empty() ? "" : ", ", wrench_names[i], wrench[i]);
  }
  return fmt::format(
      "{}: the signals are not where its bias is ({:.0f} standard deviations; it tells {} N or N·m): "
      "something is on "
      "the sensor, or its bias has moved since; 'kerf calibrate' measures it again",
      file, farthest, told);
}

std::string to_toml(const ForceCalibration& calibration) {
  std::string text = fmt::format("provenance = {}\n", toml_text(calibration.provenance));
  if (calibration.serial) text += fmt::format("serial = {}\n", *calibration.serial);
  text += circumstances_text(calibration);
  std::vector<std::string> components;
  std::string rows;
  for (std::size_t row = 0; row < max_axes; ++row) {
    if (!calibration.tells[row]) continue;
    components.push_back(fmt::format("\"{}\"", wrench_names[row]));
    rows += fmt::format("  {},\n", row_text(calibration.matrix.row(static_cast<Eigen::Index>(row))));
  }
  if (components.size() < max_axes) text += fmt::format("components = [{}]\n", fmt::join(components, ", "));
  text += "units = { force = \"N\", torque = \"N·m\", signal = \"V\" }\nmatrix = [\n" + rows;
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
