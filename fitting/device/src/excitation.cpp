#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <fmt/core.h>

#include <kerf/identification/excitation.h>

namespace kerf::identification {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int draws_of_phases = 24;
constexpr std::size_t fast_parts = 8;  // of a period: in each other one the fast square wave has this share
constexpr double lesser_share = 0.5;   // not none: it also keeps an encoder's rounding from knowing itself

/// In [0, 1), the same on every standard library.
double uniform(std::mt19937_64& engine) { return static_cast<double>(engine() >> 11U) * 0x1p-53; }

double peak_of(const std::vector<double>& values) {
  double peak = 0.0;
  for (const double value : values) peak = std::max(peak, std::abs(value));
  return peak;
}

void check(const ExcitationOptions& options) {
  const double half_hz = 0.5 / options.period_s;
  if (options.ticks < 64 || options.ticks % 4 != 0) {
    throw std::invalid_argument(
        fmt::format("an excitation of {} ticks: expected a multiple of 4, 64 or more", options.ticks));
  }
  if (!(options.lowest_hz > 0.0 && options.highest_hz > options.lowest_hz &&
        options.highest_hz <= 0.4 * half_hz)) {
    throw std::invalid_argument(
        fmt::format("a band of {:g} to {:g} Hz: expected one above 0 that ends at {:g} Hz or below",
                    options.lowest_hz, options.highest_hz, 0.4 * half_hz));
  }
}

std::vector<double> sum_of_sines(const Excitation& excitation, const ExcitationOptions& options,
                                 std::mt19937_64& engine) {
  std::vector<double> force(options.ticks, 0.0);
  for (const std::size_t line : excitation.excited) {
    const double phase = 2.0 * pi * uniform(engine);
    const double amplitude = std::pow(static_cast<double>(line), options.slope);
    for (std::size_t n = 0; n < options.ticks; ++n) {
      const auto turns = static_cast<double>(line * n % options.ticks) / static_cast<double>(options.ticks);
      force[n] += amplitude * std::sin(2.0 * pi * turns + phase);
    }
  }
  return force;
}

std::vector<double> sweep(std::size_t first, std::size_t last, std::size_t ticks) {
  std::vector<double> force(ticks);
  for (std::size_t n = 0; n < ticks; ++n) {
    const double share = static_cast<double>(n) / static_cast<double>(ticks);
    const double turns =
        static_cast<double>(first) * share + 0.5 * static_cast<double>(last - first) * share * share;
    force[n] = std::sin(2.0 * pi * turns);
  }
  return force;
}

/// A square wave of four ticks that is lesser in each other part of a period, without what its begins and
/// ends leave on the lines up to the last of the band.
std::vector<double> fast_square(std::size_t ticks, std::size_t last) {
  std::vector<double> force(ticks, 0.0);
  const std::size_t part = 4 * (ticks / (4 * fast_parts));
  for (std::size_t n = 0; n < fast_parts * part; ++n) {
    force[n] = (n % 4 < 2 ? 1.0 : -1.0) * (n / part % 2 == 0 ? 1.0 : lesser_share);
  }
  const std::vector<double> whole = force;
  for (std::size_t line = 0; line <= last; ++line) {
    double cosine = 0.0;
    double sine = 0.0;
    const auto turn = [&](std::size_t n) {
      return 2.0 * pi * static_cast<double>(line * n % ticks) / static_cast<double>(ticks);
    };
    for (std::size_t n = 0; n < ticks; ++n) {
      cosine += whole[n] * std::cos(turn(n));
      sine += whole[n] * std::sin(turn(n));
    }
    const double share = (line == 0 ? 1.0 : 2.0) / static_cast<double>(ticks);
    for (std::size_t n = 0; n < ticks; ++n) {
      force[n] -= share * (cosine * std::cos(turn(n)) + sine * std::sin(turn(n)));
    }
  }
  return force;
}

struct Prior {
  AxisModel axis;
  double centring_n_per_m = 0.0;
};

/// What the device is given and where it goes while a spring of the bench centres it.
struct Rehearsal {
  std::vector<double> commanded_n;
  std::vector<double> position_m;
};
Rehearsal rehearse(const Excitation& excitation, double peak_n, const Prior& prior, double period_s,
                   std::size_t periods) {
  const std::size_t length = excitation.force.size();
  Rehearsal out;
  out.commanded_n.assign(length * periods, 0.0);
  out.position_m.assign(length * periods, 0.0);
  const AxisSimulation simulation(prior.axis, period_s);
  Motion motion;
  for (std::size_t n = 0; n < out.position_m.size(); ++n) {
    out.position_m[n] = motion.position_m;
    out.commanded_n[n] = peak_n * excitation.force[n % length] - prior.centring_n_per_m * motion.position_m;
    motion = simulation.after(motion, out.commanded_n, n);
  }
  return out;
}

}  // namespace

