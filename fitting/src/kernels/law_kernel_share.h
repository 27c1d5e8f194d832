#pragma once

#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include <kerf/models/registry.h>

#include "kernels/arms_kernel_of.h"
#include "kernels/law_kernel_of.h"
#include "kernels/wide/wide_kernel.h"

namespace kerf::fitting {

/// In how many sources the kernels are compiled.
inline constexpr std::size_t kernel_shares = 2;

/// Kernel of a law of the registry; none where nothing is searched in which it would be differentiated.
template <typename L>
struct KernelOf {
  static const LawKernel* get() { return nullptr; }
};
template <template <typename> typename L>
requires(L<double>::facts.search != models::Search::tables) struct KernelOf<L<double>> {
  static const LawKernel* get() {
    constexpr int most = L<double>::facts.searched_at_once;
    constexpr bool has_arms = L<double>::facts.scan.over == models::Scan::prony;
    using OnDuals = std::conditional_t<has_arms, ArmsKernelOf<L>, LawKernelOf<L, most>>;
    static const std::conditional_t<wide::WideOf<L>::exists, wide::WideKernel<L, OnDuals>, OnDuals> kernel;
    return &kernel;
  }
};

/// The kernel of a law if that is in this share: every second law of the registry, say.
template <std::size_t Share>
const LawKernel* kernel_in_share(std::string_view model) {
  const LawKernel* found = nullptr;
  const auto look = [&]<std::size_t I>() {
    using Law = std::tuple_element_t<I, models::Registry>;
    if constexpr (I % kernel_shares == Share) {
      if (Law::name == model) found = KernelOf<Law>::get();
    }
  };
  [&]<std::size_t... I>(std::index_sequence<I...>) { (look.template operator()<I>(), ...); }
  (std::make_index_sequence<std::tuple_size_v<models::Registry>>{});
  return found;
}

/// In law_kernels_2.cpp.
[[nodiscard]] const LawKernel* kernel_in_share_2(std::string_view model);

}  // namespace kerf::fitting
