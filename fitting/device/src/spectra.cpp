#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <boost/math/distributions/students_t.hpp>

#include <kerf/identification/spectra.h>

#include "jackknife.h"

namespace kerf::identification {
namespace {

using Complex = std::complex<double>;

constexpr double turn_rad = 2.0 * std::numbers::pi;

/// At given lines, by Goertzel's recurrence in its plain form: dozens of lines of a thousand values.
std::vector<Complex> at_lines(std::span<const double> values, std::span<const std::size_t> lines) {
  const std::size_t length = values.size();
  std::vector<Complex> roots(length);
  for (std::size_t n = 0; n < length; ++n) {
    roots[n] = std::polar(1.0, -turn_rad * static_cast<double>(n) / static_cast<double>(length));
  }
  std::vector<Complex> out;
  out.reserve(lines.size());
  for (const std::size_t line : lines) {
    Complex sum = 0.0;
    std::size_t turn = 0;
    for (std::size_t n = 0; n < length; ++n) {
      sum += values[n] * roots[turn];
      turn = (turn + line) % length;
    }
    out.push_back(sum);
  }
  return out;
}

/// Without the straight line from a period's begin to the begin of the next.
std::vector<double> without_trend(std::span<const double> values, std::size_t begin, std::size_t period) {
  const double slope = begin + period < values.size()
                           ? (values[begin + period] - values[begin]) / static_cast<double>(period)
                           : 0.0;
  std::vector<double> out(period);
  for (std::size_t n = 0; n < period; ++n) out[n] = values[begin + n] - slope * static_cast<double>(n);
  return out;
}

std::vector<double> part_of(std::span<const double> values, std::size_t begin, std::size_t period) {
  const auto part = values.subspan(begin, period);
  return {part.begin(), part.end()};
}

/// What the model makes of a force that is held for a part of a tick, by its line.
struct Held {
  Complex before;         ///< of a force during the first part of a tick
  Complex after;          ///< during the rest
  Complex whole;          ///< during all of it
  Complex late;           ///< of a force's moment about the middle of a tick
  Complex from_position;  ///< of (s_0 - s_N) in the position
  Complex from_speed;
};
Held held_at(const AxisModel& model, double period_s, double turn) {
  const AxisSimulation simulation(model, period_s);
  const Transition tick = transition_over(model, period_s);
  const Transition& before = simulation.before_change();
  const Transition& after = simulation.after_change();
  const Complex z = std::polar(1.0, turn);
  // C (zI - A)^-1 of a 2 x 2 matrix, C = (1, 0).
  const Complex determinant = (z - tick.xx) * (z - tick.vv) - tick.xv * tick.vx;
  const Complex of_position = (z - tick.vv) / determinant;
  const Complex of_speed = tick.xv / determinant;
  const auto through = [&](double x, double v) { return of_position * x + of_speed * v; };
  return {.before = through(after.xx * before.xf + after.xv * before.vf,
                            after.vx * before.xf + after.vv * before.vf),
          .after = through(after.xf, after.vf),
          .whole = through(tick.xf, tick.vf),
          .late = through(-period_s / model.mass_kg, 0.0),
          .from_position = of_position * z,
          .from_speed = of_speed * z};
}

/// Means over the periods of a stretch, at the lines.
struct Averaged {
  std::vector<Complex> position;
  std::vector<Complex> friction;                          ///< for f = 1 N
  std::vector<Complex> late_friction;                     ///< its moments
  std::map<std::size_t, std::vector<Complex>> commanded;  ///< by how many ticks ago
};

class FrequencyProblem {
 public:
  FrequencyProblem(const AxisData& data, std::span<const Stretch> stretches,
                   std::span<const std::size_t> lines, const OutputErrorFit& time, const FitOptions& options)
      : data_(data), stretches_(stretches), lines_(lines.begin(), lines.end()) {
    for (const Parameter parameter : all_parameters) {
      const bool is_fixed = (parameter == Parameter::coulomb && !options.fit_friction) ||
                            (parameter == Parameter::stiffness && !options.fit_stiffness) ||
                            parameter == Parameter::saturation;
      if (!is_fixed) free_.push_back(parameter);
    }
    const double f = time.model.axis.coulomb_n;
    for (const Stretch& stretch : stretches) {
      Averaged averaged;
      const std::size_t from = stretch.periods > 1 ? 1 : 0;
      const std::size_t count = stretch.periods - from;
      averaged.position = mean_of(data.position_m, stretch, from, count, 0);
      const auto pattern_of = [&](double TickFriction::*what) {
        std::vector<double> pattern(time.friction.size(), 0.0);
        for (std::size_t n = 0; n < pattern.size(); ++n) {
          if (f > 0.0 && std::isfinite(time.friction[n].*what)) pattern[n] = time.friction[n].*what / f;
        }
        return mean_of(pattern, stretch, from, count, 0);
      };
      averaged.friction = pattern_of(&TickFriction::mean_n);
      averaged.late_friction = pattern_of(&TickFriction::moment_n_s);
      averaged_.push_back(std::move(averaged));
    }
  }

