#include "regress/forces.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <stdexcept>
#include <system_error>

#include <time.h>

#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

/// Time that this thread has had a processor: what others do on the machine does not count.
double thread_ns() {
  timespec now{};
  if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now) != 0)
    throw std::system_error(errno, std::generic_category(), "cannot read the processor's time");
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

/// Steps through ticks [begin, end) and hands every force to `take(tick, axis, force, fault)`.
template <typename Take>
void step_through(const models::Law& law, const models::Contact& contact, const RegressionPath& path,
                  models::Law::State& state, std::size_t begin, std::size_t end, Take take) {
  const bool spatial = law.is_spatial();
  for (std::size_t tick = begin; tick < end; ++tick) {
    if (spatial) {
      const models::SpatialResponse response = law.step(
          state, models::SpatialMotion{path.position[tick], path.velocity[tick]}, path.period_s[tick]);
      for (std::size_t axis = 0; axis < path.axes.size(); ++axis)
        take(tick, axis, response.force[axis], response.fault);
    } else {
      const models::Response response = law.step(
          state, contact.motion(path.position[tick][0], path.velocity[tick][0]), path.period_s[tick]);
      take(tick, 0, response.force, response.fault);
    }
  }
}

/// Nanoseconds of one round of the calibration loop.
double calibration_ns() {
  constexpr int rounds = 20000;
  volatile double seed = 1.5;
  double x = seed;
  const double begin_ns = thread_ns();
  for (int i = 0; i < rounds; ++i) x = std::sqrt(1.25 + x * 0.75) + 1.0 / (1.0 + x);
  const double spent_ns = thread_ns() - begin_ns;
  seed = x;
  return spent_ns / rounds;
}

}  // namespace

RenderedForces render_forces(const models::Law& law, const models::Contact& contact,
                             const RegressionPath& path) {
  RenderedForces rendered;
  for (const models::LawAxis& axis : path.axes) rendered.channels.push_back({axis.name, axis.force_unit});
  rendered.force.reserve(path.ticks() * path.axes.size());
  models::Law::State state = law.initial_state();
  step_through(law, contact, path, state, 0, path.ticks(),
               [&](std::size_t tick, std::size_t axis, double force, bool fault) {
                 rendered.force.push_back(force);
                 if (!fault || axis != 0) return;
                 ++rendered.faults;
                 if (!rendered.first_fault) rendered.first_fault = tick;
               });
  return rendered;
}

double tick_cost(const models::Law& law, const models::Contact& contact, const RegressionPath& path) {
  if (path.ticks() == 0) throw std::invalid_argument("there is no motion to time a law along");
  constexpr double enough_ns = 2e7;
  constexpr std::size_t fewest_turns = 7;
  constexpr std::size_t max_turns = 25;
  std::vector<double> ratios;
  double spent_ns = 0.0;
  double sum = 0.0;
  while (ratios.size() < fewest_turns || (spent_ns < enough_ns && ratios.size() < max_turns)) {
    const double before_ns = calibration_ns();
    models::Law::State state = law.initial_state();
    const double begin_ns = thread_ns();
    step_through(law, contact, path, state, 0, path.ticks(),
                 [&](std::size_t, std::size_t, double force, bool) { sum += force; });
    const double law_ns = thread_ns() - begin_ns;
    const double round_ns = 0.5 * (before_ns + calibration_ns());
    ratios.push_back(law_ns / static_cast<double>(path.ticks()) / round_ns);
    spent_ns += law_ns;
  }
  [[maybe_unused]] const volatile double used = sum;
  return median(std::move(ratios));
}

std::string build_kind() {
#ifdef __OPTIMIZE__
  return "optimised";
#else
  return "not optimised";
#endif
}

}  // namespace kerf::bench
