#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include <boost/math/distributions/students_t.hpp>
#include <fmt/format.h>

#include <kerf/identification/identify.h>

namespace kerf::identification {
namespace {

constexpr std::size_t short_parts = 20;
constexpr double worth_a_word = 0.01;      // of a value
constexpr double least_share = 0.3;        // of what is missed, to name what explains it
constexpr double most_by_chance = 0.5;     // of what is missed, that something explains
constexpr double much_noise = 2.0;         // in units of an encoder's rounding
constexpr double enough_of_a_limit = 0.7;  // of what no limit leaves

double student(double degrees) {
  const boost::math::students_t t(std::max(1.0, degrees));
  return boost::math::quantile(boost::math::complement(t, 0.025));
}

/// Standard errors that one in a thousand lies beyond.
double clearly(double degrees) {
  const boost::math::students_t t(std::max(1.0, degrees));
  return boost::math::quantile(boost::math::complement(t, 0.0005));
}

std::vector<Stretch> of_kind(const Experiment& experiment, bool validates) {
  std::vector<Stretch> out;
  for (const Stretch& stretch : experiment.stretches) {
    if (stretch.validates == validates) out.push_back(stretch);
  }
  return out;
}

/// Mean over independent parts with its interval.
std::optional<Value> mean_of(const std::vector<double>& parts) {
  if (parts.size() < 2) return std::nullopt;
  const auto n = static_cast<double>(parts.size());
  const double mean = std::accumulate(parts.begin(), parts.end(), 0.0) / n;
  double squares = 0.0;
  for (const double part : parts) squares += (part - mean) * (part - mean);
  const double half = student(n - 1.0) * std::sqrt(squares / (n - 1.0) / n);
  return Value{.value = mean, .lower = mean - half, .upper = mean + half};
}

/// The fit with shots of the length that tells more: long ones where little but the encoder disturbs.
OutputErrorFit best_fit(const AxisData& data, std::span<const Stretch> training, const PlacedModel& start,
                        double noise_m, const FitOptions& options) {
  OutputErrorFit fit = fit_output_error(data, make_shots(data, training, parts_of_a_period), start, options);
  if (fit.rms_m < 1.5 * noise_m) return fit;
  OutputErrorFit shorter =
      fit_output_error(data, make_shots(data, training, short_parts), fit.model, options);
  const auto size = [](const OutputErrorFit& of) {
    double sum = 0.0;
    for (const Parameter parameter :
         {Parameter::mass, Parameter::viscous, Parameter::coulomb, Parameter::delay}) {
      const auto i = static_cast<std::size_t>(parameter);
      sum += std::log(std::max(1e-15, of.standard_error(i)));
    }
    return sum;
  };
  return size(shorter) < size(fit) ? shorter : fit;
}

struct Repeated {
  double repeated = 0.0;  ///< mean square
  double between = 0.0;   ///< mean variance between periods
  double periods = 0.0;
};

/// What residuals of a stretch's periods have in common, over the ticks that all of them have.
Repeated repeated_of(const OutputErrorFit& fit, std::span<const Stretch> stretches) {
  Repeated out;
  double ticks = 0.0;
  for (const Stretch& stretch : stretches) {
    if (stretch.periods < 2) continue;
    const auto count = static_cast<double>(stretch.periods);
    for (std::size_t n = 0; n < stretch.period; ++n) {
      double mean = 0.0;
      for (std::size_t p = 0; p < stretch.periods; ++p) {
        mean += fit.residual_m[stretch.begin + p * stretch.period + n] / count;
      }
      if (!std::isfinite(mean)) continue;
      double squares = 0.0;
      for (std::size_t p = 0; p < stretch.periods; ++p) {
        squares += std::pow(fit.residual_m[stretch.begin + p * stretch.period + n] - mean, 2);
      }
      out.repeated += mean * mean;
      out.between += squares / (count - 1.0);
      ticks += 1.0;
      out.periods = count;
    }
  }
  if (ticks > 0.0) {
    out.repeated /= ticks;
    out.between /= ticks;
  }
  return out;
}

double lag_1_of(const std::vector<double>& residuals) {
  double products = 0.0;
  double squares = 0.0;
  for (std::size_t n = 1; n < residuals.size(); ++n) {
    if (!std::isfinite(residuals[n]) || !std::isfinite(residuals[n - 1])) continue;
    products += residuals[n] * residuals[n - 1];
    squares += residuals[n] * residuals[n];
  }
  return squares > 0.0 ? products / squares : 0.0;
}

double rms_of_motion(const AxisData& data, std::span<const Stretch> stretches) {
  double squares = 0.0;
  double count = 0.0;
  for (const Stretch& stretch : stretches) {
    double mean = 0.0;
    double known = 0.0;
    for (std::size_t n = stretch.begin; n < stretch.end(); ++n) {
      if (!std::isfinite(data.position_m[n])) continue;
      mean += data.position_m[n];
      known += 1.0;
    }
    mean /= std::max(1.0, known);
    for (std::size_t n = stretch.begin; n < stretch.end(); ++n) {
      if (std::isfinite(data.position_m[n])) squares += std::pow(data.position_m[n] - mean, 2);
    }
    count += known;
  }
  return std::sqrt(squares / std::max(1.0, count));
}

/// rms of speeds that were told, less a filter of first order of the model's; NaN: the model has none there.
double speed_rms(const Experiment& experiment, const OutputErrorFit& fit, const Stretch& stretch,
                 double corner_rad_s) {
  const double period_s = experiment.data.period_s;
  const double gain = corner_rad_s > 0.0 ? -std::expm1(-corner_rad_s * period_s) : 1.0;
  const std::size_t settles = std::min<std::size_t>(stretch.period / 2, 200);
  double speed = 0.0;
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t n = stretch.begin + 1; n < stretch.end(); ++n) {
    const double step = fit.simulated_m[n] - fit.simulated_m[n - 1];
    if (std::isfinite(step)) speed += gain * (step / period_s - speed);
    if (n < stretch.begin + settles || !std::isfinite(step)) continue;
    squares += std::pow(experiment.speed_m_s[n] - speed, 2);
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(squares / count) : std::numeric_limits<double>::quiet_NaN();
}

/// The filter of the driver's velocity, and what of it neither filter nor model explains.
void judge_speed(const Experiment& experiment, std::span<const Stretch> training, Identified& out) {
  if (experiment.speed_m_s.size() != experiment.data.position_m.size()) return;
  std::vector<double> corners;
  std::vector<double> noises;
  const double fastest = std::numbers::pi / experiment.data.period_s;
  for (const Stretch& stretch : training) {
    // A corner between 1 rad/s and half of the rate, by thirds of what is left of its logarithm.
    double low = 0.0;
    double high = std::log(fastest);
    for (int i = 0; i < 40; ++i) {
      const double a = low + (high - low) / 3.0;
      const double b = high - (high - low) / 3.0;
      const bool left = speed_rms(experiment, out.time, stretch, std::exp(a)) <
                        speed_rms(experiment, out.time, stretch, std::exp(b));
      (left ? high : low) = left ? b : a;
    }
    const double corner = std::exp(0.5 * (low + high));
    const double noise = speed_rms(experiment, out.time, stretch, corner);
    if (!std::isfinite(noise)) continue;  // too short to settle in
    corners.push_back(corner);
    noises.push_back(noise);
  }
  if (corners.empty()) return;
  out.velocity_corner_rad_s = mean_of(corners);
  out.velocity_noise_m_s = mean_of(noises);
  if (out.velocity_corner_rad_s && out.velocity_corner_rad_s->value > 0.9 * fastest) {
    out.velocity_corner_rad_s.reset();  // no filter shows
  }
}

Value interval(double value, double half) {
  return {.value = value, .lower = value - half, .upper = value + half};
}

void take_numbers(Identified& out) {
  const auto of = [&](Parameter parameter, bool may_be_negative) {
    const double value = value_of(out.time.model.axis, parameter);
    Value told = interval(value, out.time.half_width(static_cast<std::size_t>(parameter)));
    if (!may_be_negative) told.lower = std::max(0.0, told.lower);
    return told;
  };
  out.mass_kg = of(Parameter::mass, false);
  out.viscous_n_s_per_m = of(Parameter::viscous, true);
  out.coulomb_n = of(Parameter::coulomb, false);
  out.stiffness_n_per_m = of(Parameter::stiffness, true);
  out.delay_s = of(Parameter::delay, false);
  out.offset_n.clear();
  for (std::size_t place = 0; place < out.time.model.offset_n.size(); ++place) {
    out.offset_n.push_back(
        interval(out.time.model.offset_n[place], out.time.half_width(shared_parameters + place)));
  }
}

void compare_domains(Identified& out) {
  out.agreements.clear();
  const std::array names{"mass", "viscous", "coulomb", "stiffness", "delay"};
  for (const Parameter parameter : all_parameters) {
    const auto i = static_cast<std::size_t>(parameter);
    if (parameter == Parameter::saturation) continue;
    const double time = value_of(out.time.model.axis, parameter);
    const double frequency = value_of(out.frequency.model.axis, parameter);
    if (!std::isfinite(frequency)) continue;  // nothing was found there, and nothing disagrees
    const double of_frequency = std::sqrt(
        std::max(0.0, out.frequency.covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i))));
    const double error = std::hypot(out.time.standard_error(i), of_frequency);
    const double by_chance = std::hypot(clearly(out.time.degrees_of_freedom) * out.time.standard_error(i),
                                        clearly(out.frequency.degrees_of_freedom) * of_frequency);
    const bool agrees = std::abs(frequency - time) <= by_chance ||
                        std::abs(frequency - time) <= worth_a_word * std::abs(time);
    out.agreements.push_back(
        {.name = names[i], .difference = frequency - time, .standard_error = error, .agrees = agrees});
  }
}

