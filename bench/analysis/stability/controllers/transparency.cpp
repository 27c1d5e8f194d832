#include "stability/controllers/transparency.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include <kerf/identification/excitation.h>
#include <kerf/identification/spectra.h>

#include "stability/controllers/controlled_theory.h"

namespace kerf::bench {
namespace {

using Complex = std::complex<double>;

constexpr double stop_of_limit = 0.8;
constexpr double least_coherence = 0.8;
constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t most_made_anew = 10;

/// Sums of products of the coefficients at one line, over the records.
struct Spectra {
  Complex xr, ur, fr;
  double xx = 0.0, uu = 0.0, rr = 0.0;
};

TransparencyError transparency_error(const std::vector<RenderedLine>& lines) {
  TransparencyError error;
  const auto add = [](double& share, double& db, Complex rendered, Complex commanded) {
    share += std::norm(rendered / commanded - 1.0);
    db += std::pow(20.0 * std::log10(std::abs(rendered / commanded)), 2);
  };
  for (const RenderedLine& line : lines) {
    if (line.coherence.value < least_coherence) continue;
    ++error.lines;
    add(error.loop_share, error.loop_db, line.loop, line.commanded);
    add(error.felt_share, error.felt_db, line.felt, line.commanded);
  }
  for (double* const sum : {&error.loop_share, &error.loop_db, &error.felt_share, &error.felt_db})
    *sum = error.lines > 0 ? std::sqrt(*sum / static_cast<double>(error.lines)) : not_measured;
  return error;
}

}  // namespace

double designed_push(const SampledDevice& device, const Wall& wall, double least_n, double stop_n) {
  constexpr double times_friction = 4.0;
  constexpr double steps = 20.0;
  const double wanted_n = std::max(
      {least_n, times_friction * device.coulomb_n, steps * device.encoder_step_m * wall.stiffness_n_per_m});
  return std::min(wanted_n, 0.5 * stop_n);
}

TransparencyTrial::TransparencyTrial(const drivers::AxisInfo& axis, std::size_t number, double period_s,
                                     const ControllerDesign& design, const Wall& wall,
                                     const TransparencyOptions& options)
    : axis_(number),
      lever_(axis.lever),
      encoder_step_m_(axis.lever * axis.resolution),
      period_s_(period_s),
      stop_n_(options.stop_n > 0.0 ? options.stop_n : stop_of_limit * axis.force_limit),
      push_n_(options.push_n > 0.0 ? options.push_n
                                   : designed_push(design.device, wall, options.least_push_n, stop_n_)),
      settle_ticks_(static_cast<std::size_t>(std::lround(options.settle_s / period_s))),
      wall_(design) {
  const auto ticks = static_cast<std::size_t>(std::lround(options.period_s / period_s));
  if (ticks < settle_ticks_)
    throw std::invalid_argument("a record of the transparency is shorter than what it takes to settle");
  identification::Excitation excitation = identification::make_excitation({.period_s = period_s,
                                                                           .ticks = ticks,
                                                                           .lowest_hz = options.lowest_hz,
                                                                           .highest_hz = options.highest_hz,
                                                                           .fast_share = 0.0});
  excitation_n_ = std::move(excitation.force);
  for (double& force : excitation_n_) force *= push_n_;
  lines_ = std::move(excitation.excited);
  const std::vector<double> empty(ticks, 0.0);
  records_.assign(options.records, {empty, empty, empty, empty});
  wall_.begin(wall);
}

std::uint64_t TransparencyTrial::max_ticks() const noexcept {
  return settle_ticks_ + (records_.size() + most_made_anew) * (settle_ticks_ + excitation_n_.size()) + 1;
}

Command TransparencyTrial::step(const drivers::Sample& sample, double elapsed_s) noexcept {
  constexpr double late = 1.5;                   // periods, from which on a tick was missed
  constexpr double golden = 0.6180339887498949;  // its multiples fill a step evenly
  Command command;
  if (finished_) return command;
  const double position_m = lever_ * sample.position[axis_];
  if (!std::exchange(started_, true)) origin_m_ = position_m;
  const double turn = golden * static_cast<double>(record_);
  const double place_m = origin_m_ + encoder_step_m_ * (turn - std::floor(turn));
  const double wall_n =
      wall_.step({.position_m = position_m - place_m, .speed_m_s = lever_ * sample.velocity[axis_]});
  if (elapsed_s > late * period_s_ && tick_ > 0) is_disturbed_ = true;
  // The wall alone, before the first record; then the end of a period, and a whole one.
  const std::size_t ticks = excitation_n_.size();
  const std::size_t alone = record_ == 0 && disturbed_ == 0 ? settle_ticks_ : 0;
  double excitation_n = 0.0;
  if (tick_ >= alone) {
    const std::size_t played = tick_ - alone;
    excitation_n = excitation_n_[(played + ticks - settle_ticks_) % ticks];
    if (played >= settle_ticks_) {
      TransparencyRecord& record = records_[record_];
      const std::size_t at = played - settle_ticks_;
      record.position_m[at] = position_m - origin_m_;
      record.wall_n[at] = wall_n;
      record.excitation_n[at] = excitation_n;
      record.sensor_n[at] = sample.force_measured[axis_];
    }
  }
  if (!(std::abs(wall_n + excitation_n) <= stop_n_)) {
    end(true);
    return command;
  }
  command.force[axis_] = wall_n + excitation_n;
  if (++tick_ == alone + settle_ticks_ + ticks) {
    tick_ = 0;
    if (std::exchange(is_disturbed_, false)) {
      if (++disturbed_ == most_made_anew) end(true);
    } else if (++record_ == records_.size()) {
      end(false);
    }
  }
  return command;
}

std::vector<TransparencyRecord> TransparencyTrial::records() const {
  return {records_.begin(), records_.begin() + static_cast<std::ptrdiff_t>(record_)};
}

Transparency transparency_of(const TransparencyTrial& trial, const Wall& wall, const SampledDevice& model,
                             const TransparencyOptions& options) {
  const std::vector<TransparencyRecord> records = trial.records();
  Transparency found{.wall = wall,
                     .push_n = trial.push_n(),
                     .records = records.size(),
                     .felt_by_sensor = options.sensor_at_hand,
                     .finished = trial.finished() && !trial.failed(),
                     .lines = {},
                     .error = {}};
  if (records.empty()) {
    found.error = transparency_error({});
    return found;
  }
  const std::size_t count = trial.lines().back() + 1;
  std::vector<Spectra> sums(count);
  for (const TransparencyRecord& record : records) {
    const auto x = identification::coefficients(record.position_m, count);
    const auto u = identification::coefficients(record.wall_n, count);
    const auto r = identification::coefficients(record.excitation_n, count);
    const auto f = identification::coefficients(record.sensor_n, count);
    for (const std::size_t line : trial.lines()) {
      Spectra& sum = sums[line];
      sum.xr += x[line] * std::conj(r[line]);
      sum.ur += u[line] * std::conj(r[line]);
      sum.fr += f[line] * std::conj(r[line]);
      sum.xx += std::norm(x[line]);
      sum.uu += std::norm(u[line]);
      sum.rr += std::norm(r[line]);
    }
  }
  const double per_line_hz = 1.0 / (model.period_s * static_cast<double>(records.front().position_m.size()));
  for (const std::size_t line : trial.lines()) {
    const Spectra& sum = sums[line];
    const double frequency_hz = per_line_hz * static_cast<double>(line);
    const Complex jw(0.0, 2.0 * std::numbers::pi * frequency_hz);
    const Complex hold = hold_and_delay(model, frequency_hz);
    RenderedLine at{
        .frequency_hz = frequency_hz,
        .commanded = wall.stiffness_n_per_m / jw + wall.damping_n_s_per_m,
        .loop = -sum.ur / sum.xr * hold / jw,
        .felt = {},
        .coherence = std::min(identification::coherence_of(sum.xr, sum.xx, sum.rr, records.size()),
                              identification::coherence_of(sum.ur, sum.uu, sum.rr, records.size()),
                              [](const auto& a, const auto& b) { return a.value < b.value; })};
    at.felt = options.sensor_at_hand ? (sum.fr + hold * sum.rr) / (jw * sum.xr)
                                     : at.loop + model.mass_kg * jw + model.viscous_n_s_per_m;
    if (!std::isfinite(std::abs(at.loop)) || !std::isfinite(std::abs(at.felt))) at.coherence = {};
    found.lines.push_back(at);
  }
  found.error = transparency_error(found.lines);
  return found;
}

}  // namespace kerf::bench
