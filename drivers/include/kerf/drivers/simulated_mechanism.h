#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>

#include <kerf/drivers/device.h>
#include <kerf/drivers/gaussian.h>
#include <kerf/drivers/simulated_axis.h>
#include <kerf/drivers/uri.h>
#include <kerf/drivers/velocity_filter.h>

namespace kerf::drivers {

/// What every simulated device has in common: axes with a hand on them, stepped every 50 us under the
/// command, the tissue and the hand; encoders, a force sensor, limits, and the release that a watchdog asks
/// for.
///
/// The velocity is what a driver would give, by VelocityFilter. The force sensor reads what the tissue
/// exerts, with white noise of 20 mN and a step of 2 mN (0.2 mN·m and 0.02 mN·m for a torque). With `truth`,
/// the position before the encoder and the tissue's force before the sensor are further channels.
class SimulatedMechanism {
 public:
  struct Options {
    bool with_noise = true;    ///< noise and steps of the force sensor
    bool with_encoder = true;  ///< steps of the encoders
    bool with_truth = false;
    std::uint64_t seed = 1;

    /// Takes seed, noise, encoder and truth out of a URI. @throws DeviceError for a bad value.
    static Options from(UriOptions& given);
  };
  /// Where the hand wants an axis to be, in the axis' own travel.
  struct Equilibrium {
    double travel_m = 0.0;
    double speed_m_s = 0.0;
  };
  using Equilibria = std::array<Equilibrium, max_axes>;
  using States = std::array<SimulatedAxis::State, max_axes>;

  static constexpr double sub_step_s = 50e-6;

  /// Adds the channels of the truth to `info` where they are asked for.
  SimulatedMechanism(DeviceInfo info, const Options& options, Surroundings surroundings);

  [[nodiscard]] const DeviceInfo& info() const noexcept { return info_; }
  [[nodiscard]] SimulatedAxis& axis(std::size_t at) noexcept { return axes_[at]; }
  void place(std::size_t at, double travel_m) noexcept { states_[at].travel_m = travel_m; }

  /// Steps the physics up to `now_s`; `hand(time_s, equilibria)` is asked once a step for the hand's wishes,
  /// which stay as they were where it does not change them.
  template <typename Hand>
  void run_until(double now_s, Hand hand) noexcept {
    run_coupled_until(now_s, [&](double time_s, States& states, const Axes& force) {
      hand(time_s, equilibria_);
      step(states, force);
    });
  }
  /// The same for axes that act on each other: `move(time_s, states, force)` takes all of them one step on
  /// under the force of command and tissue.
  template <typename Move>
  void run_coupled_until(double now_s, Move move) noexcept {
    const auto target = static_cast<std::uint64_t>(std::llround(std::max(0.0, now_s) / sub_step_s));
    while (steps_ < target) {
      const double time_s = static_cast<double>(++steps_) * sub_step_s;
      move(time_s, states_, force_at(time_s));
      // After the move, so that the sensor and the encoder speak of the same moment.
      touch_tissue();
    }
  }
  /// What encoders and sensor say at `now_s`.
  void measure(double now_s, Sample& sample) noexcept;
  [[nodiscard]] Status write(const Axes& force) noexcept;
  void release(double at_s) noexcept;

 private:
  /// What command and tissue exert.
  [[nodiscard]] Axes force_at(double time_s) const noexcept;
  void step(States& states, const Axes& force) noexcept;
  void touch_tissue() noexcept;

  static constexpr double never = std::numeric_limits<double>::infinity();

  DeviceInfo info_;
  Options options_;
  std::size_t count_;
  std::size_t first_truth_;  ///< channel; before it stand those of the device itself
  std::array<Tissue, max_axes> tissue_;
  TissueOfAxes tissue_of_axes_;
  Gaussian noise_;
  std::array<SimulatedAxis, max_axes> axes_;
  States states_{};
  Equilibria equilibria_{};
  Axes lever_{};
  Axes sensor_scale_{};
  Axes tissue_force_{};
  Axes command_{};
  std::atomic<double> released_at_s_{never};
  std::uint64_t steps_ = 0;
  VelocityFilter velocity_;
};

}  // namespace kerf::drivers
