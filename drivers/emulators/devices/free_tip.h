#pragma once

#include <array>
#include <deque>
#include <optional>

#include <Eigen/Core>

#include <kerf/drivers/uri.h>

namespace kerf::emulators {

/// The tip of an emulated device that nobody holds, moved by its motors alone; along each axis
///
///     m dv/dt = F(t - delay) - b v - f sign(v)
///
/// in closed form from one moment to the next at which a force arrives or the speed passes zero. It shares no
/// code with the simulated devices, so that what is identified through a driver is held against a truth of
/// its own.
class FreeTip {
 public:
  struct Options {
    double mass_kg = 0.2;
    double viscous_n_s_per_m = 0.5;  ///< > 0
    double coulomb_n = 0.1;
    double delay_s = 0.0;        ///< from a motor value to its force
    double max_travel_m = 0.04;  ///< hard stops, from the centre
  };
  /// Of hand=off, with mass, viscous, coulomb and delay; nothing for hand=on, which is the default.
  /// @throws drivers::DeviceError for one of the four where a hand holds the tip.
  [[nodiscard]] static std::optional<Options> in(drivers::UriOptions& given);

  explicit FreeTip(const Options& options) : options_(options) {}

  /// The force of the motors from where it has been run to on; it acts when the delay has passed.
  void push(const Eigen::Vector3d& force_n) { waiting_.push_back({now_s_ + options_.delay_s, force_n}); }
  void run_until(double time_s);
  /// From the centre.
  [[nodiscard]] Eigen::Vector3d travel() const noexcept;
  /// What acts now.
  [[nodiscard]] const Eigen::Vector3d& force() const noexcept { return force_n_; }

 private:
  struct Waiting {
    double at_s;
    Eigen::Vector3d force_n;
  };
  struct State {
    double travel_m = 0.0;
    double speed_m_s = 0.0;
  };
  void advance(double time_s);
  void move(State& state, double force_n, double span_s) const;

  Options options_;
  std::deque<Waiting> waiting_;
  Eigen::Vector3d force_n_ = Eigen::Vector3d::Zero();
  std::array<State, 3> states_{};
  double now_s_ = 0.0;
};

}  // namespace kerf::emulators
