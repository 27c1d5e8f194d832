#pragma once

#include <string_view>

#include <kerf/drivers/device.h>
#include <kerf/drivers/simulated_mechanism.h>
#include <kerf/drivers/uri.h>

namespace kerf::drivers {

/// `sim:pose6`: a tool of six degrees of freedom in a hand that moves it about.
///
/// Axes `x, y, z` [m] and `rx, ry, rz` [rad, rotation vector], forces in N and torques in N·m. They are
/// independent of each other: a mass and a moment of inertia, no coupling by gyroscopic terms, which at a
/// hand's speeds are small. The limits are those of a Phantom Premium 1.5 with a six-axis wrist (8.5 N,
/// 0.515 N·m; encoder steps 0.03 mm and 0.8 mrad), told from memory. Each axis of the hand's equilibrium is a
/// sine of its own frequency, between 0.2 and 0.6 Hz, that is faded in over the first second.
class SimulatedPose6 final : public Device {
 public:
  struct Options {
    bool with_hand = true;
    double reach_m = 0.02;    ///< amplitude of the translations
    double swing_rad = 0.26;  ///< amplitude of the rotations, 15 deg
    SimulatedMechanism::Options mechanism;
  };

  SimulatedPose6(std::string_view uri, const Options& options, Surroundings surroundings);

  /// Reads the options of a URI: seed, hand, noise, encoder, truth, reach, swing; it leaves `fault` to
  /// open_device(). @throws DeviceError for one that is unknown or out of range.
  static Options parse_options(Uri uri);

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return mechanism_.info(); }
  [[nodiscard]] Status read(double now_s, Sample& sample) noexcept override;
  [[nodiscard]] Status write(const Axes& force) noexcept override { return mechanism_.write(force); }
  void release(double at_s) noexcept override { mechanism_.release(at_s); }

 private:
  Options options_;
  SimulatedMechanism mechanism_;
};

}  // namespace kerf::drivers
