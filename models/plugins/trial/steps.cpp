#include "trial/steps.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>

#include "trial/allocations.h"
#include "trial/guarded_state.h"
#include "trial/report.h"

namespace kerf::law_trial {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t ticks = 2000;
constexpr std::size_t batch = 50;
constexpr std::size_t least_ticks = 20;
constexpr std::chrono::milliseconds between_signs{200};
constexpr std::chrono::seconds longest{1};

double amplitude(const models::ForeignLaw& law, std::size_t axis) {
  const std::string_view unit =
      law.axes().empty() ? law.info().position_unit : law.axes()[axis].position_unit;
  return unit == "rad" ? 0.2 : 0.005;
}

std::string at_tick(std::size_t tick, const TrialTick& of) {
  return " in step " + std::to_string(tick) + " of its trial (position " + std::to_string(of.position[0]) +
         ", velocity " + std::to_string(of.velocity[0]) + ", after " + std::to_string(of.period_s) +
         " s, initial parameters)";
}

/// One step of the plug-in itself.
models::AxisValues stepped(const kerf_law_v1& law, const double* values, void* state, const TrialTick& tick) {
  models::AxisValues force{};
  law.step(values, state, tick.position.data(), tick.velocity.data(), tick.period_s, force.data());
  return force;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::vector<TrialTick> trial_ticks(const models::ForeignLaw& law) {
  const std::size_t axes = std::max<std::size_t>(1, law.axes().size());
  std::vector<TrialTick> all(ticks);
  for (std::size_t i = 0; i < ticks; ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) * 1e-3;
    all[i].period_s = i == ticks / 3 ? 60.0 : 1e-3;
    for (std::size_t axis = 0; axis < axes; ++axis) {
      all[i].position[axis] = amplitude(law, axis) * std::sin(angle);
      all[i].velocity[axis] = 2.0 * std::numbers::pi * amplitude(law, axis) * std::cos(angle);
    }
  }
  return all;
}

TrialSteps try_steps(const models::ForeignLaw& law) {
  const kerf_law_v1& description = law.description();
  const std::size_t size = description.state_size;
  const std::size_t axes = std::max<std::size_t>(1, law.axes().size());
  const GuardedBlock values(law.initial().size() * sizeof(double), alignof(double), "its parameters");
  std::memcpy(values.bytes(), law.initial().data(), law.initial().size() * sizeof(double));
  values.make_read_only();
  const auto* const parameters = static_cast<const double*>(values.bytes());
  const std::string of_state = "its state of " + std::to_string(size) + " bytes";
  const GuardedBlock state(size, description.state_alignment, of_state);
  const GuardedBlock copy(size, description.state_alignment, of_state);
  report("at its state was made (init)");
  if (description.init != nullptr && description.init(parameters, state.bytes()) != 0)
    refuse("its init() refuses its own initial parameters");
  if (state.is_damaged()) refuse("its init() writes beside " + of_state);
  if (size > 0) std::memcpy(copy.bytes(), state.bytes(), size);

  report("at it was stepped");
  TrialSteps result;
  std::vector<double> times;
  const auto begin = Clock::now();
  auto last_sign = begin;
  auto batch_begin = begin;
  std::size_t in_batch = 0;
  Clock::duration spent{};  // of the batch, in steps and not in what looks after them
  const std::vector<TrialTick> all = trial_ticks(law);
  for (std::size_t i = 0; i < ticks; ++i) {
    const std::size_t allocated = allocations().value_or(0);
    const auto before = Clock::now();
    const models::AxisValues force = stepped(description, parameters, state.bytes(), all[i]);
    const models::AxisValues again = stepped(description, parameters, copy.bytes(), all[i]);
    const auto now = Clock::now();
    spent += now - before;
    result.allocations += allocations().value_or(0) - allocated;
    if (state.is_damaged() || copy.is_damaged()) refuse("it writes beside " + of_state + at_tick(i, all[i]));
    for (std::size_t axis = 0; axis < axes; ++axis) {
      if (!std::isfinite(force[axis])) refuse("it gives a force that is not finite" + at_tick(i, all[i]));
      if (std::bit_cast<std::uint64_t>(force[axis]) != std::bit_cast<std::uint64_t>(again[axis])) {
        refuse("two states of it are not apart: the same motion gives other forces" + at_tick(i, all[i]) +
               "; all that it remembers belongs in its state");
      }
    }
    result.force.push_back(force[0]);
    ++in_batch;
    if (in_batch == batch || now - batch_begin > between_signs) {
      times.push_back(std::chrono::duration<double>(spent).count() /
                      (2.0 * static_cast<double>(in_batch)));  // of two states
      batch_begin = now;
      in_batch = 0;
      spent = {};
    }
    if (now - last_sign > between_signs) {
      report("at it was stepped");
      last_sign = now;
    }
    if (now - begin > longest && i + 1 >= least_ticks) break;
  }
  result.step_s = median(std::move(times));
  return result;
}

}  // namespace kerf::law_trial
