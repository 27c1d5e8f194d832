#include "kernels/law_kernel_share.h"

namespace kerf::fitting {

const LawKernel* kernel_in_share_2(std::string_view model) { return kernel_in_share<1>(model); }

}  // namespace kerf::fitting