Excitation make_excitation(const ExcitationOptions& options) {
  check(options);
  const double line_hz = 1.0 / (static_cast<double>(options.ticks) * options.period_s);
  const auto first = static_cast<std::size_t>(std::max(1.0, std::ceil(options.lowest_hz / line_hz - 1e-9)));
  const auto last = static_cast<std::size_t>(std::floor(options.highest_hz / line_hz + 1e-9));
  Excitation out;
  std::mt19937_64 engine(options.seed);
  std::mt19937_64 lines_engine(options.lines_seed);
  if (options.kind == ExcitationKind::chirp) {
    for (std::size_t line = first; line <= last; ++line) out.excited.push_back(line);
  } else {
    std::vector<std::size_t> odd;
    for (std::size_t line = first; line <= last; ++line) {
      (line % 2 == 1 ? odd : out.even_quiet).push_back(line);
    }
    // One of each four, and never the first of all, which says most of the friction.
    for (std::size_t begin = 0; begin < odd.size(); begin += 4) {
      const auto of_four = static_cast<std::size_t>(4.0 * uniform(lines_engine));
      for (std::size_t i = 0; i < 4 && begin + i < odd.size(); ++i) {
        const bool is_quiet = i == of_four && begin + i > 0;
        (is_quiet ? out.odd_quiet : out.excited).push_back(odd[begin + i]);
      }
    }
  }
  if (out.excited.size() < 6) {
    throw std::invalid_argument(fmt::format(
        "from {:g} to {:g} Hz there are {} lines of {:g} Hz to excite, and six are needed; give a "
        "wider band",
        options.lowest_hz, options.highest_hz, out.excited.size(), line_hz));
  }
  if (options.kind == ExcitationKind::chirp) {
    out.force = sweep(first, last, options.ticks);
  } else {
    for (int draw = 0; draw < draws_of_phases; ++draw) {
      std::vector<double> force = sum_of_sines(out, options, engine);
      if (out.force.empty() || peak_of(force) < peak_of(out.force)) out.force = std::move(force);
    }
  }
  const double scale = (1.0 - options.fast_share) / peak_of(out.force);
  const std::vector<double> fast = fast_square(options.ticks, last);
  for (std::size_t n = 0; n < out.force.size(); ++n) {
    out.force[n] = scale * out.force[n] + options.fast_share * fast[n];
  }
  const double peak = std::max(1.0, peak_of(out.force));
  for (double& force : out.force) force /= peak;
  return out;
}

