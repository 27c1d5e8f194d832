#include <algorithm>
#include <ctime>
#include <limits>

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

constexpr double no_velocity = std::numeric_limits<double>::quiet_NaN();

/// Those along the axes of a state that the host lacks. Apart: its loop would slow down who has all.
[[gnu::noinline]] void fill_velocities(kerf_state& state) noexcept {
  models::SpatialMotion& motion = state.motion;
  const bool finite = std::all_of(motion.position.begin(), motion.position.end(),
                                  [](double position) { return std::isfinite(position); });
  for (std::size_t axis = 0; axis < state.axes; ++axis) {
    const double filtered = finite ? state.filter.update(axis, motion.position[axis], state.now_s) : 0.0;
    if (std::isnan(motion.velocity[axis])) motion.velocity[axis] = filtered;
  }
  if (finite) state.filter.advance(state.now_s);
}

std::uint32_t flag_of(bool fault) noexcept { return fault ? std::uint32_t{KERF_LAW_FAULT} : 0U; }

}  // namespace

const models::SpatialMotion& motion_of(kerf_state& state, const double* position,
                                       const double* velocity) noexcept {
  models::SpatialMotion& motion = state.motion;
  bool lacking = false;
  for (std::size_t axis = 0; axis < state.axes; ++axis) {
    motion.position[axis] = position[axis];
    motion.velocity[axis] = velocity == nullptr ? no_velocity : velocity[axis];
    lacking |= std::isnan(motion.velocity[axis]);
  }
  if (lacking) fill_velocities(state);
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
  // A call of memmove() takes longer than these few numbers.
  for (std::size_t axis = 0; axis < models::max_law_axes; ++axis) {
    if (axis < state.axes) force[axis] = response.force[axis];
  }
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