  [[nodiscard]] const std::vector<Parameter>& free() const noexcept { return free_; }
  [[nodiscard]] Eigen::Index rows_of_a_stretch() const noexcept {
    return static_cast<Eigen::Index>(2 * lines_.size());
  }

  /// Of a stretch: the residuals, real and imaginary parts one after the other, without what the state at the
  /// ends explains.
  Eigen::VectorXd model_of(const AxisModel& model, std::size_t stretch) {
    const auto ticks = static_cast<std::size_t>(model.delay_s / data_.period_s);
    const auto& older = commanded(stretch, ticks + 1);
    const auto& newer = commanded(stretch, ticks);
    Eigen::VectorXd out(rows_of_a_stretch());
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const Held held = held_at(model, data_.period_s, turn(stretch, i));
      const Complex value = held.before * older[i] + held.after * newer[i] +
                            model.coulomb_n * (held.whole * averaged_[stretch].friction[i] +
                                               held.late * averaged_[stretch].late_friction[i]);
      out[static_cast<Eigen::Index>(2 * i)] = value.real();
      out[static_cast<Eigen::Index>(2 * i + 1)] = value.imag();
    }
    return out;
  }
  Eigen::VectorXd read(std::size_t stretch) const {
    Eigen::VectorXd out(rows_of_a_stretch());
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      out[static_cast<Eigen::Index>(2 * i)] = averaged_[stretch].position[i].real();
      out[static_cast<Eigen::Index>(2 * i + 1)] = averaged_[stretch].position[i].imag();
    }
    return out;
  }
  /// Two columns: of the state's change over the period.
  Eigen::MatrixXd own_of(const AxisModel& model, std::size_t stretch) const {
    Eigen::MatrixXd out(rows_of_a_stretch(), 2);
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const Held held = held_at(model, data_.period_s, turn(stretch, i));
      const auto row = static_cast<Eigen::Index>(2 * i);
      out.row(row) << held.from_position.real(), held.from_speed.real();
      out.row(row + 1) << held.from_position.imag(), held.from_speed.imag();
    }
    for (Eigen::Index column = 0; column < 2; ++column) out.col(column).normalize();
    out.col(1) -= out.col(0) * out.col(0).dot(out.col(1));
    out.col(1).normalize();
    return out;
  }
  /// What a force does at once, a millimetre a newton: the command, delayed.
  Eigen::VectorXd compliance_of(const AxisModel& model, std::size_t stretch) {
    const auto ticks = static_cast<std::size_t>(model.delay_s / data_.period_s);
    Eigen::VectorXd out(rows_of_a_stretch());
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      // What begins to act as a tick is read is not read there yet, so it is one more also for a delay of
      // whole ticks.
      const Complex force = commanded(stretch, ticks + 1)[i];
      out[static_cast<Eigen::Index>(2 * i)] = force.real();
      out[static_cast<Eigen::Index>(2 * i + 1)] = force.imag();
    }
    return out;
  }

 private:
  [[nodiscard]] double turn(std::size_t stretch, std::size_t i) const noexcept {
    return turn_rad * static_cast<double>(lines_[i]) / static_cast<double>(stretches_[stretch].period);
  }
  const std::vector<Complex>& commanded(std::size_t stretch, std::size_t back) {
    auto& kept = averaged_[stretch].commanded;
    if (const auto found = kept.find(back); found != kept.end()) return found->second;
    const Stretch& of = stretches_[stretch];
    const std::size_t from = of.periods > 1 ? 1 : 0;
    return kept.emplace(back, mean_of(data_.commanded_n, of, from, of.periods - from, back)).first->second;
  }
  std::vector<Complex> mean_of(std::span<const double> values, const Stretch& stretch, std::size_t from,
                               std::size_t count, std::size_t back) const {
    std::vector<double> mean(stretch.period, 0.0);
    for (std::size_t period = from; period < from + count; ++period) {
      for (std::size_t n = 0; n < stretch.period; ++n) {
        const std::size_t at = stretch.begin + period * stretch.period + n;
        mean[n] += (at >= back ? values[at - back] : 0.0) / static_cast<double>(count);
      }
    }
    return at_lines(mean, lines_);
  }

  const AxisData& data_;
  std::span<const Stretch> stretches_;
  std::vector<std::size_t> lines_;
  std::vector<Parameter> free_;
  std::vector<Averaged> averaged_;
};

