#include "kerf/drivers/simulated_sensor.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "kerf/drivers/device_notes.h"
#include "kerf/drivers/toml_text.h"

namespace kerf::drivers {
namespace {

constexpr double full_scale_v = 8.0;
constexpr double room_temperature = 22.0;
constexpr Eigen::Index signal_count = 6;

AxisInfo sensor_axis(std::string name, bool turns) {
  return {.name = std::move(name), .position_unit = turns ? "rad" : "m", .force_unit = turns ? "N·m" : "N"};
}

std::string list_of(const Eigen::Ref<const Eigen::VectorXd>& values) {
  std::string text;
  for (const double one : values) text += (text.empty() ? "[" : ", ") + toml_number(one);
  return text + "]";
}

std::string truth_as_toml(const SimulatedSensor::Truth& truth) {
  std::string rows;
  for (Eigen::Index row = 0; row < signal_count; ++row)
    rows += (rows.empty() ? "" : ", ") + list_of(truth.sensitivity.row(row).transpose());
  return fmt::format(
      "truth = {{ sensitivity = [{}], bias = {}, hysteresis = {}, drift_per_s = {}, per_kelvin = {}, "
      "temperature = {} }}\n",
      rows, list_of(truth.bias), list_of(truth.hysteresis), list_of(truth.drift_per_s),
      list_of(truth.per_kelvin), toml_number(truth.temperature));
}

}  // namespace

SimulatedSensor::Options SimulatedSensor::parse_options(Uri uri) {
  UriOptions given(std::move(uri));
  Options options;
  const auto take = [&](const char* name, std::string_view unit, double& value, double lower, double upper) {
    value = given.number(name, {unit, value, lower, upper});
  };
  options.seed = given.count("seed", options.seed);
  take("force", "N", options.force_n, 1e-3, 1e6);
  take("torque", "Nm", options.torque_n_m, 1e-6, 1e6);
  take("cross_talk", "1", options.cross_talk, 0.0, 0.2);
  take("bias", "V", options.bias_v, 0.0, 5.0);
  take("hysteresis", "1", options.hysteresis, 0.0, 0.1);
  take("creep", "1", options.creep, 0.0, 0.1);
  take("creep_time", "s", options.creep_s, 0.1, 1e5);
  take("drift", "V/s", options.drift_v_per_s, 0.0, 1.0);
  take("per_kelvin", "V/K", options.per_kelvin_v, 0.0, 1.0);
  take("swing", "K", options.swing_k, 0.0, 50.0);
  take("noise", "V", options.noise_v, 0.0, 1.0);
  take("quantum", "V", options.quantum_v, 0.0, 1.0);
  take("range", "V", options.range_v, 1e-3, 1e3);
  options.dead = given.count("dead", options.dead);
  if (options.dead > static_cast<std::uint64_t>(signal_count))
    throw DeviceError("device 'sim:sensor': option 'dead' is the number of a signal, 1 to 6");
  options.mirrored = given.flag("mirrored", options.mirrored);
  options.serial_number = given.text("serial_number").value_or(options.serial_number);
  options.calibration_file = given.file("calibration");
  given.allow("fault");
  given.refuse_others();
  return options;
}

SimulatedSensor::SimulatedSensor(std::string_view uri, const Options& options, Surroundings surroundings)
    : options_(options), load_(std::move(surroundings.tissue_of_axes)), gaussian_(options.seed) {
  draw();
  if (options.calibration_file) {
    calibration_ = read_force_calibration(*options.calibration_file);
    const auto today = std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now());
    for (std::string& line :
         doubts_of(*calibration_, *options.calibration_file, today, options.serial_number))
      note_device(std::move(line));
  }
  info_ = {.uri = std::string(uri),
           .model = "simulated force/torque transducer",
           .about = "simulated force/torque transducer with drawn errors, for kerf calibrate",
           .axes = {sensor_axis("x", false), sensor_axis("y", false), sensor_axis("z", false),
                    sensor_axis("rx", true), sensor_axis("ry", true), sensor_axis("rz", true)},
           .channels = {},
           .measures_force = true,
           .simulated = true,
           .button_channel = {},
           .configuration = truth_as_toml(truth_) + (calibration_ ? to_toml(*calibration_) : std::string()),
           .mounts = calibration_ ? calibration_->mounts : std::vector<ForceMount>{}};
  for (Eigen::Index i = 1; i <= signal_count; ++i)
    info_.channels.push_back({.name = fmt::format("signal_{}", i), .unit = "V"});
  info_.channels.push_back({.name = "temperature", .unit = "degC"});
}

