#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include "kerf/drivers/device_model.h"
#include "kerf/drivers/toml_text.h"
#include "small_file.h"
#include "toml_reader.h"

namespace kerf::drivers {
namespace {

constexpr std::size_t largest_device_model = 1U << 20U;  // bytes

/// "2026-01-31T12:00:00Z", with a month and a day that there can be.
bool is_utc_date(std::string_view text) {
  constexpr std::string_view shape = "0000-00-00T00:00:00Z";
  if (text.size() != shape.size()) return false;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const bool digit = text[i] >= '0' && text[i] <= '9';
    if (shape[i] == '0' ? !digit : text[i] != shape[i]) return false;
  }
  const auto two = [&](std::size_t at) { return 10 * (text[at] - '0') + (text[at + 1] - '0'); };
  return two(5) >= 1 && two(5) <= 12 && two(8) >= 1 && two(8) <= 31 && two(11) < 24 && two(14) < 60 &&
         two(17) <= 60;
}

/// Reads one file and says in it what is wrong where.
class ModelReader : TomlReader {
 public:
  ModelReader(const toml::table& root, const std::string& name) : TomlReader(root, name) {}

  DeviceModel read() const {
    require_format();
    allow_only(
        root_,
        {"format", "kerf", "date", "rate_hz", "held", "conditions", "temperature_degc", "device", "axis"},
        "a device's model");
    DeviceModel model;
    model.kerf = optional_text(root_, "kerf");
    model.date = text(required(root_, "date", "\"2026-01-31T12:00:00Z\""), "date");
    if (!is_utc_date(model.date))
      refuse(*root_.get("date"), "'date' is \"{}\", expected UTC as \"2026-01-31T12:00:00Z\"", model.date);
    model.rate_hz = positive(required(root_, "rate_hz", "the loop's rate [Hz]"), "'rate_hz'");
    model.held = flag(required(root_, "held", "true or false: was it in a hand?"), "held");
    model.conditions = optional_text(root_, "conditions");
    if (const toml::node* node = root_.get("temperature_degc"))
      model.temperature_degc = number(*node, "'temperature_degc'");
    read_identity(model);
    read_axes(model);
    return model;
  }

 private:
  /// First of all: a later format may have any keys.
  void require_format() const {
    const toml::node& node = required(root_, "format", fmt::format("{}", DeviceModel::format));
    const auto format = node.is_integer() ? node.value<std::int64_t>() : std::nullopt;
    if (!format || *format < 1) refuse(node, "'format' must be a whole number, {}", DeviceModel::format);
    if (*format > DeviceModel::format) {
      refuse(node, "'format' is {}, and this Kerf reads {} at most: take a newer one, or identify it anew",
             *format, DeviceModel::format);
    }
  }

  void read_identity(DeviceModel& model) const {
    const toml::node& node = required(root_, "device", "a table [device] with uri and model");
    const toml::table& device = table(node, "'device' must be a table: [device]");
    allow_only(device, {"uri", "model", "serial", "port"}, "[device]");
    model.uri = text(required(device, "uri", "the device that was measured"), "uri");
    model.model = text(required(device, "model", "the model that 'kerf devices' tells"), "model");
    if (device.get("serial") != nullptr) model.serial = optional_text(device, "serial");
    model.port = optional_text(device, "port");
  }

  void read_axes(DeviceModel& model) const {
    const toml::node& node = required(root_, "axis", "a table [[axis]] for each axis");
    const toml::array* list = node.as_array();
    if (list == nullptr || list->empty() || list->size() > max_axes)
      refuse(node, "'axis' must be 1 to {} tables: [[axis]]", max_axes);
    for (const toml::node& one : *list) {
      AxisModel axis = read_axis(table(one, "'axis' must be tables: [[axis]]"));
      if (model.axis(axis.name) != nullptr) refuse(one, "axis '{}' stands twice", axis.name);
      model.axes.push_back(std::move(axis));
    }
  }

  AxisModel read_axis(const toml::table& table) const {
    std::vector<std::string_view> known{"name",   "position_unit", "force_unit", "lever",
                                        "limits", "gravity_table", "hand",       "validation"};
    for (const AxisNumber& one : axis_numbers()) known.push_back(one.key);
    allow_only(table, known, "[[axis]]");
    AxisModel axis;
    axis.name = text(required(table, "name", "the axis' name"), "name");
    axis.position_unit = unit(table, "position_unit", {"m", "rad"});
    axis.force_unit = unit(table, "force_unit", {"N", "N·m"});
    if (const toml::node* node = table.get("lever")) axis.lever = positive(*node, "'lever'");
    if (const toml::node* node = table.get("limits")) axis.limits = limits(*node, axis);
    for (const AxisNumber& one : axis_numbers()) {
      if (const toml::node* node = table.get(one.key)) axis.*one.member = estimate(*node, one, axis);
    }
    if (axis.mass && !(axis.mass->value > 0.0)) refuse(*table.get("mass"), "'mass' must be more than 0");
    if (const toml::node* node = table.get("gravity_table")) axis.gravity_table = gravity(*node);
    if (const toml::node* node = table.get("hand")) {
      const toml::table& hand = this->table(*node, "'hand' must be a table: { mass = ..., ... }");
      allow_only(hand, {"mass", "damping", "stiffness"}, "'hand'");
      for (const AxisNumber& one : hand_numbers()) {
        if (const toml::node* number = hand.get(one.key)) axis.*one.member = estimate(*number, one, axis);
      }
    }
    if (const toml::node* node = table.get("validation")) axis.validation = validation(*node);
    return axis;
  }

