#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/identification/spectra.h>

#include "loop/command.h"
#include "stability/controllers/wall_controller.h"

namespace kerf::bench {

/// How the transparency of a wall is measured.
struct TransparencyOptions {
  double lowest_hz = 1.0;
  double highest_hz = 30.0;
  double period_s = 4.0;  ///< of the excitation, and of a record
  std::size_t records = 4;
  double settle_s = 1.0;        ///< of the wall alone, and of the excitation before each record
  double push_n = 0.0;          ///< peak of the excitation; 0: designed (designed_push())
  double least_push_n = 1.0;    ///< of one that is designed
  double stop_n = 0.0;          ///< a force beyond it ends everything; 0: 0.8 of the axis' limit
  bool sensor_at_hand = false;  ///< the device's force sensor reads what the hand exerts on it
};

/// A peak of the excitation that is as small as tells something: `least_n`, four times the Coulomb friction,
/// or 20 encoder steps of the wall, whichever is most; half of the stop at most.
[[nodiscard]] double designed_push(const SampledDevice& device, const Wall& wall, double least_n,
                                   double stop_n);

/// What was read in one period of the excitation: a value a tick.
struct TransparencyRecord {
  std::vector<double> position_m, wall_n, excitation_n, sensor_n;
};

/// A wall with an excitation on it, as what a loop renders: the wall stands where the axis is, a multisine
/// is added to its force, and each of the records has the wall at another place within an encoder step. A
/// record in which a tick was missed is made anew, ten times at most. Allocates nothing but at its
/// construction.
class TransparencyTrial {
 public:
  /// @throws std::invalid_argument for a band without lines, a period that is no whole number of ticks.
  TransparencyTrial(const drivers::AxisInfo& axis, std::size_t number, double period_s,
                    const ControllerDesign& design, const Wall& wall, const TransparencyOptions& options);

  [[nodiscard]] Command step(const drivers::Sample& sample, double elapsed_s) noexcept;
  [[nodiscard]] bool finished() const noexcept { return finished_; }
  /// It was ended by its stop, or by ticks that were missed.
  [[nodiscard]] bool failed() const noexcept { return failed_; }
  [[nodiscard]] std::uint64_t max_ticks() const noexcept;
  [[nodiscard]] double push_n() const noexcept { return push_n_; }
  /// The whole ones.
  [[nodiscard]] std::vector<TransparencyRecord> records() const;
  /// Lines of a record that are excited, in periods of the excitation.
  [[nodiscard]] const std::vector<std::size_t>& lines() const noexcept { return lines_; }

 private:
  void end(bool failed) noexcept {
    finished_ = true;
    failed_ = failed;
  }

  std::size_t axis_;
  double lever_;
  double encoder_step_m_;
  double period_s_;
  double stop_n_;
  double push_n_;
  std::size_t settle_ticks_;
  ControlledWall wall_;
  std::vector<double> excitation_n_;
  std::vector<std::size_t> lines_;
  std::vector<TransparencyRecord> records_;
  std::size_t record_ = 0;
  std::size_t tick_ = 0;
  std::size_t disturbed_ = 0;
  double origin_m_ = 0.0;
  bool started_ = false;
  bool is_disturbed_ = false;
  bool finished_ = false;
  bool failed_ = false;
};

/// What a wall is like at one frequency, against the commanded K / (j w) + B.
struct RenderedLine {
  double frequency_hz = 0.0;
  std::complex<double> commanded;  ///< [N·s/m]
  std::complex<double> loop;       ///< what the controller gives
  std::complex<double> felt;       ///< what the hand feels: with the device's own m j w + b
  /// The smaller one of excitation and force, excitation and position.
  identification::Coherence coherence;
};

/// Over the lines whose coherence is 0.8 or more; unknown where there are none.
struct TransparencyError {
  std::size_t lines = 0;
  double loop_share = 0.0;  ///< rms of |Z / Z_commanded - 1|
  double loop_db = 0.0;     ///< rms of 20 log10 |Z / Z_commanded|
  double felt_share = 0.0;  ///< likewise of what the hand feels
  double felt_db = 0.0;
};

struct Transparency {
  Wall wall;
  double push_n = 0.0;
  std::size_t records = 0;
  bool felt_by_sensor = false;
  bool finished = false;
  std::vector<RenderedLine> lines;
  TransparencyError error;
};

/// The impedance that was rendered, from what was read:
///
///     Z_loop = -S_ur / S_xr  hold(w) / (j w),   u the wall's commands, x the position, r the excitation
///
/// with hold_and_delay() of the model. As u follows from x this asks neither for the hand nor for a sensor;
/// r as the instrument keeps what encoder and friction add out of it, as in
/// identification::frequency_response(). What the hand feels is Z_loop + m j w + b, of the model, without
/// Coulomb friction; or, where a sensor reads what the hand exerts, f,
///
///     Z_felt = (S_fr + hold(w) S_rr) / (j w S_xr)
///
/// for the excitation pushes as a hand would. A sensor that is read at the tick sees the steps of the held
/// force, which this leaves in: an error that grows with the square of the frequency. The interval of the
/// coherence counts the records.
[[nodiscard]] Transparency transparency_of(const TransparencyTrial& trial, const Wall& wall,
                                           const SampledDevice& model, const TransparencyOptions& options);

}  // namespace kerf::bench
