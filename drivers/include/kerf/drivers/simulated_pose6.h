#pragma once

#include <optional>
#include <string_view>

#include <kerf/drivers/device.h>
#include <kerf/drivers/hand.h>
#include <kerf/drivers/pose_path.h>
#include <kerf/drivers/simulated_mechanism.h>
#include <kerf/drivers/uri.h>

namespace kerf::drivers {

/// `sim:pose6`: a tool of six degrees of freedom in a hand that moves it about.
///
/// Axes `x, y, z` [m] and `rx, ry, rz` [rad, rotation vector], forces in N and torques in N·m. They are
/// independent of each other: a mass and a moment of inertia, no coupling by gyroscopic terms, which at a
/// hand's speeds are small. The limits are those of a Phantom Premium 1.5 with a six-axis wrist (8.5 N,
/// 0.515 N·m; encoder steps 0.03 mm and 0.8 mrad), told from memory; the tool of 0.15 kg and 2.5e-4 kg·m^2
/// and its friction are assumed. The hand holds it by a stylus grip (HandOptions), and with 2.5e-4 kg·m^2,
/// 0.02 N·m·s/rad and 1 N·m/rad about each axis; other values of mass, damping and grip change these in
/// proportion.
///
/// The hand follows `path`. Without one, each axis of its equilibrium is a sine of its own frequency, between
/// 0.2 and 0.6 Hz, that begins a radian after the axis' before it and is faded in over the first second.
class SimulatedPose6 final : public Device {
 public:
  struct Options {
    bool with_hand = true;
    double reach_m = 0.02;                  ///< amplitude of the translations
    double swing_rad = 0.26;                ///< amplitude of the rotations, 15 deg
    std::optional<PosePath::Options> path;  ///< in place of the sines; the tool begins at its first pose
    double hand_mass_kg = HandOptions{}.mass_kg;
    double hand_damping_n_s_per_m = HandOptions{}.damping_n_s_per_m;
    double hand_stiffness_n_per_m = HandOptions{}.stiffness_n_per_m;
    SimulatedMechanism::Options mechanism;
  };

  SimulatedPose6(std::string_view uri, const Options& options, Surroundings surroundings);

  /// Reads the options of a URI: seed, hand, noise, encoder, truth, reach, swing, path,
  /// repeat, mass, damping, grip; it leaves `fault` to
  /// open_device(). @throws DeviceError for one that is unknown or out of range.
  static Options parse_options(Uri uri);

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return mechanism_.info(); }
  [[nodiscard]] Status read(double now_s, Sample& sample) noexcept override;
  [[nodiscard]] Status write(const Axes& force) noexcept override { return mechanism_.write(force); }
  void release(double at_s) noexcept override { mechanism_.release(at_s); }

 private:
  void wish_at(double time_s, SimulatedMechanism::Equilibria& wish) const noexcept;

  Options options_;
  std::optional<PosePath> path_;
  SimulatedMechanism mechanism_;
};

}  // namespace kerf::drivers