/// A command beyond which nothing more acts, searched where the model misses something: begun at the limit of
/// a few that leaves least, if that is clearly less than what no limit leaves, and estimated with all others.
void look_for_saturation(const Experiment& experiment, std::span<const Stretch> training,
                         const FitOptions& options, Identified& out) {
  // Two stretches are enough to find it; all tell the rest.
  const auto shots = make_shots(experiment.data, training.first(std::min<std::size_t>(2, training.size())),
                                parts_of_a_period);
  FitOptions few = options;
  few.iterations = 5;
  few.fit_saturation = false;
  const double without = fit_output_error(experiment.data, shots, out.time.model, options).rms_m;
  PlacedModel best;
  double least = enough_of_a_limit * without;
  for (const double share : {0.9, 0.75, 0.6, 0.45}) {
    PlacedModel start = out.time.model;
    start.axis.saturation_n = share * out.largest_force_n;
    const OutputErrorFit limited = fit_output_error(experiment.data, shots, start, few);
    if (limited.rms_m >= least) continue;
    least = limited.rms_m;
    best = limited.model;
  }
  if (!(best.axis.saturation_n > 0.0)) return;
  best = fit_output_error(experiment.data, shots, best, options).model;
  if (best.axis.saturation_n >= out.largest_force_n) return;
  out.time = fit_output_error(experiment.data, make_shots(experiment.data, training, parts_of_a_period), best,
                              options);
  out.saturation_n = interval(out.time.model.axis.saturation_n,
                              out.time.half_width(static_cast<std::size_t>(Parameter::saturation)));
}