Eigen::VectorXd projected(const Eigen::VectorXd& column, const Eigen::MatrixXd& orthonormal) {
  return column - orthonormal * (orthonormal.transpose() * column);
}

double step_of(const AxisModel& model, Parameter parameter, double period_s) {
  switch (parameter) {
    case Parameter::mass:
      return 1e-6 * model.mass_kg;
    case Parameter::viscous:
      return 1e-5 * std::max(std::abs(model.viscous_n_s_per_m), model.mass_kg);
    case Parameter::coulomb:
      return 1e-5 * std::max(model.coulomb_n, 0.01);
    case Parameter::stiffness:
      return 1e-5 * std::max(std::abs(model.stiffness_n_per_m), 10.0 * model.mass_kg);
    case Parameter::saturation:
    case Parameter::delay:
      break;
  }
  return 1e-5 * period_s;
}

}  // namespace

std::vector<Complex> coefficients(std::span<const double> values, std::size_t count) {
  std::vector<std::size_t> lines(count);
  for (std::size_t line = 0; line < count; ++line) lines[line] = line;
  return at_lines(values, lines);
}

Coherence coherence_of(Complex cross, double one, double other, std::size_t independent) {
  if (!(one > 0.0 && other > 0.0)) return {};
  const double squared = std::min(1.0, std::norm(cross) / (one * other));
  const double artanh = std::atanh(std::min(std::sqrt(squared), 1.0 - 1e-15));
  const double half = 1.96 / std::sqrt(2.0 * static_cast<double>(independent));
  return {.value = squared,
          .lower = std::pow(std::max(0.0, std::tanh(artanh - half)), 2),
          .upper = std::pow(std::tanh(artanh + half), 2)};
}

std::vector<ResponseLine> frequency_response(const AxisData& data, std::span<const double> excitation_n,
                                             std::span<const Stretch> stretches,
                                             std::span<const std::size_t> lines) {
  struct Sums {
    Complex xr, ur;
    double xx = 0.0, rr = 0.0;
  };
  std::vector<Sums> sums(lines.size());
  std::size_t independent = 0;
  std::size_t length = 0;
  for (const Stretch& stretch : stretches) {
    length = stretch.period;
    ++independent;
    for (std::size_t period = stretch.periods > 1 ? 1 : 0; period < stretch.periods; ++period) {
      const std::size_t begin = stretch.begin + period * length;
      const auto x = at_lines(without_trend(data.position_m, begin, length), lines);
      const auto u = at_lines(without_trend(data.commanded_n, begin, length), lines);
      const auto r = at_lines(part_of(excitation_n, begin, length), lines);
      for (std::size_t i = 0; i < lines.size(); ++i) {
        sums[i].xr += x[i] * std::conj(r[i]);
        sums[i].ur += u[i] * std::conj(r[i]);
        sums[i].xx += std::norm(x[i]);
        sums[i].rr += std::norm(r[i]);
      }
    }
  }
  std::vector<ResponseLine> out;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!(sums[i].rr > 0.0 && sums[i].xx > 0.0)) continue;
    ResponseLine line;
    line.frequency_hz = static_cast<double>(lines[i]) / (static_cast<double>(length) * data.period_s);
    line.response = sums[i].xr / sums[i].ur;
    line.coherence = coherence_of(sums[i].xr, sums[i].xx, sums[i].rr, independent);
    line.relative_error = std::sqrt(
        std::max(0.0, (1.0 / line.coherence.value - 1.0) / (2.0 * static_cast<double>(independent))));
    out.push_back(line);
  }
  return out;
}

double FrequencyFit::half_width(std::size_t parameter) const {
  const auto i = static_cast<Eigen::Index>(parameter);
  const boost::math::students_t t(degrees_of_freedom);
  return boost::math::quantile(boost::math::complement(t, 0.025)) *
         std::sqrt(std::max(0.0, covariance(i, i)));
}

