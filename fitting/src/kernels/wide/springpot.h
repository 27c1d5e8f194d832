#pragma once

#include <array>
#include <vector>

#include <ceres/jet.h>

#include <kerf/models/springpot.h>

#include "kernels/wide/block.h"

namespace kerf::fitting::wide {

/// Springpot (kerf/models/springpot.h) in columns x, and the force of the springpot by c and by alpha. The
/// displacements of its decays follow the motion alone, and no parameter: the rest is two sums of them, with
/// their weights and with the weights' derivatives by alpha.
class Springpot {
 public:
  using Dual = ceres::Jet<double, 1>;

  /// @param law with the derivatives by alpha
  explicit Springpot(const models::Springpot<Dual>& law);

  static constexpr bool remembers = true;
  [[nodiscard]] static std::size_t columns() noexcept { return 3; }
  void fill(Block& block) noexcept;

 private:
  static constexpr std::size_t decays = models::Springpot<double>::decays;
  using Decays = std::array<double, decays>;
  struct Tick {
    double period_s = 0.0;
    alignas(64) Decays share{};
    alignas(64) Decays gain{};  ///< displacement per travel
  };
  const Tick& tick_of(double period_s);

  double stiffness_, fractional_stiffness_;
  double slow_, slow_slope_, fast_, fast_slope_;
  bool bilateral_;
  alignas(64) Decays weight_{};
  alignas(64) Decays slope_{};  ///< of the weights, by alpha
  alignas(64) Decays displacement_{};
  std::vector<Tick> ticks_{};
  bool started_ = false;
  double beginning_ = 0.0;
  double before_ = 0.0;
};

}  // namespace kerf::fitting::wide
