#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include <kerf/drivers/simulated_axis.h>

#include "devices/free_tip.h"

namespace kerf::emulators {

/// The tip of an emulated device in a hand that sways about: three axes of the simulated devices' own
/// physics, in steps of theirs under the force of the motors. The hand's wish is x_i(t) = c_i + a sin(2 pi
/// f_i t), f = 0.31, 0.43, 0.59 Hz. Or free (FreeTip).
class HeldTip {
 public:
  struct Options {
    Eigen::Vector3d centre_m{0.0, 0.0, 0.0};
    double sway_m = 0.01;
    double max_travel_m = 0.05;  ///< hard stops, from the centre
    double mass_kg = 0.25;       ///< of tip and hand
    double hand_stiffness_n_per_m = 300.0;
    double hand_damping_n_s_per_m = 5.0;
    std::optional<FreeTip::Options> free;  ///< nobody holds it: all but the centre is said there
  };

  explicit HeldTip(const Options& options);

  /// The force of the motors at the tip, held from now on.
  void push(const Eigen::Vector3d& force_n);
  /// Goes on to `time_s` seconds from the beginning.
  void run_until(double time_s);
  /// Where the hand wants to be, beside its sway: for a person who homes a device.
  void lead(const Eigen::Vector3d& offset_m) noexcept { lead_m_ = offset_m; }

  [[nodiscard]] Eigen::Vector3d position() const noexcept;
  [[nodiscard]] const Eigen::Vector3d& force() const noexcept { return free_ ? free_->force() : force_n_; }

 private:
  Options options_;
  drivers::SimulatedAxis axis_;
  std::array<drivers::SimulatedAxis::State, 3> states_{};  ///< from the centre
  Eigen::Vector3d force_n_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d lead_m_ = Eigen::Vector3d::Zero();
  std::uint64_t steps_ = 0;
  std::optional<FreeTip> free_;
};

}  // namespace kerf::emulators
