#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kerf::identification {

/// One axis of a device as the bench can know it by commands and readings alone:
///
///     m x'' = u(t - d) + o - b x' - f sign(x') - k x
///
/// u is the force that was commanded, held from tick to tick; x is read at the ticks. In metres and newtons,
/// or radians and N·m where an axis has no lever.
///
/// Friction that is stronger one way than the other, f+ against the motion up and f- down, and a constant
/// force g (gravity) move the axis in exactly the same way: only f = (f+ + f-) / 2 and o = g - (f+ - f-) / 2
/// are in the motion, whether the axis slides or sticks. Who knows one of the two differences knows the
/// other.
struct AxisModel {
  double mass_kg = 0.1;            ///< m > 0; in the hand, that of device and hand
  double viscous_n_s_per_m = 0.0;  ///< b
  double coulomb_n = 0.0;          ///< f >= 0
  double stiffness_n_per_m = 0.0;  ///< k: of a hand, a spring, or gravity that changes with the place
  double offset_n = 0.0;           ///< o
  double delay_s = 0.0;            ///< d >= 0: from a command to what of it is seen in a reading
  double saturation_n = 0.0;       ///< what is commanded beyond it does nothing; 0: no such limit
};

/// Where an axis is and how fast it moves.
struct Motion {
  double position_m = 0.0;
  double speed_m_s = 0.0;
};

/// The force of friction F over a tick of length T.
struct TickFriction {
  double mean_n = 0.0;
  double moment_n_s = 0.0;  ///< mean of F (t - T/2): how much of it comes late in the tick
};

/// An affine step of a motion over a fixed time under a constant force: exact for the model without friction.
struct Transition {
  double xx = 1.0, xv = 0.0, xf = 0.0;
  double vx = 0.0, vv = 1.0, vf = 0.0;

  [[nodiscard]] Motion step(Motion at, double force_n) const noexcept {
    return {xx * at.position_m + xv * at.speed_m_s + xf * force_n,
            vx * at.position_m + vv * at.speed_m_s + vf * force_n};
  }
};
[[nodiscard]] Transition transition_over(const AxisModel& model, double time_s) noexcept;

/// The motion of the model from tick to tick, without error of integration: where nothing changes its sign it
/// is one product with a matrix exponential, and the moment at which the speed passes through zero is found
/// to 1e-12 of the tick. From there the axis sticks, while the drive stays within f, or moves back.
class AxisSimulation {
 public:
  AxisSimulation(const AxisModel& model, double period_s);

  /// The motion a tick after `motion` was true at tick n. Commands before the first one are zero.
  /// `friction`: gets that of the tick, where it is asked for.
  [[nodiscard]] Motion after(Motion motion, std::span<const double> commanded_n, std::size_t n,
                             TickFriction* friction = nullptr) const noexcept;

  /// The parts of a tick: until the delayed command changes, and from there.
  [[nodiscard]] const Transition& before_change() const noexcept { return before_; }
  [[nodiscard]] const Transition& after_change() const noexcept { return after_; }
  [[nodiscard]] std::size_t whole_ticks() const noexcept { return whole_ticks_; }

 private:
  /// Sums of a tick's friction: F t and F t (t - T/2) of each piece in which it does not change.
  struct FrictionSums {
    double from_s = 0.0;
    double impulse = 0.0;
    double moment = 0.0;
  };
  /// Motion over a part of a tick that begins at `sums->from_s`.
  [[nodiscard]] Motion part(Motion motion, double force_n, double time_s, const Transition& whole,
                            FrictionSums* sums) const noexcept;

  AxisModel model_;
  double period_s_;
  std::size_t whole_ticks_ = 0;  ///< of the delay
  double before_s_ = 0.0;        ///< of a tick, with the older command
  double after_s_ = 0.0;
  Transition before_;
  Transition after_;
};

/// Positions at the ticks begin, begin + 1, ... of `count` readings from a motion at `begin`.
/// `friction`: gets that of the ticks from each reading to the next, where it is asked for.
void simulate(const AxisModel& model, double period_s, Motion at_begin, std::span<const double> commanded_n,
              std::size_t begin, std::span<double> position_m, std::span<TickFriction> friction = {});

}  // namespace kerf::identification
