#include "regress/forces.h"

#include <cerrno>
#include <cmath>
#include <stdexcept>
#include <system_error>

#include <time.h>

#include "laws/placement.h"
#include "laws/render.h"
#include "loop/command.h"
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

RenderedForces render_forces(const LawFile& law, const SampledMotion& motion) {
  const RenderedMotion commanded = render(law, own_axes(law), motion);
  RenderedForces rendered{
      .channels = {}, .force = {}, .faults = commanded.faults, .first_fault = commanded.first_fault};
  for (const models::LawAxis& axis : axes_of(law)) rendered.channels.push_back({axis.name, axis.force_unit});
  rendered.force.reserve(motion.ticks() * rendered.channels.size());
  const double sense = law.law.is_spatial() ? 1.0 : -law.contact.direction;
  for (const drivers::Axes& force : commanded.force) {
    for (std::size_t axis = 0; axis < rendered.channels.size(); ++axis)
      rendered.force.push_back(sense * force[axis]);
  }
  return rendered;
}

double tick_cost(const LawFile& law, const SampledMotion& motion) {
  if (motion.ticks() == 0) throw std::invalid_argument("there is no motion to time a law along");
  constexpr double enough_ns = 2e7;
  constexpr std::size_t fewest_turns = 7;
  constexpr std::size_t max_turns = 25;
  std::vector<double> ratios;
  double spent_ns = 0.0;
  double sum = 0.0;
  while (ratios.size() < fewest_turns || (spent_ns < enough_ns && ratios.size() < max_turns)) {
    const double before_ns = calibration_ns();
    LawRendering rendering(law.law, law.contact, own_axes(law));
    const double begin_ns = thread_ns();
    for (std::size_t tick = 0; tick < motion.ticks(); ++tick)
      sum += rendering(motion.sample[tick], motion.period_s[tick]).force[0];
    const double law_ns = thread_ns() - begin_ns;
    const double round_ns = 0.5 * (before_ns + calibration_ns());
    ratios.push_back(law_ns / static_cast<double>(motion.ticks()) / round_ns);
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
