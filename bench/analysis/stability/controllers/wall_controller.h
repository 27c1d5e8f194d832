#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "loop/passivity.h"
#include "stability/device/free_motion.h"
#include "stability/device/sampled_device.h"
#include "stability/device/sampled_loop.h"
#include "stability/wall/wall_theory.h"

namespace kerf::bench {

/// Ways to render one wall F = -K x - B v on a device.
enum class WallController : std::uint8_t { none, damping, coupling, passivity, exact };
inline constexpr std::array wall_controllers{WallController::none, WallController::damping,
                                             WallController::coupling, WallController::passivity,
                                             WallController::exact};
/// "none", "damping", "virtual coupling", "passivity", "exact".
[[nodiscard]] std::string_view name_of(WallController controller) noexcept;

/// A controller with its numbers, as design_controller() chooses them for a device.
struct ControllerDesign {
  WallController controller = WallController::none;
  SampledDevice device;                     ///< that it is for; its hand counts for nothing
  double most_damping_n_s_per_m = 0.0;      ///< damping: of wall and controller together
  double coupling_stiffness_n_per_m = 0.0;  ///< K_c
  double coupling_damping_n_s_per_m = 0.0;  ///< B_c
};

/// A wall as a controller renders it, a tick at a time: what is read of the axis, relative to the wall, to a
/// force. Nothing but its construction allocates.
///
///     none        F = -K x - B v,   v as the device reads it
///
///     damping     F = -K x - max(B, B_d) v
///
///     coupling    a proxy p in the wall, and between it and the device a spring and a damper
///                 [ColgateStanleyBrown1995, AdamsHannaford1999]:
///                 F = -K p - B (p - p') / T = -K_c e - B_c w,   e = x - p,   w += g ((e - e') / T - w)
///                 solved for p in each tick (' is the tick before, g the gain of the velocity filter)
///
///     passivity   none, and what PassivityController brakes; the wall stores K x^2 / 2
///
///     exact       the force that is held from a to b does the work of the wall over that way:
///                 F = -K (x_a + x_b) / 2 - B (x_b - x_a) / T,   a = t + delay,   b = a + T
///                 Places and speed at a are foretold from this reading and the one before, by the exact
///                 motion of the device alone (m, b) under the commands on their way, less what the hand
///                 holds against: their slow part u, below 5 Hz. x_b follows from F itself:
///                 F = -(K x_a + c (h v_a - g u)) / (1 + c g),   x_b = x_a + h v_a + g (F - u),
///                 c = K / 2 + B / T
///                 A sample-estimate-hold [EllisSarkarJenkins1997] with that estimate; without u a delayed
///                 wall would be too soft under a hand that leans on it, by K (T + delay)^2 / (2 m).
class ControlledWall {
 public:
  /// What a linear controller carries from tick to tick.
  struct Memory {
    double last_m = 0.0;                                              ///< reading, or e
    double rate_m_s = 0.0;                                            ///< w
    double proxy_m = 0.0;                                             ///< p
    double balance_n = 0.0;                                           ///< u
    std::array<double, SampledDevice::max_delay_ticks + 2> sent_n{};  ///< from the newest on
  };

  /// @throws std::invalid_argument as check() of the device.
  explicit ControlledWall(const ControllerDesign& design);

  /// Begins anew with a wall: the next reading is taken for one at rest.
  void begin(const Wall& wall) noexcept;
  [[nodiscard]] double step(const AxisReading& reading) noexcept {
    switch (controller_) {
      case WallController::none:
      case WallController::damping:
        return plain(reading);
      case WallController::coupling:
        return coupled(reading.position_m);
      case WallController::passivity:
        return passive(reading);
      case WallController::exact:
        break;
    }
    return exact(reading.position_m);
  }

  /// The controller is linear: what it does follows from Memory.
  [[nodiscard]] bool is_linear() const noexcept { return controller_ != WallController::passivity; }
  /// A step from a memory that is not its own, for who looks for its matrix; of a linear one.
  [[nodiscard]] double step_from(Memory& memory, const AxisReading& reading) noexcept;

 private:
  [[nodiscard]] double plain(const AxisReading& reading) const noexcept {
    return -wall_.stiffness_n_per_m * reading.position_m - damping_ * reading.speed_m_s;
  }
  [[nodiscard]] double coupled(double position_m) noexcept;
  [[nodiscard]] double passive(const AxisReading& reading) noexcept;
  [[nodiscard]] double exact(double position_m) noexcept;

  WallController controller_;
  double period_s_;
  double gain_;
  double slow_gain_;  ///< of u
  double most_damping_;
  double coupling_stiffness_;
  double coupling_damping_;
  SplitDelay delay_;
  FreeMotion::Transition before_, after_, whole_;
  PassivityController brake_;
  Wall wall_;
  double damping_ = 0.0;
  bool started_ = false;
  double stored_j_ = 0.0;
  Memory memory_;
};

}  // namespace kerf::bench
