#pragma once

#include <string_view>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/drivers/simulated_mechanism.h>
#include <kerf/drivers/tip_path.h>
#include <kerf/drivers/uri.h>
#include <kerf/mechanisms/premium.h>

namespace kerf::drivers {

/// `sim:premium`: a Phantom Premium 1.5 of three degrees of freedom with a hand at its tip.
///
/// Axes `q1, q2, q3` [rad] with torques in N·m; channels `tip_x, tip_y, tip_z` [m], made from the encoders'
/// angles. Frame, angles and rigid bodies are those of mechanisms::Premium, so that here, unlike in the other
/// simulated devices, the axes act on each other. With the hand a spring and damper at the tip x:
///
///     H q'' + C q' + g = tau + J^T [K (x_d - x) + D (x_d' - J q')] - b q' - f_c sign(q')
///
/// where the hand's mass is a payload whose weight the hand carries itself. Stepped every 50 us for the speed
/// at its end, with C, the hand and viscous friction implicit; Coulomb friction takes at most the speed there
/// is, so that a joint can stick, and a stop takes the speed towards it. None of them makes energy.
class SimulatedPremium final : public Device {
 public:
  struct Options {
    bool with_hand = true;
    bool with_friction = true;
    TipPath::Options path;  ///< without waypoints: drawn by the seed within `reach_m`
    double reach_m = 0.04;
    double hand_mass_kg = 0.15;  ///< of the hand as of HandOptions
    double hand_damping_n_s_per_m = 5.0;
    double hand_stiffness_n_per_m = 500.0;
    mechanisms::Premium::Options arm;
    SimulatedMechanism::Options mechanism;
  };

  /// @throws DeviceError for a waypoint that the tip cannot reach.
  SimulatedPremium(std::string_view uri, const Options& options, Surroundings surroundings);

  /// Reads the options of a URI: seed, hand, noise, encoder, truth, friction, gravity, payload, path, reach,
  /// stroke, pause, mass, damping, grip; it leaves `fault` to open_device().
  /// @throws DeviceError for one that is unknown or out of range.
  static Options parse_options(Uri uri);

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return mechanism_.info(); }
  [[nodiscard]] Status read(double now_s, Sample& sample) noexcept override;
  [[nodiscard]] Status write(const Axes& force) noexcept override { return mechanism_.write(force); }
  void release(double at_s) noexcept override { mechanism_.release(at_s); }

  static constexpr double viscous_n_m_s = 0.0005;  ///< b of each joint [N·m·s/rad]

 private:
  void move(double time_s, SimulatedMechanism::States& states, const Axes& force) const noexcept;

  Options options_;
  mechanisms::Premium arm_;  ///< with the hand's mass at the tip
  TipPath path_;
  SimulatedMechanism mechanism_;
};

}  // namespace kerf::drivers