bool has_blows(const Explanation& likeliest) {
  return likeliest.missing == Missing::backlash && likeliest.blows >= least_blows;
}

std::string in_words(const Explanation& likeliest) {
  if (has_blows(likeliest) && likeliest.share < least_share) {
    return fmt::format(
        "backlash behind the motor: between blows (kurtosis {:.1f}) it moves as if a part of its mass were "
        "gone",
        likeliest.blows);
  }
  if (likeliest.share < least_share)
    return "none of backlash, cogging and a flexible link explains a third of it";
  if (likeliest.missing == Missing::cogging) {
    return fmt::format("cogging of {:.2g} N each {:.2g} mm explains {:.0f} % of it", likeliest.size,
                       1e3 * likeliest.period_m, 100.0 * likeliest.share);
  }
  const bool is_play = likeliest.missing == Missing::backlash;
  return fmt::format("{} of {:.2g} {} explains {:.0f} % of it", name_of(likeliest.missing),
                     (is_play ? 1e3 : 1e6) * likeliest.size, is_play ? "mm" : "um/N",
                     100.0 * likeliest.share);
}

void judge_misfit(const Experiment& experiment, std::span<const Stretch> training, double step_m,
                  Identified& out) {
  const double noise_m = step_m / std::sqrt(12.0);
  // Short shots hide what grows slowly, so all are judged by shots of one length.
  const OutputErrorFit judged =
      predict(experiment.data, make_shots(experiment.data, training, parts_of_a_period), out.time.model);
  const Repeated repeated = repeated_of(judged, training);
  out.repeated_m = std::sqrt(repeated.repeated);
  out.by_chance_m = std::sqrt(repeated.between);
  out.fits.reset();
  out.why_not.clear();
  out.explanations.clear();
  out.missing.reset();
  if (repeated.periods < 2.0) return;
  const double allowed = 1.5 * repeated.between / repeated.periods + 4.0 * step_m * step_m / 12.0;
  out.fits = repeated.repeated <= allowed;
  // What sets a motion off otherwise each time, as friction with cogging does, does not repeat itself; but
  // what explains it does not fit by chance.
  const bool is_much = judged.rms_m > much_noise * std::max(noise_m, 1e-9);
  if (*out.fits && !is_much) return;
  out.explanations = explanations(experiment.data, training, out.time.model, experiment.held, step_m);
  const Explanation& first = out.explanations.front();
  if (*out.fits && first.share < most_by_chance) {
    out.explanations.clear();
    return;
  }
  if (*out.fits) {
    out.why_not.push_back(fmt::format("{:.3g} um of the motion are not in the model", 1e6 * judged.rms_m));
  } else {
    out.why_not.push_back(fmt::format(
        "{:.3g} um of the motion repeat themselves from period to period and are not in the model; {:.3g} um "
        "would be chance and encoder",
        1e6 * out.repeated_m, 1e6 * std::sqrt(allowed)));
  }
  out.fits = false;
  if (first.share >= least_share || has_blows(first)) out.missing = first.missing;
  out.why_not.push_back(in_words(first));
}

}  // namespace

