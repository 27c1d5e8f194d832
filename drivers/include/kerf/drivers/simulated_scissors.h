#pragma once

#include <string_view>

#include <kerf/drivers/device.h>
#include <kerf/drivers/hand.h>
#include <kerf/drivers/simulated_mechanism.h>
#include <kerf/drivers/uri.h>

namespace kerf::drivers {

/// `sim:scissors`: the haptic scissors of [Weiss2004] and [Okamura2003] with a hand on them.
///
/// Axis 0 is `theta`, the angle between the blades [rad]; closing makes it smaller, and its force [N] acts at
/// the handle, positive where it opens the blades. Axis 1 is `x_s`, the translation of the scissors [m],
/// force [N]. Resolution and limits as printed in [Okamura2003]: 0.056 deg and 280 mN·m, which is 7.58 N at
/// the handle (lever 36.9 mm); 0.0152 mm and 159 N. The paper gives neither inertia nor friction: handle
/// inertia 2e-5 kg·m^2, carriage 0.4 kg, viscous friction 0.2 N·s/m and Coulomb friction 0.1 N at the handle
/// are assumed here. The hand's mass, damping and stiffness are those of a stylus grip (HandOptions).
///
/// Encoders, sensor, physics and truth are those of SimulatedMechanism.
class SimulatedScissors final : public Device {
 public:
  struct Options {
    /// What the hand does with the handle.
    enum class Motion : std::uint8_t {
      drawn,    ///< strokes that vary, of HandOptions::seed
      strokes,  ///< without variation, a pause ahead of each, for as long as it is asked
      sine,     ///< from one end, half of a period a stroke
    };
    HandOptions hand;
    Motion motion = Motion::drawn;
    bool begins_open = true;  ///< strokes and sine
    bool with_hand = true;
    SimulatedMechanism::Options mechanism;
  };

  SimulatedScissors(std::string_view uri, const Options& options, Surroundings surroundings);

  /// Reads the options of a URI: seed, hand, noise, encoder, truth, open, close, stroke, pause, variation,
  /// target, begins, mass, damping, grip; it leaves `fault` to open_device().
  /// @throws DeviceError for one that is unknown or out of range.
  static Options parse_options(Uri uri);

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return mechanism_.info(); }
  [[nodiscard]] Status read(double now_s, Sample& sample) noexcept override;
  [[nodiscard]] Status write(const Axes& force) noexcept override { return mechanism_.write(force); }
  void release(double at_s) noexcept override { mechanism_.release(at_s); }

  static constexpr double lever_m = 0.28 / 7.58;

 private:
  /// Where the hand wants the handle to be.
  [[nodiscard]] Strokes::Equilibrium handle_at(double time_s) noexcept;

  Options options_;
  SimulatedMechanism mechanism_;
  Strokes strokes_;
};

}  // namespace kerf::drivers
