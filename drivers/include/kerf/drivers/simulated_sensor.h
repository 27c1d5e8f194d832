#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include <kerf/drivers/device.h>
#include <kerf/drivers/force_calibration.h>
#include <kerf/drivers/gaussian.h>
#include <kerf/drivers/uri.h>

namespace kerf::drivers {

/// `sim:sensor`: a six-axis force/torque transducer with amplified signals of ±10 V, whose truth is drawn by
/// its seed. It moves nothing and does not move, as `u6:N`:
///
///     u = q(P_r[A w] + creep + u_0 + d t + c (T - T_0) + noise),   T = T_0 + swing sin(2 pi t / period)
///     tau d creep/dt = share A w - creep
///
/// A [V/N, V/(N·m)] has 8 V at full scale on its diagonal and normal cross-talk beside it, P_r is the play
/// operator with half width r, q rounds to codes and ends at the range. The wrench w that acts on it is what
/// Surroundings::tissue_of_axes says, nothing without. Channels `signal_1` to `signal_6` [V], `temperature`
/// [degC]. Without a calibration `force_measured` is NaN.
class SimulatedSensor final : public Device {
 public:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  struct Options {
    std::uint64_t seed = 1;
    double force_n = 40.0;        ///< full scale of fx and fy; fz has three times as much
    double torque_n_m = 2.0;      ///< full scale of the torques
    double cross_talk = 0.03;     ///< deviation, in shares of full scale
    double bias_v = 0.1;          ///< deviation
    double hysteresis = 1e-3;     ///< r over 8 V; drawn from half to one and a half times that
    double creep = 0.0;           ///< share
    double creep_s = 20.0;        ///< tau
    double drift_v_per_s = 1e-6;  ///< deviation
    double per_kelvin_v = 5e-4;   ///< deviation
    double swing_k = 1.5;         ///< of the temperature
    double swing_period_s = 900.0;
    double noise_v = 1e-3;       ///< of one reading
    double quantum_v = 3.16e-4;  ///< 0: none
    double range_v = 10.0;
    std::uint64_t dead = 0;  ///< a signal that stands still, from 1; 0: none
    bool mirrored = false;   ///< of other sign: signals fall where loads grow
    std::string serial_number = "SIM1";
    std::optional<std::string> calibration_file{};
  };

  /// Its truth. @throws nothing
  struct Truth {
    Matrix6 sensitivity;  ///< A
    Vector6 bias;         ///< u_0
    Vector6 hysteresis;   ///< r
    Vector6 drift_per_s;  ///< d
    Vector6 per_kelvin;   ///< c
    double temperature;   ///< T_0
  };

  /// @throws DeviceError, std::invalid_argument as read_force_calibration().
  SimulatedSensor(std::string_view uri, const Options& options, Surroundings surroundings);

  /// Reads the options of a URI; it leaves `fault` to open_device(). @throws DeviceError for one that is
  /// unknown or out of range.
  static Options parse_options(Uri uri);

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] const Truth& truth() const noexcept { return truth_; }
  [[nodiscard]] const Options& options() const noexcept { return options_; }
  [[nodiscard]] Status read(double now_s, Sample& sample) noexcept override;
  /// It has no motors: any force is taken and none is exerted.
  [[nodiscard]] Status write(const Axes& force) noexcept override;
  void release(double) noexcept override {}

 private:
  void draw();

  Options options_;
  Truth truth_{};
  TissueOfAxes load_;
  std::optional<ForceCalibration> calibration_;
  DeviceInfo info_;
  Gaussian gaussian_;
  Vector6 follower_ = Vector6::Zero();
  Vector6 creep_ = Vector6::Zero();
  double last_s_ = 0.0;
};

}  // namespace kerf::drivers