std::optional<double> encoder_step(std::span<const double> positions) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t n = 1; n < positions.size(); ++n) {
    const double step = std::abs(positions[n] - positions[n - 1]);
    if (step > 1e-12) least = std::min(least, step);
  }
  if (!std::isfinite(least)) return std::nullopt;
  // Two readings two steps apart may hide one: the step is the greatest common divisor of all.
  double step = least;
  for (std::size_t n = 1; n < positions.size(); ++n) {
    double a = std::abs(positions[n] - positions[n - 1]);
    if (!std::isfinite(a)) continue;
    const double rest = std::abs(a - step * std::round(a / step));
    if (rest > 1e-3 * step) step = rest;
    if (step < 1e-3 * least) return std::nullopt;
  }
  std::size_t multiples = 0;
  std::size_t known = 0;
  double sum = 0.0;
  double steps = 0.0;
  for (std::size_t n = 1; n < positions.size(); ++n) {
    const double a = std::abs(positions[n] - positions[n - 1]);
    if (!std::isfinite(a)) continue;
    ++known;
    const double whole = std::round(a / step);
    if (std::abs(a - step * whole) < 0.01 * step) ++multiples;
    sum += a;
    steps += whole;
  }
  if (multiples < known || steps == 0.0) return std::nullopt;
  return sum / steps;
}

std::optional<Value> local_step(std::span<const double> positions) {
  constexpr std::size_t least_gaps = 20;
  constexpr double alike = 0.25;
  std::vector<double> readings;
  for (const double position : positions) {
    if (std::isfinite(position)) readings.push_back(position);
  }
  std::ranges::sort(readings);
  std::vector<double> gaps;
  for (std::size_t n = 1; n < readings.size(); ++n) {
    if (readings[n] - readings[n - 1] > 1e-12) gaps.push_back(readings[n] - readings[n - 1]);
  }
  if (gaps.size() < least_gaps) return std::nullopt;
  std::ranges::sort(gaps);
  const auto at = [&](double share) {
    return gaps[static_cast<std::size_t>(std::lround(share * static_cast<double>(gaps.size() - 1)))];
  };
  const Value step{.value = at(0.5), .lower = at(0.025), .upper = at(0.975)};
  if (step.lower < (1.0 - alike) * step.value || step.upper > (1.0 + alike) * step.value) return std::nullopt;
  return step;
}

