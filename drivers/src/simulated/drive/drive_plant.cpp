#include "simulated/drive/drive_plant.h"

#include <cmath>
#include <numbers>

namespace kerf::drivers {
namespace {

constexpr double stiff_n_per_m = 50e3;  ///< of the flanks of play, where the link itself is rigid

double value_or_0(const Known& known) noexcept { return known ? known->value : 0.0; }

mechanisms::HeldMass whole_of(const AxisModel& model, const HandImpedance& hand) noexcept {
  return {.mass_kg = model.mass->value + hand.mass_kg,
          .damping_n_s_per_m = value_or_0(model.viscous) + hand.damping_n_s_per_m,
          .stiffness_n_per_m = hand.stiffness_n_per_m,
          .coulomb_up_n = value_or_0(model.coulomb_up),
          .coulomb_down_n = value_or_0(model.coulomb_down)};
}

bool has_a_link(const SimulatedDrive::Axis& axis) noexcept {
  return axis.backlash_m > 0.0 || axis.flexible_n_per_m > 0.0;
}

}  // namespace

bool is_stepped_finely(const SimulatedDrive::Axis& axis) noexcept {
  return has_a_link(axis) || axis.cogging_n > 0.0 || axis.model.gravity_table;
}

DrivePlant::DrivePlant(const SimulatedDrive::Axis& axis, bool with_hand, double usual_s)
    : axis_(axis),
      hand_(with_hand ? axis.hand : HandImpedance{}),
      whole_(whole_of(axis.model, hand_)),
      usual_(whole_, usual_s),
      usual_s_(usual_s),
      lower_m_(axis.model.limits.lower * axis.model.lever),
      upper_m_(axis.model.limits.upper * axis.model.lever) {
  if (lower_m_ > 0.0 || upper_m_ < 0.0) home_m_ = 0.5 * (lower_m_ + upper_m_);
  state_.motor.position_m = home_m_;
  state_.handle.position_m = home_m_;
  if (!has_a_link(axis)) return;
  TwoMasses linked;
  linked.motor = whole_;
  linked.motor.mass_kg = (1.0 - axis.flexible_share) * axis.model.mass->value;
  linked.motor.damping_n_s_per_m = value_or_0(axis.model.viscous);
  linked.motor.stiffness_n_per_m = 0.0;
  linked.grounded = {.mass_kg = axis.flexible_share * axis.model.mass->value + hand_.mass_kg,
                     .damping_n_s_per_m = hand_.damping_n_s_per_m,
                     .stiffness_n_per_m = hand_.stiffness_n_per_m};
  linked.stiffness_n_per_m = axis.flexible_n_per_m > 0.0 ? axis.flexible_n_per_m : stiff_n_per_m;
  linked.damping_n_s_per_m = axis.flexible_n_s_per_m;
  linked.gap_m = axis.backlash_m;
  linked.prepare();
  linked_ = linked;
}

double DrivePlant::field_n(double place_m) const noexcept {
  const AxisModel& model = axis_.model;
  double force_n =
      model.gravity_table ? model.gravity_table->at(place_m / model.lever) : value_or_0(model.gravity);
  if (axis_.cogging_n > 0.0)
    force_n += axis_.cogging_n * std::sin(2.0 * std::numbers::pi * place_m / axis_.cogging_period_m);
  return force_n;
}

void DrivePlant::move(const Push& push, double time_s) noexcept {
  // At the place in the middle of a fine step a field is right to the second order.
  const double middle_m = state_.motor.position_m + 0.5 * time_s * state_.motor.speed_m_s;
  const double motor_n = push.motor_n + field_n(middle_m);
  const double handle_n = push.tissue_n + push.tremor_n + hand_.damping_n_s_per_m * push.hand_speed_m_s;
  if (linked_) {
    linked_->step(state_, motor_n, handle_n, push.hand_place_m, time_s);
  } else {
    const mechanisms::AxisMotion from{.position_m = state_.motor.position_m - push.hand_place_m,
                                      .speed_m_s = state_.motor.speed_m_s};
    const double force_n = motor_n + handle_n;
    state_.motor = std::abs(time_s - usual_s_) < 1e-12 ? usual_.after(from, force_n)
                                                       : whole_.after(from, force_n, time_s);
    state_.motor.position_m += push.hand_place_m;
  }
  stop_at_the_ends();
}

void DrivePlant::stop_at_the_ends() noexcept {
  mechanisms::AxisMotion& at = state_.motor;
  if (at.position_m > upper_m_) at = {upper_m_, std::fmin(at.speed_m_s, 0.0)};
  if (at.position_m < lower_m_) at = {lower_m_, std::fmax(at.speed_m_s, 0.0)};
}

double DrivePlant::handle_acceleration(const Push& push) const noexcept {
  const double motor_n = push.motor_n + field_n(state_.motor.position_m);
  const double handle_n = push.tissue_n + push.tremor_n + hand_.damping_n_s_per_m * push.hand_speed_m_s +
                          hand_.stiffness_n_per_m * push.hand_place_m;
  if (linked_) {
    const mechanisms::AxisMotion& at = state_.handle;
    return (handle_n - linked_->grounded.stiffness_n_per_m * at.position_m -
            linked_->grounded.damping_n_s_per_m * at.speed_m_s - linked_->coupling_n(state_)) /
           linked_->grounded.mass_kg;
  }
  const mechanisms::AxisMotion& at = state_.motor;
  const double sign = whole_.direction(at, motor_n + handle_n);
  if (sign == 0.0) return 0.0;
  if ((at.position_m >= upper_m_ && sign > 0.0) || (at.position_m <= lower_m_ && sign < 0.0)) return 0.0;
  return (motor_n + handle_n - whole_.stiffness_n_per_m * at.position_m -
          whole_.damping_n_s_per_m * at.speed_m_s - sign * whole_.friction_n(sign)) /
         whole_.mass_kg;
}

double DrivePlant::outer_force_n(const Push& push) const noexcept {
  const mechanisms::AxisMotion& at = handle();
  return push.tissue_n + push.tremor_n + hand_.stiffness_n_per_m * (push.hand_place_m - at.position_m) +
         hand_.damping_n_s_per_m * (push.hand_speed_m_s - at.speed_m_s) -
         hand_.mass_kg * handle_acceleration(push);
}

}  // namespace kerf::drivers
