#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "handles.h"
#include "loop/watchdog.h"

namespace {

/// Before the first step: at no place, so that the first reading repeats none.
kerf::drivers::Sample no_reading() {
  kerf::drivers::Sample sample;
  sample.position.fill(kerf_none());
  return sample;
}

}  // namespace

struct kerf_safety {
  kerf_safety(const kerf::drivers::DeviceInfo& device, const kerf_safety_options& options)
      : count(device.axes.size()),
        stall_s(options.stall_s),
        report_s(options.report_s),
        fresh(device, {.period_s = options.period_s, .soft_start_s = options.soft_start_s}),
        safety(fresh) {}

  std::size_t count;
  double stall_s;
  double report_s;
  kerf::bench::Safety fresh;  ///< before the first step
  kerf::bench::Safety safety;
  kerf::drivers::Sample last = no_reading();
  double unstepped_s = 0.0;  ///< since the law was last stepped
};

namespace {

bool is_time(double elapsed_s) { return std::isfinite(elapsed_s) && elapsed_s > 0.0; }

kerf_safety_options options_or_standard(const kerf_safety_options* options) {
  constexpr double period_s = 1e-3;
  const kerf::bench::SafetyOptions standard{.period_s = period_s};
  if (options == nullptr) {
    return {.period_s = period_s,
            .soft_start_s = standard.soft_start_s,
            .stall_s = 1e-9 * static_cast<double>(kerf::bench::watchdog_limit_ns(period_s)),
            .report_s = 0.0};
  }
  const auto is_known = [](double seconds) { return std::isfinite(seconds) && seconds >= 0.0; };
  if (!is_time(options->period_s) || !is_time(options->stall_s) || !is_known(options->soft_start_s) ||
      !is_known(options->report_s)) {
    throw std::invalid_argument(
        fmt::format("safety: period {} s, soft start {} s, stall {} s, report {} s; expected a finite period "
                    "and stall above 0, "
                    "and the others finite and 0 or more",
                    options->period_s, options->soft_start_s, options->stall_s, options->report_s));
  }
  return *options;
}

void require(bool holds, const kerf::models::LawAxis& axis, std::string_view what, double value,
             std::string_view expected) {
  if (holds) return;
  throw std::invalid_argument(
      fmt::format("safety: axis '{}': the limit of {} is {}, expected {}", axis.name, what, value, expected));
}

kerf::drivers::AxisInfo limited(const kerf::models::LawAxis& axis, const kerf_limits& limits) {
  const auto above_zero = [&](double value, std::string_view what) {
    require(is_time(value), axis, what, value, "a finite number above 0");
  };
  const auto known_or_zero = [&](double value, std::string_view what) {
    require(std::isfinite(value) && value >= 0.0, axis, what, value,
            "a finite number, or 0 where it is not known");
  };
  above_zero(limits.force, "force");
  above_zero(limits.slew, "slew");
  known_or_zero(limits.speed, "speed");
  known_or_zero(limits.acceleration, "acceleration");
  known_or_zero(limits.resolution, "resolution");
  return {.name = axis.name,
          .position_unit = axis.position_unit,
          .force_unit = axis.force_unit,
          .resolution = limits.resolution,
          .force_limit = limits.force,
          .slew_limit = limits.slew,
          .speed_limit = limits.speed,
          .acceleration_limit = limits.acceleration};
}

/// A position that has stayed the same for less than the time between reports is of the report before.
std::uint32_t judge(kerf_safety& of, const kerf::models::SpatialMotion& motion, double elapsed_s) noexcept {
  // Of sums of periods the last digits differ.
  const double age_s = of.last.age_s + elapsed_s;
  const bool is_same = of.last.position == motion.position && age_s < 0.999 * of.report_s;
  of.last.position = motion.position;
  of.last.velocity = motion.velocity;
  of.last.age_s = is_same ? age_s : 0.0;
  return of.safety.judge(kerf::drivers::Status::ok, of.last, elapsed_s, elapsed_s > of.stall_s);
}

std::uint32_t apply(kerf_safety& of, std::uint32_t flags, double* force) noexcept {
  kerf::bench::Command command{.flags = flags};
  std::copy_n(force, of.count, command.force.begin());
  of.safety.apply(command);
  std::copy_n(command.force.begin(), of.count, force);
  return command.flags;
}

}  // namespace

kerf_status kerf_safety_create(const kerf_law* law, const kerf_limits* limits,
                               const kerf_safety_options* options, kerf_safety** safety, char* error,
                               size_t error_size) {
  *safety = nullptr;
  return kerf::at_set_up(error, error_size, [&] {
    kerf::drivers::DeviceInfo device;
    for (const kerf::models::LawAxis& axis : law->opened->axes)
      device.axes.push_back(limited(axis, limits[device.axes.size()]));
    *safety = new kerf_safety(device, options_or_standard(options));
  });
}

void kerf_safety_destroy(kerf_safety* safety) { delete safety; }

void kerf_safety_reset(kerf_safety* safety) {
  safety->safety = safety->fresh;
  safety->last = no_reading();
  safety->unstepped_s = 0.0;
}

void kerf_safety_confirm(kerf_safety* safety) { safety->safety.confirm(); }

uint32_t kerf_safety_judge(kerf_safety* safety, const double* position, const double* velocity,
                           double elapsed_s) {
  if (!is_time(elapsed_s)) return KERF_LAW_FAULT;
  kerf::models::SpatialMotion motion;
  std::copy_n(position, safety->count, motion.position.begin());
  // A velocity that the host does not have is not one that cannot be true.
  for (std::size_t axis = 0; velocity != nullptr && axis < safety->count; ++axis)
    motion.velocity[axis] = std::isnan(velocity[axis]) ? 0.0 : velocity[axis];
  return judge(*safety, motion, elapsed_s);
}

uint32_t kerf_safety_apply(kerf_safety* safety, uint32_t flags, double* force) {
  return apply(*safety, flags, force);
}

uint32_t kerf_step_safely(kerf_safety* safety, kerf_state* state, const double* position,
                          const double* velocity, double elapsed_s, double* force) {
  const bool fits = state->axes == safety->count;
  const double time_s = std::isnan(elapsed_s) ? state->clock.elapsed_s() : elapsed_s;
  state->pass(time_s);
  std::uint32_t flags = KERF_LAW_FAULT;
  if (fits && is_time(time_s)) {
    const kerf::models::SpatialMotion& motion = kerf::motion_of(*state, position, velocity);
    flags = judge(*safety, motion, time_s);
    safety->unstepped_s += time_s;
    if (flags == 0) {
      flags = kerf::step_axes(*state, motion, safety->unstepped_s, force);
      safety->unstepped_s = 0.0;
    }
  }
  if (flags != 0) std::fill_n(force, safety->count, 0.0);
  return apply(*safety, flags, force);
}