Prospect prospect_of(const Excitation& excitation, double peak_n, const AxisModel& axis, double period_s,
                     double encoder_step_m, double centring_n_per_m, std::size_t periods) {
  const Prior prior{.axis = axis, .centring_n_per_m = centring_n_per_m};
  const Rehearsal rehearsal = rehearse(excitation, peak_n, prior, period_s, 3);
  const std::size_t length = excitation.force.size();
  const std::size_t begin = 2 * length;
  Prospect prospect;
  double lowest = 0.0;
  double highest = 0.0;
  for (std::size_t n = 0; n < rehearsal.position_m.size(); ++n) {
    lowest = std::min(lowest, rehearsal.position_m[n]);
    highest = std::max(highest, rehearsal.position_m[n]);
    if (n == 0) continue;
    const double speed = std::abs(rehearsal.position_m[n] - rehearsal.position_m[n - 1]) / period_s;
    prospect.speed_m_s = std::max(prospect.speed_m_s, speed);
  }
  prospect.travel_m = highest - lowest;

  const double speed = (rehearsal.position_m[begin + 1] - rehearsal.position_m[begin - 1]) / (2.0 * period_s);
  const Motion at_begin{.position_m = rehearsal.position_m[begin], .speed_m_s = speed};
  const auto readings = [&](const AxisModel& model, Motion from) {
    Eigen::VectorXd positions(static_cast<Eigen::Index>(length));
    simulate(model, period_s, from, rehearsal.commanded_n, begin, std::span(positions.data(), length));
    return positions;
  };
  const Eigen::VectorXd nominal = readings(axis, at_begin);
  // Logarithms of what is positive, so that a column is the effect of one per cent of a hundred.
  constexpr double small = 1e-5;
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(length), 8);
  const auto column = [&](Eigen::Index i, const AxisModel& model, Motion from, double step) {
    columns.col(i) = (readings(model, from) - nominal) / step;
  };
  AxisModel changed = axis;
  changed.mass_kg *= 1.0 + small;
  column(0, changed, at_begin, small);
  changed = axis;
  const double viscous = std::max(axis.viscous_n_s_per_m, 0.1 * axis.mass_kg);
  changed.viscous_n_s_per_m += small * viscous;
  column(1, changed, at_begin, small);
  changed = axis;
  const double coulomb = std::max(axis.coulomb_n, 0.01 * peak_n);
  changed.coulomb_n += small * coulomb;
  column(2, changed, at_begin, small);
  changed = axis;
  changed.delay_s += small * period_s;
  column(3, changed, at_begin, small);
  changed = axis;
  changed.stiffness_n_per_m += 1e-3;
  column(4, changed, at_begin, 1e-3);
  changed = axis;
  changed.offset_n += small * peak_n;
  column(5, changed, at_begin, small);
  column(6, axis, {at_begin.position_m + 1e-8, at_begin.speed_m_s}, 1e-8);
  column(7, axis, {at_begin.position_m, at_begin.speed_m_s + 1e-6}, 1e-6);
  const Eigen::VectorXd norms = columns.colwise().norm().transpose().cwiseMax(1e-300);
  const Eigen::MatrixXd scaled = columns * norms.cwiseInverse().asDiagonal();
  const double noise_m = std::max(encoder_step_m, 1e-9) / std::sqrt(12.0);
  const Eigen::MatrixXd covariance =
      norms.cwiseInverse().asDiagonal() *
      Eigen::MatrixXd((scaled.transpose() * scaled).ldlt().solve(Eigen::MatrixXd::Identity(8, 8))) *
      norms.cwiseInverse().asDiagonal() * (noise_m * noise_m / static_cast<double>(periods));
  const auto half = [&](Eigen::Index i) { return 1.96 * std::sqrt(std::max(0.0, covariance(i, i))); };
  prospect.relative_mass = half(0);
  prospect.relative_viscous = half(1);
  prospect.relative_coulomb = half(2);
  prospect.delay_s = half(3) * period_s;
  prospect.information = -std::log(std::max(1e-300, covariance.topLeftCorner<4, 4>().determinant()));
  return prospect;
}

Design design_excitation(const ExcitationOptions& base, const DesignLimits& limits, const AxisModel& axis,
                         double encoder_step_m, double centring_n_per_m, std::size_t periods) {
  Design best;
  if (!(limits.force_n > 0.0)) return best;
  std::vector<ExcitationOptions> candidates;
  for (const double slope : {-1.0, 0.0, 1.0}) {
    for (const double share : {1.0, 0.5}) {
      ExcitationOptions options = base;
      options.slope = slope;
      options.highest_hz = base.lowest_hz + share * (base.highest_hz - base.lowest_hz);
      candidates.push_back(options);
      if (base.kind == ExcitationKind::chirp) break;
    }
    if (base.kind == ExcitationKind::chirp) break;
  }
  bool any = false;
  for (const ExcitationOptions& options : candidates) {
    Excitation excitation;
    try {
      excitation = make_excitation(options);
    } catch (const std::invalid_argument&) {
      if (&options != &candidates.back() || any) continue;
      throw;
    }
    double peak_n = limits.force_n;
    Prospect prospect;
    for (int i = 0; i < 12; ++i) {
      prospect =
          prospect_of(excitation, peak_n, axis, options.period_s, encoder_step_m, centring_n_per_m, periods);
      const double excess =
          std::max(prospect.travel_m / limits.travel_m, prospect.speed_m_s / limits.speed_m_s);
      if (excess <= 1.0) break;
      // Not in proportion where friction takes a part of the force.
      peak_n *= std::clamp(0.97 / excess, 0.5, 0.95);
    }
    if (any && prospect.information <= best.prospect.information) {
      best.refused.push_back(prospect);
      continue;
    }
    if (any) best.refused.push_back(best.prospect);
    best.options = options;
    best.peak_n = peak_n;
    best.prospect = prospect;
    any = true;
  }
  return best;
}

}  // namespace kerf::identification