void SimulatedSensor::draw() {
  const std::array<double, 6> full{options_.force_n,    options_.force_n,    3.0 * options_.force_n,
                                   options_.torque_n_m, options_.torque_n_m, options_.torque_n_m};
  const double sign = options_.mirrored ? -1.0 : 1.0;
  for (Eigen::Index i = 0; i < signal_count; ++i) {
    for (Eigen::Index k = 0; k < signal_count; ++k) {
      const double share = (i == k ? 1.0 : 0.0) + options_.cross_talk * gaussian_();
      truth_.sensitivity(i, k) = sign * share * full_scale_v / full.at(static_cast<std::size_t>(k));
    }
  }
  for (Eigen::Index i = 0; i < signal_count; ++i) {
    truth_.bias(i) = options_.bias_v * gaussian_();
    truth_.drift_per_s(i) = options_.drift_v_per_s * gaussian_();
    truth_.per_kelvin(i) = options_.per_kelvin_v * gaussian_();
    const double share = std::clamp(1.0 + 0.25 * gaussian_(), 0.5, 1.5);
    truth_.hysteresis(i) = options_.hysteresis * full_scale_v * share;
  }
  truth_.temperature = room_temperature;
  if (options_.dead > 0) {
    const auto row = static_cast<Eigen::Index>(options_.dead) - 1;
    truth_.sensitivity.row(row).setZero();
    truth_.per_kelvin(row) = truth_.drift_per_s(row) = 0.0;
  }
}

Status SimulatedSensor::read(double now_s, Sample& sample) noexcept {
  const double step_s = std::max(0.0, now_s - last_s_);
  last_s_ = std::max(last_s_, now_s);
  const Axes load = load_ ? load_({}, {}, step_s) : Axes{};
  const Vector6 elastic = truth_.sensitivity * Eigen::Map<const Vector6>(load.data());
  follower_ = follower_.cwiseMax(elastic - truth_.hysteresis).cwiseMin(elastic + truth_.hysteresis);
  creep_ += -std::expm1(-step_s / options_.creep_s) * (options_.creep * elastic - creep_);
  const double warmer =
      options_.swing_k * std::sin(2.0 * std::numbers::pi * last_s_ / options_.swing_period_s);
  sample = {};
  Axes volts{};
  for (Eigen::Index i = 0; i < signal_count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    double value = follower_(i) + creep_(i) + truth_.bias(i) + truth_.drift_per_s(i) * last_s_ +
                   truth_.per_kelvin(i) * warmer + options_.noise_v * gaussian_();
    if (options_.dead == at + 1) value = truth_.bias(i);
    if (options_.quantum_v > 0.0) value = options_.quantum_v * std::round(value / options_.quantum_v);
    volts[at] = std::clamp(value, -options_.range_v, options_.range_v);
    sample.channels[at] = volts[at];
  }
  sample.channels[static_cast<std::size_t>(signal_count)] = truth_.temperature + warmer;
  if (calibration_) {
    sample.force_measured = calibration_->wrench(volts);
  } else {
    sample.force_measured.fill(std::numeric_limits<double>::quiet_NaN());
  }
  return Status::ok;
}

Status SimulatedSensor::write(const Axes& force) noexcept {
  return std::ranges::all_of(force, [](double one) { return std::isfinite(one); }) ? Status::ok
                                                                                   : Status::fault;
}

}  // namespace kerf::drivers
