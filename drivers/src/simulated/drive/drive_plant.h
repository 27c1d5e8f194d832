#pragma once

#include <optional>

#include "kerf/drivers/simulated_drive.h"
#include "kerf/mechanisms/held_mass.h"
#include "simulated/drive/two_masses.h"

namespace kerf::drivers {

/// What moves along one axis of a SimulatedDrive: exact between the moments at which it is asked, in travel.
class DrivePlant {
 public:
  /// What pushes it, constant while it moves.
  struct Push {
    double motor_n = 0.0;
    double tissue_n = 0.0;
    double tremor_n = 0.0;
    double hand_place_m = 0.0;  ///< where the hand's spring rests, and how fast that moves
    double hand_speed_m_s = 0.0;
  };

  /// `usual_s` is the time that most moves take; others are as exact.
  DrivePlant(const SimulatedDrive::Axis& axis, bool with_hand, double usual_s);

  void move(const Push& push, double time_s) noexcept;
  /// What the motor's encoder would see, before it.
  [[nodiscard]] const mechanisms::AxisMotion& motor() const noexcept { return state_.motor; }
  /// What tissue and hand touch.
  [[nodiscard]] const mechanisms::AxisMotion& handle() const noexcept {
    return linked_ ? state_.handle : state_.motor;
  }
  /// What hand and tissue exert on the handle at this moment.
  [[nodiscard]] double outer_force_n(const Push& push) const noexcept;
  /// Where it stands before anything happens: zero, or the middle of a range without it.
  [[nodiscard]] double home_m() const noexcept { return home_m_; }

 private:
  /// Gravity and cogging at a place.
  [[nodiscard]] double field_n(double place_m) const noexcept;
  [[nodiscard]] double handle_acceleration(const Push& push) const noexcept;
  void stop_at_the_ends() noexcept;

  SimulatedDrive::Axis axis_;
  HandImpedance hand_;
  mechanisms::HeldMass whole_;  ///< rigid: motor, handle and hand
  mechanisms::HeldMassMotion usual_;
  double usual_s_;
  std::optional<TwoMasses> linked_;
  TwoMasses::State state_;
  double lower_m_;
  double upper_m_;
  double home_m_ = 0.0;
};

/// Whether an axis has what has to be asked every TwoMasses::step_s.
[[nodiscard]] bool is_stepped_finely(const SimulatedDrive::Axis& axis) noexcept;

}  // namespace kerf::drivers
