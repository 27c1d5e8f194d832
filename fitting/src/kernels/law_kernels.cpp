#include <stdexcept>
#include <string>

#include "kernels/foreign_kernel.h"
#include "kernels/law_kernel_share.h"

namespace kerf::fitting {

RunView view_of(const Samples& samples, const Weights& weights, std::size_t run) {
  const auto [begin, end, noise, contact] = samples.runs[run];
  return {.motion = &samples.motion[begin],
          .period_s = &samples.period_s[begin],
          .force = &samples.force[begin],
          .weight = &weights[begin],
          .count = end - begin};
}

RunView summed_view_of(const Samples& samples, const Weights& weights, std::size_t run) {
  RunView view = view_of(samples, weights, run);
  while (view.count > 0 && view.weight[view.count - 1] == 0.0) --view.count;
  return view;
}

const LawKernel* kernel_if_any(std::string_view model) {
  if (const models::ForeignLaw* const foreign = models::foreign_law(model)) return &kernel_of(*foreign);
  const LawKernel* const kernel = kernel_in_share<0>(model);
  return kernel != nullptr ? kernel : kernel_in_share_2(model);
}

const LawKernel& kernel_of(std::string_view model) {
  const LawKernel* const kernel = kernel_if_any(model);
  if (kernel == nullptr) throw std::invalid_argument("law '" + std::string(model) + "' has no fit");
  return *kernel;
}

}  // namespace kerf::fitting
