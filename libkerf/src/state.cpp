#include <algorithm>
#include <array>
#include <cstring>
#include <ctime>
#include <limits>
#include <type_traits>

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
  if (!std::isnan(velocity)) [[likely]]
    return velocity;
  // What is not finite would stay in the filter for good; the law refuses the tick anyhow.
  if (!std::isfinite(position)) return 0.0;
  const double filtered = state.filter.update(0, position, state.now_s);
  state.filter.advance(state.now_s);
  return filtered;
}

/// Two numbers at once, as laws read them: one that was written as halves keeps its reader waiting, which
/// takes longer than all else here.
using Pair [[gnu::vector_size(2 * sizeof(double))]] = double;
using Pairwise [[gnu::vector_size(2 * sizeof(std::int64_t))]] = std::int64_t;

/// Takes over the motion that a host tells; of those axes that the law has not a zero at most. @returns bits
/// where a velocity lacks.
template <std::size_t Axes, std::size_t At = 0>
Pairwise take_motion(models::SpatialMotion& motion, const double* position, const double* velocity) noexcept {
  if constexpr (At >= Axes) {
    return Pairwise{};
  } else {
    Pair here{position[At], 0.0};
    Pair speed{velocity[At], 0.0};
    if constexpr (At + 1 < Axes) {
      std::memcpy(&here, position + At, sizeof here);
      std::memcpy(&speed, velocity + At, sizeof speed);
    }
    std::memcpy(&motion.position[At], &here, sizeof here);
    std::memcpy(&motion.velocity[At], &speed, sizeof speed);
    return take_motion<Axes, At + 2>(motion, position, velocity) |
           (speed != speed);  // NOLINT(misc-redundant-expression): NaN, of a vector
  }
}

constexpr double no_velocity = std::numeric_limits<double>::quiet_NaN();
constexpr models::AxisValues no_velocities{no_velocity, no_velocity, no_velocity,
                                           no_velocity, no_velocity, no_velocity};

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

template <std::size_t Axes>
[[gnu::always_inline]] inline const models::SpatialMotion& motion_along(kerf_state& state,
                                                                        const double* position,
                                                                        const double* velocity) noexcept {
  const Pairwise lacking =
      take_motion<Axes>(state.motion, position, velocity == nullptr ? no_velocities.data() : velocity);
  if ((lacking[0] | lacking[1]) != 0) [[unlikely]]
    fill_velocities(state);
  return state.motion;
}

std::uint32_t step_contact(kerf_state& state, double position, double velocity, double elapsed_s,
                           double* force) noexcept {
  const OpenedLaw& law = *state.opened;
  const models::Contact& contact = law.file.contact;
  const models::Response response =
      law.file.law.step(state.memory, contact.motion(position, velocity), elapsed_s);
  *force = contact.force_on_axis(response.force);
  return flag_of(response.fault);
}

/// A step of a host that has no time. Apart: what has to be kept over the question to the clock would be put
/// aside in every step.
template <auto step, typename Numbers>
[[gnu::noinline]] std::uint32_t step_by_clock(kerf_state* state, Numbers position, Numbers velocity,
                                              double* force) noexcept {
  return step(state, position, velocity, state->clock.elapsed_s(), force);
}

std::uint32_t step_line(kerf_state* state, const double* position, const double* velocity, double elapsed_s,
                        double* force) noexcept {
  return kerf_step(state, *position, velocity == nullptr ? no_velocity : *velocity, elapsed_s, force);
}

/// Of a law in space.
template <std::size_t Axes>
std::uint32_t step_space(kerf_state* state, const double* position, const double* velocity, double elapsed_s,
                         double* force) noexcept {
  if (std::isnan(elapsed_s)) [[unlikely]]
    return step_by_clock<step_space<Axes>>(state, position, velocity, force);
  state->pass(elapsed_s);
  const models::SpatialMotion& motion = motion_along<Axes>(*state, position, velocity);
  const models::SpatialResponse response = state->opened->file.law.step(state->memory, motion, elapsed_s);
  std::memcpy(force, response.force.data(), Axes * sizeof(double));
  return flag_of(response.fault);
}

/// By the number of axes, which the compiler then knows: loops over as many as a state says took longer than
/// all else here.
constexpr std::array<StepAxes, models::max_law_axes + 1> steps_in_space{
    nullptr, step_space<1>, step_space<2>, step_space<3>, step_space<4>, step_space<5>, step_space<6>};

}  // namespace

StepAxes step_axes_of(const OpenedLaw& law) noexcept {
  return law.spatial ? steps_in_space[law.axes.size()] : step_line;
}

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
  if (!law.spatial) return step_contact(state, motion.position[0], motion.velocity[0], elapsed_s, force);
  const models::SpatialResponse response = law.file.law.step(state.memory, motion, elapsed_s);
  std::copy_n(response.force.begin(), state.axes, force);
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
  if (std::isnan(elapsed_s)) [[unlikely]]
    return step_by_clock<kerf_step>(state, position, velocity, force);
  state->pass(elapsed_s);
  return step_contact(*state, position, velocity_of(*state, position, velocity), elapsed_s, force);
}

uint32_t kerf_step_depth(kerf_state* state, double penetration, double velocity, double elapsed_s,
                         double* force) {
  if (std::isnan(elapsed_s)) [[unlikely]]
    return step_by_clock<kerf_step_depth>(state, penetration, velocity, force);
  state->pass(elapsed_s);
  const models::Response response = state->opened->file.law.step(
      state->memory,
      models::Motion{.penetration = penetration, .velocity = velocity_of(*state, penetration, velocity)},
      elapsed_s);
  *force = response.force;
  return flag_of(response.fault);
}

uint32_t kerf_step_axes(kerf_state* state, const double* position, const double* velocity, double elapsed_s,
                        double* force) {
  return state->step_axes(state, position, velocity, elapsed_s, force);
}