namespace {

/// The readings of the stretches at a place, or at all of them; NaN between them, where they are not of the
/// same origin.
std::vector<double> readings_of(const Experiment& experiment, std::optional<std::size_t> place) {
  std::vector<double> readings(experiment.data.position_m.size(), std::numeric_limits<double>::quiet_NaN());
  for (const Stretch& stretch : experiment.stretches) {
    if (place && stretch.place != *place) continue;
    for (std::size_t n = stretch.begin; n < std::min(stretch.end(), readings.size()); ++n)
      readings[n] = experiment.data.position_m[n];
  }
  return readings;
}

}  // namespace

Identified identify(const Experiment& experiment) {
  const AxisData& data = experiment.data;
  const std::vector<Stretch> training = of_kind(experiment, false);
  const std::vector<Stretch> validation = of_kind(experiment, true);
  Identified out;
  out.encoder_step_m = encoder_step(readings_of(experiment, std::nullopt));
  if (!out.encoder_step_m) out.local_step_m = local_step(readings_of(experiment, 0));
  const double step_m = out.encoder_step_m.value_or(out.local_step_m ? out.local_step_m->value : 0.0);
  const double noise_m = step_m / std::sqrt(12.0);
  for (const double force : data.commanded_n)
    out.largest_force_n = std::max(out.largest_force_n, std::abs(force));
  const double moved = rms_of_motion(data, training);
  if (!(moved > 3.0 * std::max(step_m, 1e-9))) {
    throw std::invalid_argument(
        fmt::format("the axis moved by {:.2g} mm (rms) under {:.3g} N, which is too little beside an encoder "
                    "step of {:.2g} mm; "
                    "give more --max-force, at least what overcomes its friction",
                    1e3 * moved, out.largest_force_n, 1e3 * step_m));
  }
  const auto first = first_model(data, training, experiment.places);
  if (!first) {
    throw std::invalid_argument(fmt::format(
        "the axis did not move as a mass under {:.3g} N does; give more --max-force or --travel, and see "
        "`kerf devices --probe` for its sign",
        out.largest_force_n));
  }
  const FitOptions options;
  out.time = best_fit(data, training, *first, noise_m, options);
  judge_misfit(experiment, training, step_m, out);
  if (out.fits && !*out.fits) {
    look_for_saturation(experiment, training, options, out);
    if (out.saturation_n) judge_misfit(experiment, training, step_m, out);
  }
  take_numbers(out);
  out.residual_lag_1 = lag_1_of(out.time.residual_m);
  AxisData acting = data;
  if (out.saturation_n) {
    const double limit = out.time.model.axis.saturation_n;
    for (double& force : acting.commanded_n) force = std::clamp(force, -limit, limit);
  }
  out.frequency = fit_frequencies(acting, training, experiment.lines, out.time, options);
  out.compliance_m_per_n = out.frequency.compliance_m_per_n;
  out.compliance_half_width =
      student(out.frequency.degrees_of_freedom) * out.frequency.compliance_error_m_per_n;
  compare_domains(out);
  out.response = frequency_response(data, experiment.excitation_n, training, experiment.lines);
  AxisData modelled = data;
  for (std::size_t n = 0; n < modelled.position_m.size(); ++n) {
    if (std::isfinite(out.time.simulated_m[n])) modelled.position_m[n] = out.time.simulated_m[n];
  }
  out.response_of_model = frequency_response(modelled, experiment.excitation_n, training, experiment.lines);
  out.jitter_s = std::nullopt;
  // A mass that is not told from none says nothing of forces that come late.
  const auto jitter =
      out.mass_kg && out.mass_kg->lower > 0.0 ? delay_jitter(acting, training, out.time.model) : std::nullopt;
  if (jitter) {
    out.jitter_s = Value{.value = jitter->value_s, .lower = jitter->lower_s, .upper = jitter->upper_s};
  }
  judge_speed(experiment, training, out);
  if (!experiment.sensor_n.empty()) {
    if (const auto constant = motor_constant(data, experiment.sensor_n, training, out.time)) {
      out.motor_constant = interval(constant->value, constant->half_width);
    }
  }
  if (!validation.empty()) {
    const OutputErrorFit other = predict(data, make_shots(data, validation, 4), out.time.model);
    out.validation_rms_m = other.rms_m;
    out.validation_error = other.rms_m / rms_of_motion(data, validation);
    out.verdict = fmt::format("this model predicts the device to {:.2g} %", 100.0 * out.validation_error);
  }
  return out;
}

}  // namespace kerf::identification
