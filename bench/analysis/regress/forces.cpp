#include "regress/forces.h"

#include "chart/cost/tick_cost.h"
#include "laws/placement.h"
#include "laws/render.h"

namespace kerf::bench {

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
  const TimedLaw timed{.rendering = {law.law, law.contact, own_axes(law)}, .path = &motion};
  return tick_costs({&timed, 1}, {.cold_ticks = 0}).front().mean_rounds;
}

std::string build_kind() {
#ifdef __OPTIMIZE__
  return "optimised";
#else
  return "not optimised";
#endif
}

}  // namespace kerf::bench
