#include "replay/path_rendering.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include <fmt/core.h>

#include <kerf/drivers/hand.h>

namespace kerf::bench {
namespace {

constexpr double turn_stiffness_n_m_per_rad = 1.0;
constexpr double turn_damping_n_m_s_per_rad = 0.02;
constexpr double max_force_n = 5.0;
constexpr double max_torque_n_m = 0.5;

/// What "VALUE" and "AXIS=VALUE" say of an axis, the last word counting.
double value_for(const CouplingOptions::PerAxis& given, const char* option, const drivers::DeviceInfo& device,
                 std::size_t axis, double standard) {
  double value = standard;
  for (const std::string& text : given) {
    const auto equals = text.find('=');
    const std::string name = equals == std::string::npos ? "" : text.substr(0, equals);
    const std::string_view digits =
        std::string_view(text).substr(equals == std::string::npos ? 0 : equals + 1);
    double number = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(number) ||
        number < 0.0)
      throw std::invalid_argument(
          fmt::format("{} '{}': expected VALUE or AXIS=VALUE with a number from 0 on", option, text));
    if (!name.empty() && std::ranges::none_of(device.axes, [&](const auto& one) { return one.name == name; }))
      throw std::invalid_argument(
          fmt::format("{} '{}': {} has no axis '{}'", option, text, device.model, name));
    if (name.empty() || name == device.axes[axis].name) value = number;
  }
  return value;
}

}  // namespace

std::array<Coupling, drivers::max_axes> couplings(const CouplingOptions& options,
                                                  const drivers::DeviceInfo& device) {
  std::array<Coupling, drivers::max_axes> all;
  for (std::size_t axis = 0; axis < device.axes.size(); ++axis) {
    const drivers::AxisInfo& info = device.axes[axis];
    const bool pushes = info.force_unit == "N";
    const auto value = [&](const CouplingOptions::PerAxis& given, const char* option, double force,
                           double torque) {
      return value_for(given, option, device, axis, pushes ? force : torque);
    };
    const double lever = pushes ? info.lever : 1.0;
    Coupling& one = all[axis];
    one.stiffness = lever * value(options.stiffness, "--stiffness", drivers::usual_grip.stiffness_n_per_m,
                                  turn_stiffness_n_m_per_rad);
    one.damping = lever * value(options.damping, "--damping", drivers::usual_grip.damping_n_s_per_m,
                                turn_damping_n_m_s_per_rad);
    one.force_limit = value(options.force_limit, "--limit", std::min(0.5 * info.force_limit, max_force_n),
                            std::min(0.5 * info.force_limit, max_torque_n_m));
    if (one.force_limit > info.force_limit) {
      throw std::invalid_argument(fmt::format("--limit: {:g} {} is more than axis '{}' of {} may exert, {:g}",
                                              one.force_limit, info.force_unit, info.name, device.model,
                                              info.force_limit));
    }
  }
  return all;
}

double PathReport::error_rms(std::size_t axis) const noexcept {
  return std::sqrt(axes[axis].squares / (playing > 0 ? static_cast<double>(playing) : 1.0));
}

Command PathRendering::operator()(const drivers::Sample& sample, double elapsed_s) noexcept {
  // Ticks that a late loop passed over are made up for; while it stalled, or rendered nothing, the path
  // waits.
  constexpr double longest_made_up_s = 0.01;
  if (elapsed_s > longest_made_up_s) elapsed_s = path_->period_s;
  const auto ticks = static_cast<std::uint64_t>(std::llround(elapsed_s / path_->period_s));
  const Reference reference = player_.step(ticks, sample.position);
  count(reference, sample);
  double gain = 1.0;
  if (reference.finished) {
    faded_s_ += elapsed_s;
    gain = faded_s_ < fade_s_ ? 1.0 - faded_s_ / fade_s_ : 0.0;
    report_->finished = gain == 0.0;
  }
  Command command;
  for (const std::size_t axis : path_->axes) {
    const Coupling& coupling = coupling_[axis];
    const double wanted = coupling.stiffness * (reference.position[axis] - sample.position[axis]) +
                          coupling.damping * (reference.velocity[axis] - sample.velocity[axis]);
    const double limited = std::clamp(wanted, -coupling.force_limit, coupling.force_limit);
    if (limited != wanted) ++report_->axes[axis].limited;
    command.force[axis] = gain * limited;
  }
  return command;
}

void PathRendering::count(const Reference& reference, const drivers::Sample& sample) noexcept {
  if (reference.playing) ++report_->playing;
  for (const std::size_t axis : path_->axes) {
    PathReport::Axis& one = report_->axes[axis];
    const double before = started_ ? last_[axis] : sample.position[axis];
    one.largest_step = std::max(one.largest_step, std::abs(reference.position[axis] - before));
    if (!reference.playing) continue;
    const double error = reference.position[axis] - sample.position[axis];
    one.squares += error * error;
    one.worst = std::max(one.worst, std::abs(error));
  }
  last_ = reference.position;
  started_ = true;
}

}  // namespace kerf::bench
