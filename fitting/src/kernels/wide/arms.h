#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "kernels/wide/block.h"

namespace kerf::fitting::wide {

/// What four rows of one period do to an arm.
struct FourRows {
  double period_s = 0.0;
  std::array<double, 4> loss{};    ///< over one to four ticks
  double once = 0.0, twice = 0.0;  ///< what is left after one tick, and two
  double gain = 0.0;               ///< c
  double fading = 0.0;             ///< q a
  double gain_slope = 0.0;         ///< c - a
};

struct Arm {
  double stiffness = 0.0;
  double time_s = 0.0;
  double g = 0.0;
  double h = 0.0;
  FourRows rows;  ///< of the last period
};

/// A spring and arms of a spring and a dashpot beside it, exact for motion that is linear within a tick
/// (kerf/models/integrator.h). In columns, x the displacement [m]:
///
///     x;   for each arm g, of its force per stiffness, and h = dg / d log(tau)
///
///     g[n+1] = a g[n] + c (x[n+1] - x[n]),               a = exp(-q), c = (1 - a) / q, q = T / tau
///     h[n+1] = a h[n] + q a g[n] + (c - a) (x[n+1] - x[n])
///
/// Four rows at a time where they are equally far apart: what the arm held before them fades by 1 - exp(-k
/// q), and the rest is a sum over the four. Else row by row, four arms at a time.
class Arms {
 public:
  static constexpr std::size_t most = (Block::most_columns - 1) / 2;
  static constexpr std::size_t places = 8;  ///< for them, in whole packets

  /// What a tick of one period does to each of them, as FourRows has it.
  struct Tick {
    double period_s = 0.0;
    std::array<double, places> loss{}, gain{}, fading{}, gain_slope{};
  };

  Arms(double spring, std::span<const double> stiffness, std::span<const double> time_s, bool bilateral);

  static constexpr bool remembers = true;
  [[nodiscard]] std::size_t columns() const noexcept { return 1 + 2 * count_; }
  void fill(Block& block) noexcept;
  /// Of the periods that came; found anew where there were too many.
  [[nodiscard]] const Tick& tick_of(double period_s) noexcept;

 private:
  std::array<Arm, most> arms_{};
  std::size_t count_;
  double spring_;
  bool bilateral_;
  bool started_ = false;
  double before_ = 0.0;
  std::array<Tick, 128> ticks_{};
};

}  // namespace kerf::fitting::wide
