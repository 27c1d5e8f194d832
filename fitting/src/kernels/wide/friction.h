#pragma once

#include <kerf/models/friction.h>

#include "kernels/wide/block.h"

namespace kerf::fitting::wide {

/// Friction (kerf/models/friction.h) in columns 1, x, v, Dahl's state z, and h = dz / d log(xd):
///
///     z[n+1] = z[n] e + s (1 - e),     e = exp(-|dx| / xd), s = sgn dx
///     h[n+1] = h[n] e + (z[n] - s) e |dx| / xd
///
/// Decays four rows at a time, the states two.
class Friction {
 public:
  explicit Friction(const models::Friction<double>& law) : law_(law) {}

  static constexpr bool remembers = true;
  [[nodiscard]] static std::size_t columns() noexcept { return 5; }
  void fill(Block& block) noexcept;

 private:
  models::Friction<double> law_;
  bool started_ = false;
  double before_ = 0.0;  ///< position [m]
  double slip_ = 0.0;
  double slip_slope_ = 0.0;
};

}  // namespace kerf::fitting::wide
