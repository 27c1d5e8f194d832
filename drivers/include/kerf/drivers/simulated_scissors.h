#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string_view>

#include <kerf/drivers/device.h>
#include <kerf/drivers/gaussian.h>
#include <kerf/drivers/hand.h>
#include <kerf/drivers/simulated_axis.h>
#include <kerf/drivers/uri.h>

namespace kerf::drivers {

/// `sim:scissors`: the haptic scissors of 003 and 004 with a hand on them.
///
/// Axis 0 is `theta`, the angle between the blades [rad]; closing makes it smaller, and its force [N] acts at
/// the handle, positive where it opens the blades. Axis 1 is `x_s`, the translation of the scissors [m],
/// force [N]. Resolution and limits as printed in 004: 0.056 deg and 280 mN·m, which is 7.58 N at the handle
/// (lever 36.9 mm); 0.0152 mm and 159 N. The paper gives neither inertia nor friction: handle inertia 2e-5
/// kg·m^2, carriage 0.4 kg, viscous friction 0.2 N·s/m and Coulomb friction 0.1 N at the handle are assumed
/// here. The hand's mass, damping and stiffness are those of a stylus grip (HandOptions).
///
/// The physics are stepped every 50 us. The velocity is what a driver would give: the difference of the
/// encoder's position, low-passed at first order with a corner of 20 Hz. The force sensor reads what the
/// tissue exerts, with white noise of 0.02 N and a step of 2 mN.
class SimulatedScissors final : public Device {
 public:
  struct Options {
    HandOptions hand;
    bool with_hand = true;
    bool with_noise = true;    ///< noise and steps of the force sensor
    bool with_encoder = true;  ///< steps of the encoders
    std::uint64_t seed = 1;
  };

  SimulatedScissors(std::string_view uri, const Options& options, Surroundings surroundings);

  /// Reads the options of a URI: seed, hand, noise, encoder, open, close, stroke, pause, variation, grip; it leaves
  /// `fault` to open_device().
  /// @throws DeviceError for one that is unknown or out of range.
  static Options parse_options(Uri uri);

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] Status read(double now_s, Sample& sample) noexcept override;
  [[nodiscard]] Status write(const Axes& force) noexcept override;
  void release(double at_s) noexcept override;

  static constexpr double sub_step_s = 50e-6;
  static constexpr double lever_m = 0.28 / 7.58;

 private:
  void step() noexcept;
  void measure(double elapsed_s, Sample& sample) noexcept;

  Options options_;
  Surroundings surroundings_;
  DeviceInfo info_;
  Strokes strokes_;
  Gaussian noise_;
  std::array<SimulatedAxis, 2> axes_;
  std::array<SimulatedAxis::State, 2> states_{};
  std::array<double, 2> tissue_force_{};
  Axes command_{};
  std::atomic<double> released_at_s_;
  std::uint64_t steps_ = 0;
  double last_read_s_ = 0.0;
  bool was_read_ = false;
  Axes last_position_{};
  Axes velocity_{};
};

}  // namespace kerf::drivers
