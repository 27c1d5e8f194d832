#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/drivers/device_model.h>
#include <kerf/drivers/hand.h>
#include <kerf/drivers/uri.h>

namespace kerf::drivers {

/// `sim:axis`: a motor that drives a handle, whose truth is drawn or given, for whatever has to find it
/// again.
///
///     (m + m_h) x'' = k_u F(t) + g(x) + tissue - b x' - f_c sign(x') - B x' - K (x - x_h)
///
/// with its force F late by a delay of any length, quantised positions, limits, and a hand m_h, B, K. Between
/// events (a command arrives, the tissue or the hand is asked, somebody reads) forces are constant and the
/// motion is exact: mechanisms::HeldMass. The tissue and a hand that moves are asked every 50 us. What no
/// model of mass and friction describes can be added: cogging, play, a flexible link; then everything is
/// asked every 10 us. Several axes do not act on each other.
///
/// The force sensor stands between device and hand: it reads what hand and tissue exert together. All draws
/// follow the seed. drivers/README.md has the options.
class SimulatedDrive final : public Device {
 public:
  struct Axis {
    AxisModel model;           ///< its truth: values alone count
    double delay_ticks = 0.0;  ///< in addition to the model's delay, in times between two readings
    HandImpedance hand;
    double sway_m = 0.0;
    double tremor_n = 0.0;
    double backlash_m = 0.0;
    double cogging_n = 0.0;
    double cogging_period_m = 2e-3;
    double flexible_n_per_m = 0.0;  ///< 0: rigid
    double flexible_n_s_per_m = 1.0;
    double flexible_share = 0.5;  ///< of the mass that is behind the link
  };
  struct Options {
    std::vector<Axis> axes;
    std::uint64_t seed = 1;
    bool with_hand = true;
    bool with_noise = true;
    bool with_encoder = true;
    bool with_truth = false;
    bool with_sensor = true;
    bool with_motor = true;
    bool tells_mechanics = true;
    double motor_sign = 1.0;
    double sensor_sign = 1.0;
    double sensor_noise_n = 0.02;
    double encoder_noise = 0.0;  ///< before the encoder, in the unit of position
    std::optional<std::string> serial;
    std::string model_file;
  };

  SimulatedDrive(std::string_view uri, const Options& options, Surroundings surroundings);
  ~SimulatedDrive() override;

  /// @throws DeviceError for an option that is unknown or out of range, and for a model that does not know
  /// what has to be known.
  static Options parse_options(Uri uri);

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] Status read(double now_s, Sample& sample) noexcept override;
  [[nodiscard]] Status write(const Axes& force) noexcept override;
  void release(double at_s) noexcept override;

 private:
  class World;

  DeviceInfo info_;
  std::unique_ptr<World> world_;
};

}  // namespace kerf::drivers