  Estimate estimate(const toml::node& node, const AxisNumber& of, const AxisModel& axis) const {
    const std::string expected = unit_of(of, axis);
    const toml::table* given = node.as_table();
    if (given == nullptr) {
      refuse(node, "'{}' must be written {{ value = ..., lower = ..., upper = ..., unit = \"{}\" }}", of.key,
             expected);
    }
    allow_only(*given, {"value", "lower", "upper", "unit"}, fmt::format("'{}'", of.key));
    const auto part = [&](std::string_view key, bool may_be_infinite) {
      const toml::node* one = given->get(key);
      if (one == nullptr) refuse(node, "'{}' has no {}", of.key, key);
      return number(*one, fmt::format("the {} of '{}'", key, of.key), may_be_infinite);
    };
    const Estimate estimate{
        .value = part("value", false), .lower = part("lower", true), .upper = part("upper", true)};
    const toml::node* unit = given->get("unit");
    if (unit == nullptr) refuse(node, "'{}' has no unit; expected \"{}\"", of.key, expected);
    if (const std::string said = text(*unit, "unit"); said != expected)
      refuse(*unit, "'{}' is given in {}, expected {}", of.key, said, expected);
    if (!(estimate.lower <= estimate.value && estimate.value <= estimate.upper)) {
      refuse(node, "'{}' is {} and its interval {} to {}: expected one that holds it", of.key, estimate.value,
             estimate.lower, estimate.upper);
    }
    if (!of.may_be_negative && estimate.value < 0.0)
      refuse(node, "'{}' is {}, expected no negative number", of.key, estimate.value);
    return estimate;
  }

  ModelLimits limits(const toml::node& node, const AxisModel& axis) const {
    const toml::table& given = table(node, "'limits' must be a table: { lower = ..., upper = ..., ... }");
    allow_only(given, {"lower", "upper", "force", "slew", "speed", "acceleration"}, "'limits'");
    const auto part = [&](std::string_view key, bool any_sign) {
      const toml::node* one = given.get(key);
      if (one == nullptr) return 0.0;
      const double value = number(*one, fmt::format("the {} of 'limits'", key));
      if (!any_sign && value < 0.0) refuse(*one, "the {} of 'limits' is negative", key);
      return value;
    };
    const ModelLimits limits{.lower = part("lower", true),
                             .upper = part("upper", true),
                             .force = part("force", false),
                             .slew = part("slew", false),
                             .speed = part("speed", false),
                             .acceleration = part("acceleration", false)};
    if (!(limits.lower <= limits.upper))
      refuse(node, "axis '{}' ranges from {} to {}: expected a greater upper end", axis.name, limits.lower,
             limits.upper);
    return limits;
  }

  GravityTable gravity(const toml::node& node) const {
    const toml::table& given = table(node, "'gravity_table' must be { position = [...], force = [...] }");
    allow_only(given, {"position", "force"}, "'gravity_table'");
    GravityTable gravity{.position = numbers(given, "position"), .force = numbers(given, "force")};
    if (gravity.position.empty() || gravity.position.size() != gravity.force.size()) {
      refuse(node, "'gravity_table' has {} places and {} forces, expected as many of each, one at least",
             gravity.position.size(), gravity.force.size());
    }
    if (std::ranges::adjacent_find(gravity.position, std::greater_equal()) != gravity.position.end())
      refuse(node, "the places of 'gravity_table' must grow");
    return gravity;
  }

  ModelValidation validation(const toml::node& node) const {
    const toml::table& given = table(node, "'validation' must be a table: { fits = ..., verdict = ... }");
    allow_only(given, {"fits", "error", "verdict", "why_not"}, "'validation'");
    ModelValidation validation;
    if (const toml::node* fits = given.get("fits")) validation.fits = flag(*fits, "fits");
    if (const toml::node* error = given.get("error")) {
      validation.error = number(*error, "'error'");
      if (*validation.error < 0.0) refuse(*error, "'error' is a share, which is not negative");
    }
    validation.verdict = optional_text(given, "verdict");
    if (const toml::node* why = given.get("why_not")) {
      const toml::array* list = why->as_array();
      if (list == nullptr) refuse(*why, "'why_not' must be a list of texts");
      for (const toml::node& one : *list) validation.why_not.push_back(text(one, "why_not"));
    }
    return validation;
  }