FrequencyFit fit_frequencies(const AxisData& data, std::span<const Stretch> stretches,
                             std::span<const std::size_t> lines, const OutputErrorFit& time,
                             const FitOptions& options) {
  FrequencyProblem problem(data, stretches, lines, time, options);
  FrequencyFit fit;
  fit.model = time.model;
  AxisModel& model = fit.model.axis;
  const auto& free = problem.free();
  const auto p = static_cast<Eigen::Index>(free.size());
  const Eigen::Index rows = problem.rows_of_a_stretch();
  const auto all_rows = rows * static_cast<Eigen::Index>(stretches.size());
  Eigen::MatrixXd columns(all_rows, p);
  Eigen::VectorXd residual(all_rows);
  Eigen::VectorXd compliance(all_rows);
  const auto linearise = [&] {
    for (std::size_t s = 0; s < stretches.size(); ++s) {
      const Eigen::Index at = rows * static_cast<Eigen::Index>(s);
      const Eigen::VectorXd here = problem.model_of(model, s);
      const Eigen::MatrixXd own = problem.own_of(model, s);
      residual.segment(at, rows) = projected(problem.read(s) - here, own);
      compliance.segment(at, rows) = projected(problem.compliance_of(model, s), own);
      for (Eigen::Index i = 0; i < p; ++i) {
        AxisModel changed = model;
        const Parameter parameter = free[static_cast<std::size_t>(i)];
        const double step = step_of(model, parameter, data.period_s);
        value_of(changed, parameter) += step;
        columns.col(i).segment(at, rows) = projected((problem.model_of(changed, s) - here) / step, own);
      }
    }
  };
  Eigen::MatrixXd inverse;
  for (int iteration = 0; iteration < 8; ++iteration) {
    linearise();
    const Eigen::VectorXd scale = columns.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
    const Eigen::MatrixXd scaled = columns * scale.asDiagonal();
    inverse = scale.asDiagonal() *
              Eigen::MatrixXd((scaled.transpose() * scaled).ldlt().solve(Eigen::MatrixXd::Identity(p, p))) *
              scale.asDiagonal();
    if (iteration == 7) break;
    const Eigen::VectorXd step = inverse * (columns.transpose() * residual);
    for (Eigen::Index i = 0; i < p; ++i) {
      const Parameter parameter = free[static_cast<std::size_t>(i)];
      double& value = value_of(model, parameter);
      const double before = value;
      value += step[i];
      if (parameter == Parameter::mass) value = std::clamp(value, 0.5 * before, 2.0 * before);
      if (parameter == Parameter::coulomb || parameter == Parameter::delay) value = std::max(0.0, value);
    }
  }
  // Errors of a stretch's lines know each other: friction's pattern is one, and noise goes through one axis.
  const auto of_stretch = [&](const auto& of, std::size_t s) {
    return of.middleRows(rows * static_cast<Eigen::Index>(s), rows);
  };
  std::map<std::size_t, Cluster> by_stretch;
  for (std::size_t s = 0; s < stretches.size(); ++s) {
    by_stretch.emplace(s, Cluster(of_stretch(columns, s), of_stretch(residual, s)));
  }
  const auto clusters = static_cast<double>(stretches.size());
  fit.degrees_of_freedom = std::max(1.0, clusters - 1.0);
  const Eigen::MatrixXd own = jackknife(inverse, by_stretch);
  fit.covariance = Eigen::MatrixXd::Zero(shared_parameters, shared_parameters);
  for (Eigen::Index i = 0; i < p; ++i) {
    for (Eigen::Index j = 0; j < p; ++j) {
      fit.covariance(static_cast<Eigen::Index>(free[static_cast<std::size_t>(i)]),
                     static_cast<Eigen::Index>(free[static_cast<std::size_t>(j)])) = own(i, j);
    }
  }
  // One stretch says nothing of the spread, and a fit that still moves is at no answer.
  bool is_told = stretches.size() > 1 && own.allFinite();
  const Eigen::VectorXd next_step = inverse * (columns.transpose() * residual);
  for (Eigen::Index i = 0; i < p && is_told; ++i) {
    const Parameter parameter = free[static_cast<std::size_t>(i)];
    const bool may_be_bounded = parameter == Parameter::coulomb || parameter == Parameter::delay;
    if (may_be_bounded && value_of(model, parameter) == 0.0) continue;
    is_told = std::abs(next_step[i]) <= std::sqrt(std::max(0.0, own(i, i)));
  }
  for (const Parameter parameter : free) {
    const bool is_seen = parameter != Parameter::coulomb || time.model.axis.coulomb_n > 0.0;
    if (!is_told || !is_seen) value_of(model, parameter) = std::numeric_limits<double>::quiet_NaN();
  }
  const Eigen::VectorXd beyond = compliance - columns * (inverse * (columns.transpose() * compliance));
  const double squares = beyond.squaredNorm();
  fit.compliance_m_per_n = beyond.dot(residual) / squares;
  double errors = 0.0;
  for (std::size_t s = 0; s < stretches.size(); ++s) {
    const Eigen::VectorXd here = of_stretch(beyond, s);
    const double gradient =
        here.dot(Eigen::VectorXd(of_stretch(residual, s)) - fit.compliance_m_per_n * here) /
        std::max(1e-3, 1.0 - here.squaredNorm() / squares);
    errors += gradient * gradient;
  }
  fit.compliance_error_m_per_n = std::sqrt(errors * (clusters - 1.0) / clusters) / squares;
  return fit;
}

}  // namespace kerf::identification
