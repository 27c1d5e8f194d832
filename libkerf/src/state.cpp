#include <algorithm>
#include <ctime>

#include "handles.h"

namespace kerf {

double StepClock::elapsed_s() noexcept {
  constexpr double first_s = 1e-3;
  constexpr std::int64_t per_second = 1'000'000'000;
  timespec now{};
  (void)clock_gettime(CLOCK_MONOTONIC, &now);
  const std::int64_t now_ns = static_cast<std::int64_t>(now.tv_sec) * per_second + now.tv_nsec;
  // Two steps within one count of the clock are one count apart.
  const double elapsed_s =
      last_ns_ == 0 ? first_s : 1e-9 * static_cast<double>(std::max<std::int64_t>(now_ns - last_ns_, 1));
  last_ns_ = now_ns;
  return elapsed_s;
}

namespace {

/// The velocity along a state's only axis.
double velocity_of(kerf_state& state, double position, double velocity) noexcept {
  if (!std::isnan(velocity)) return velocity;
  // What is not finite would stay in the filter for good; the law refuses the tick anyhow.
  if (!std::isfinite(position)) return 0.0;
  const double filtered = state.filter.update(0, position, state.now_s);
  state.filter.advance(state.now_s);
  return filtered;
}

std::uint32_t flag_of(bool fault) noexcept { return fault ? std::uint32_t{KERF_LAW_FAULT} : 0U; }

}  // namespace

models::SpatialMotion motion_of(kerf_state& state, const double* position, const double* velocity) noexcept {
  const std::size_t axes = state.opened->axes.size();
  models::SpatialMotion motion;
  bool lacking = false;
  bool finite = true;
  for (std::size_t axis = 0; axis < axes; ++axis) {
    motion.position[axis] = position[axis];
    motion.velocity[axis] = velocity == nullptr ? kerf_none() : velocity[axis];
    lacking |= std::isnan(motion.velocity[axis]);
    finite &= std::isfinite(position[axis]);
  }
  if (!lacking) return motion;
  for (std::size_t axis = 0; axis < axes; ++axis) {
    const double filtered = finite ? state.filter.update(axis, position[axis], state.now_s) : 0.0;
    if (std::isnan(motion.velocity[axis])) motion.velocity[axis] = filtered;
  }
  if (finite) state.filter.advance(state.now_s);
  return motion;
}

std::uint32_t step_axes(kerf_state& state, const models::SpatialMotion& motion, double elapsed_s,
                        double* force) noexcept {
  const OpenedLaw& law = *state.opened;
  if (!law.spatial) {
    const models::Contact& contact = law.file.contact;
    const models::Response response =
        law.file.law.step(state.memory, contact.motion(motion.position[0], motion.velocity[0]), elapsed_s);
    force[0] = contact.force_on_axis(response.force);
    return flag_of(response.fault);
  }
  const models::SpatialResponse response = law.file.law.step(state.memory, motion, elapsed_s);
  std::copy_n(response.force.begin(), law.axes.size(), force);
  return flag_of(response.fault);
}

}  // namespace kerf

using namespace kerf;

kerf_status kerf_state_create(const kerf_law* law, kerf_state** state, char* error, size_t error_size) {
  *state = nullptr;
  return at_set_up(error, error_size, [&] { *state = new kerf_state(law->opened); });
}

kerf_status kerf_state_copy(const kerf_state* from, kerf_state** copy, char* error, size_t error_size) {
  *copy = nullptr;
  return at_set_up(error, error_size, [&] {
    *copy = new kerf_state(*from);
    (*copy)->clock.restart();
  });
}

void kerf_state_destroy(kerf_state* state) { delete state; }

kerf_status kerf_state_assign(kerf_state* to, const kerf_state* from) {
  if (to->opened != from->opened) return KERF_BAD_INPUT;
  to->memory = from->memory;
  to->filter = from->filter;
  to->now_s = from->now_s;
  to->clock.restart();
  return KERF_OK;
}

void kerf_state_reset(kerf_state* state) {
  state->memory = state->opened->initial;
  state->filter = {};
  state->now_s = 0.0;
  state->clock.restart();
}

double kerf_state_energy(const kerf_state* state) {
  return state->opened->file.law.stored_energy(state->memory);
}

uint32_t kerf_step(kerf_state* state, double position, double velocity, double elapsed_s, double* force) {
  const double time_s = state->elapse(elapsed_s);
  const models::Contact& contact = state->opened->file.contact;
  const models::Response response = state->opened->file.law.step(
      state->memory, contact.motion(position, velocity_of(*state, position, velocity)), time_s);
  *force = contact.force_on_axis(response.force);
  return flag_of(response.fault);
}

uint32_t kerf_step_depth(kerf_state* state, double penetration, double velocity, double elapsed_s,
                         double* force) {
  const double time_s = state->elapse(elapsed_s);
  const models::Response response = state->opened->file.law.step(
      state->memory,
      models::Motion{.penetration = penetration, .velocity = velocity_of(*state, penetration, velocity)},
      time_s);
  *force = response.force;
  return flag_of(response.fault);
}

uint32_t kerf_step_axes(kerf_state* state, const double* position, const double* velocity, double elapsed_s,
                        double* force) {
  const double time_s = state->elapse(elapsed_s);
  return step_axes(*state, motion_of(*state, position, velocity), time_s, force);
}
