#include <array>
#include <stdexcept>
#include <string>
#include <utility>

#include <kerf/models/exponential.h>
#include <kerf/models/fracture.h>
#include <kerf/models/friction.h>
#include <kerf/models/fuzzy_kelvin.h>
#include <kerf/models/fuzzy_rupture.h>
#include <kerf/models/hunt_crossley.h>
#include <kerf/models/kelvin.h>
#include <kerf/models/maxwell.h>
#include <kerf/models/piecewise.h>
#include <kerf/models/precontact.h>
#include <kerf/models/scissors_analytic.h>
#include <kerf/models/springpot.h>

#include "law_kernel_of.h"

namespace kerf::fitting {
namespace {

/// Most: how many parameters are differentiated in one pass.
template <template <typename> typename Law, int Most>
std::pair<std::string_view, const LawKernel*> entry() {
  static const LawKernelOf<Law, Most> kernel;
  return {Law<double>::name, &kernel};
}

}  // namespace

RunView view_of(const Samples& samples, const Weights& weights, std::size_t run) {
  const auto [begin, end, noise] = samples.runs[run];
  return {.motion = &samples.motion[begin],
          .period_s = &samples.period_s[begin],
          .force = &samples.force[begin],
          .weight = &weights[begin],
          .count = end - begin};
}

const LawKernel& kernel_of(std::string_view model) {
  static const std::array kernels{entry<models::Kelvin, 4>(),       entry<models::Exponential, 4>(),
                                  entry<models::Precontact, 4>(),   entry<models::ScissorsAnalytic, 4>(),
                                  entry<models::HuntCrossley, 4>(), entry<models::Springpot, 4>(),
                                  entry<models::Friction, 5>(),     entry<models::Fracture, 5>(),
                                  entry<models::Maxwell, 14>(),     entry<models::Piecewise, 8>(),
                                  entry<models::FuzzyRupture, 8>(), entry<models::FuzzyKelvin, 8>()};
  for (const auto& [name, kernel] : kernels) {
    if (name == model) return *kernel;
  }
  throw std::invalid_argument("law '" + std::string(model) + "' has no fit");
}

}  // namespace kerf::fitting