  double positive(const toml::node& node, std::string_view what) const {
    const double value = number(node, what);
    if (!(value > 0.0)) refuse(node, "{} is {}, expected more than 0", what, value);
    return value;
  }
  std::vector<double> numbers(const toml::table& table, std::string_view key) const {
    const toml::node& node = required(table, key, "a list of numbers");
    const toml::array* list = node.as_array();
    if (list == nullptr) refuse(node, "'{}' must be a list of numbers", key);
    std::vector<double> values;
    for (const toml::node& one : *list) values.push_back(number(one, fmt::format("'{}'", key)));
    return values;
  }
  std::string unit(const toml::table& table, std::string_view key,
                   std::initializer_list<std::string_view> known) const {
    const toml::node& node = required(table, key, fmt::format("{}", fmt::join(known, " or ")));
    std::string given = text(node, key);
    if (std::ranges::find(known, given) == known.end())
      refuse(node, "'{}' is \"{}\", expected {}", key, given, fmt::join(known, " or "));
    return given;
  }
};

std::string numbers_text(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "[" : ", ") + toml_number(value);
  return text + "]";
}

std::string estimate_text(const AxisNumber& number, const AxisModel& axis) {
  const Estimate& of = *(axis.*number.member);
  return fmt::format("{} = {{ value = {}, lower = {}, upper = {}, unit = \"{}\" }}", number.key,
                     toml_number(of.value), toml_number(of.lower), toml_number(of.upper),
                     unit_of(number, axis));
}

std::string validation_text(const ModelValidation& of) {
  std::vector<std::string> parts;
  if (of.fits) parts.push_back(fmt::format("fits = {}", *of.fits));
  if (of.error) parts.push_back("error = " + toml_number(*of.error));
  if (!of.verdict.empty()) parts.push_back("verdict = " + toml_text(of.verdict));
  if (!of.why_not.empty()) {
    std::vector<std::string> reasons;
    for (const std::string& why : of.why_not) reasons.push_back(toml_text(why));
    parts.push_back(fmt::format("why_not = [{}]", fmt::join(reasons, ", ")));
  }
  return parts.empty() ? "" : fmt::format("validation = {{ {} }}\n", fmt::join(parts, ", "));
}

std::string axis_text(const AxisModel& axis) {
  std::string text = fmt::format("\n[[axis]]\nname = {}\nposition_unit = \"{}\"\nforce_unit = \"{}\"\n",
                                 toml_text(axis.name), axis.position_unit, axis.force_unit);
  if (axis.lever != 1.0) text += fmt::format("lever = {}\n", toml_number(axis.lever));
  const ModelLimits& limits = axis.limits;
  text += fmt::format(
      "limits = {{ lower = {}, upper = {}, force = {}, slew = {}, speed = {}, acceleration = {} }}\n",
      toml_number(limits.lower), toml_number(limits.upper), toml_number(limits.force),
      toml_number(limits.slew), toml_number(limits.speed), toml_number(limits.acceleration));
  for (const AxisNumber& one : axis_numbers()) {
    if (axis.*one.member) text += estimate_text(one, axis) + "\n";
  }
  if (axis.gravity_table) {
    text += fmt::format("gravity_table = {{ position = {}, force = {} }}\n",
                        numbers_text(axis.gravity_table->position), numbers_text(axis.gravity_table->force));
  }
  std::vector<std::string> hand;
  for (const AxisNumber& one : hand_numbers()) {
    if (axis.*one.member) hand.push_back(estimate_text(one, axis));
  }
  if (!hand.empty()) text += fmt::format("hand = {{ {} }}\n", fmt::join(hand, ", "));
  return text + validation_text(axis.validation);
}

}  // namespace

DeviceModel parse_device_model(const std::string& text, const std::string& name) {
  try {
    const toml::table root = toml::parse(text, name);
    return ModelReader(root, name).read();
  } catch (const toml::parse_error& error) {
    throw DeviceError(
        fmt::format("{}:{}: not TOML: {}", name, error.source().begin.line, error.description()));
  }
}

DeviceModel read_device_model(const std::string& file) {
  const SmallFile read = read_small_file(file, largest_device_model);
  if (!read.problem.empty()) {
    throw std::invalid_argument(
        fmt::format("{}: the device's model cannot be read ({}); is the path right? 'kerf identify' writes "
                    "such a file",
                    file, read.problem));
  }
  return parse_device_model(read.content, file);
}

std::string to_toml(const DeviceModel& model) {
  std::string text = fmt::format(
      "# A device as it was measured; docs/device-models.md says what the numbers mean.\n"
      "format = {}\nkerf = {}\ndate = \"{}\"\nrate_hz = {}\nheld = {}\n",
      DeviceModel::format, toml_text(model.kerf), model.date, toml_number(model.rate_hz), model.held);
  if (!model.conditions.empty()) text += fmt::format("conditions = {}\n", toml_text(model.conditions));
  if (model.temperature_degc)
    text += fmt::format("temperature_degc = {}\n", toml_number(*model.temperature_degc));
  text += fmt::format("\n[device]\nuri = {}\nmodel = {}\n", toml_text(model.uri), toml_text(model.model));
  if (model.serial) text += fmt::format("serial = {}\n", toml_text(*model.serial));
  if (!model.port.empty()) text += fmt::format("port = {}\n", toml_text(model.port));
  for (const AxisModel& axis : model.axes) text += axis_text(axis);
  return text;
}

}  // namespace kerf::drivers
