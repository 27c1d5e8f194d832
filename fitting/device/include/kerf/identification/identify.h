#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <kerf/identification/delay_jitter.h>
#include <kerf/identification/missing.h>
#include <kerf/identification/output_error.h>
#include <kerf/identification/shots.h>
#include <kerf/identification/spectra.h>
#include <kerf/identification/weak_form.h>

namespace kerf::identification {

/// A number and its interval of 95 %.
struct Value {
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
};

/// What an experiment on one axis was and read, in travel and force along it.
struct Experiment {
  AxisData data;
  std::vector<double> excitation_n;  ///< without what centred the axis
  std::vector<double> speed_m_s;     ///< as the driver told it
  std::vector<double> sensor_n;      ///< force of the hand on the device; empty without a sensor
  std::vector<Stretch> stretches;
  std::vector<std::size_t> lines;  ///< that were excited
  std::size_t places = 1;
  bool held = false;  ///< in a hand
};

/// A quantity that both domains tell.
struct Agreement {
  std::string name;
  double difference = 0.0;  ///< frequency domain minus time domain
  double standard_error = 0.0;
  bool agrees = true;
};

/// What is known of one axis.
struct Identified {
  std::optional<Value> mass_kg, viscous_n_s_per_m, coulomb_n, stiffness_n_per_m, delay_s;
  std::vector<Value> offset_n;  ///< by place
  std::optional<Value> jitter_s;
  std::optional<double> encoder_step_m;
  std::optional<Value> local_step_m;  ///< where there is none: local_step() of the readings
  std::optional<Value> velocity_noise_m_s;
  std::optional<Value> velocity_corner_rad_s;
  std::optional<Value> motor_constant;
  std::optional<Value> saturation_n;
  double largest_force_n = 0.0;     ///< that was commanded: a saturation beyond it does not show
  double compliance_m_per_n = 0.0;  ///< of the structure, and what it is at most
  double compliance_half_width = 0.0;

  OutputErrorFit time;
  FrequencyFit frequency;
  std::vector<Agreement> agreements;
  std::vector<ResponseLine> response;  ///< of the device
  std::vector<ResponseLine> response_of_model;
  std::vector<Explanation> explanations;  ///< where it does not fit
  std::optional<Missing> missing;         ///< the likeliest of them; nothing: none of them explains a third

  double repeated_m = 0.0;        ///< rms of what is missed in the same way in each period
  double by_chance_m = 0.0;       ///< rms of what is missed otherwise
  double residual_lag_1 = 0.0;    ///< autocorrelation of the residuals
  double validation_error = 0.0;  ///< rms of what is missed of other data, over the rms of the motion there
  double validation_rms_m = 0.0;
  std::optional<bool> fits;  ///< nothing: it cannot be told
  std::vector<std::string> why_not;
  std::string verdict;  ///< "this model predicts the device to 0.12 %"
};

/// Identifies an axis: a first model by modulating functions, the time domain, the frequency domain, what
/// both leave, and the validation.
///
/// It does not fit where what is missed repeats itself from period to period, more than chance and an encoder
/// would: rms of the residuals' mean over the periods, squared, above 1.5 s^2 / P + 4 q^2 / 12, with s their
/// spread between periods and q the encoder's step. Noise, tremor and jitter do not repeat themselves; play,
/// cogging and flexible links do. Nor does it where backlash, cogging or a flexible link explains half of
/// what is missed beyond the encoder: a motion that friction sets off otherwise each time does not repeat
/// itself.
/// @throws std::invalid_argument in one line where the data are too few, or the axis did not move: with what
/// would be needed.
[[nodiscard]] Identified identify(const Experiment& experiment);

/// The step of which all readings are multiples; nothing if there is none.
[[nodiscard]] std::optional<double> encoder_step(std::span<const double> positions);
/// The step of readings that are a smooth function of a counter, such as those of arms whose lever changes on
/// the way: the median of what lies between neighbouring readings, and the middle 95 % of it. Nothing where
/// these are not alike (within a quarter of the median), as of noise or of several counters at once, or where
/// fewer than 20 readings differ.
[[nodiscard]] std::optional<Value> local_step(std::span<const double> positions);

}  // namespace kerf::identification
