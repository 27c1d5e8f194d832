#pragma once

#include <kerf/models/exponential.h>

#include "kernels/wide/block.h"

namespace kerf::fitting::wide {

/// Exponential tissue (kerf/models/exponential.h) without `zero_at_contact`, in columns exp(beta x / L0),
/// (beta x / L0) exp(beta x / L0) and v in contact, and 1.
class Exponential {
 public:
  explicit Exponential(const models::Exponential<double>& law) : law_(law) {}

  static constexpr bool remembers = false;
  [[nodiscard]] static std::size_t columns() noexcept { return 4; }
  void fill(Block& block) const noexcept;

 private:
  models::Exponential<double> law_;
};

}  // namespace kerf::fitting::wide
