#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Core>

#include <kerf/identification/missing.h>

#include "modulated.h"

namespace kerf::identification {
namespace {

constexpr std::size_t cogging_periods = 80;
constexpr std::size_t link_frequencies = 22;
constexpr double slowest_link_rad_s = 40.0;
constexpr double fastest_link_rad_s = 450.0;
constexpr std::array link_dampings_per_s{3.0, 10.0, 30.0};
constexpr double share_behind = 0.5;          // of the mass, behind a link
constexpr double share_behind_in_hand = 0.8;  // with that of the hand
constexpr std::array smoothing_ticks{2, 3};   // on both sides
constexpr double clear_share = 0.9;

/// What the model leaves in the windows, and how much of that something else explains.
class Leftover {
 public:
  Leftover(const AxisData& data, std::span<const Stretch> stretches, const PlacedModel& model,
           double encoder_step_m)
      : signals_(data),
        windows_(windows_of(data, stretches)),
        weights_(data.period_s),
        columns_(columns_of(data, signals_, windows_, model.offset_n.size())),
        plain_(least_squares(columns_,
                             forces_of(data, signals_, windows_, model.axis.delay_s / data.period_s))) {
    all_ = plain_.residual.squaredNorm();
    // Rounding alone would leave this.
    double squares = 0.0;
    for (const double weight : weights_.second) squares += weight * weight;
    const double noise = model.axis.mass_kg * encoder_step_m;
    const double rounding = noise * noise / 12.0 * squares * static_cast<double>(windows_.size());
    beyond_ = std::max(all_ - rounding, 0.1 * all_);
  }

  [[nodiscard]] const Signals& signals() const noexcept { return signals_; }
  [[nodiscard]] const std::vector<Window>& windows() const noexcept { return windows_; }
  [[nodiscard]] const Modulating& weights() const noexcept { return weights_; }

  template <typename Function>
  [[nodiscard]] Eigen::VectorXd column(const std::array<double, window>& weights,
                                       const Function& of_tick) const {
    Eigen::VectorXd out(static_cast<Eigen::Index>(windows_.size()));
    for (std::size_t i = 0; i < windows_.size(); ++i) {
      out[static_cast<Eigen::Index>(i)] = product(weights, windows_[i].begin, of_tick);
    }
    return out;
  }

  struct Explained {
    double share = 0.0;
    Eigen::VectorXd sizes;
  };
  /// All other numbers fitted again.
  [[nodiscard]] Explained by(Eigen::MatrixXd more) const {
    if (!(all_ > 0.0)) return {.share = 0.0, .sizes = Eigen::VectorXd::Zero(more.cols())};
    more -= columns_ * (plain_.inverse * (columns_.transpose() * more));
    const LeastSquares solved = least_squares(more, plain_.residual);
    const double left = solved.residual.squaredNorm();
    return {.share = std::clamp((all_ - left) / beyond_, 0.0, 1.0), .sizes = solved.solution};
  }

 private:
  Signals signals_;
  std::vector<Window> windows_;
  Modulating weights_;
  Eigen::MatrixXd columns_;
  LeastSquares plain_;
  double all_ = 0.0;
  double beyond_ = 0.0;
};

Explanation lost_motion(const Leftover& leftover, const PlacedModel& model) {
  const auto explained = leftover.by(leftover.column(
      leftover.weights().second, [&](std::size_t n) { return leftover.signals().direction(n); }));
  return {.missing = Missing::backlash,
          .share = explained.share,
          .size = std::abs(explained.sizes[0] * 2.0 / model.axis.mass_kg)};
}

Explanation cogging(const Leftover& leftover) {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const Window& at : leftover.windows()) {
    lowest = std::min(lowest, leftover.signals().position(at.begin));
    highest = std::max(highest, leftover.signals().position(at.begin));
  }
  Explanation best{.missing = Missing::cogging};
  for (std::size_t i = 0; i < cogging_periods; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(cogging_periods - 1);
    const double period_m = (highest - lowest) * std::pow(100.0, -share);
    if (!(period_m > 0.0)) break;
    const double turn = 2.0 * std::numbers::pi / period_m;
    const auto& weights = leftover.weights().value;
    Eigen::MatrixXd both(static_cast<Eigen::Index>(leftover.windows().size()), 2);
    both.col(0) = leftover.column(
        weights, [&](std::size_t n) { return std::sin(turn * leftover.signals().position(n)); });
    both.col(1) = leftover.column(
        weights, [&](std::size_t n) { return std::cos(turn * leftover.signals().position(n)); });
    const auto explained = leftover.by(both);
    if (explained.share <= best.share) continue;
    best.share = explained.share;
    best.size = explained.sizes.norm();
    best.period_m = period_m;
  }
  return best;
}

/// The way of a mass behind a spring and a damper that the readings move: exact for the mean over each tick
/// of what the readings, straight from one to the next, exert.
std::vector<double> behind_a_link(const AxisData& data, const AxisModel& behind, double spring_n_per_m,
                                  double damper_n_s_per_m) {
  AxisModel moved = behind;
  moved.stiffness_n_per_m += spring_n_per_m;
  moved.viscous_n_s_per_m += damper_n_s_per_m;
  const Transition tick = transition_over(moved, data.period_s);
  std::vector<double> way;
  way.reserve(data.position_m.size());
  Motion motion;
  double last = 0.0;
  for (const double read : data.position_m) {
    const double now = std::isfinite(read) ? read : last;
    if (way.empty()) {
      motion.position_m = now;
    } else {
      motion = tick.step(
          motion, spring_n_per_m * 0.5 * (last + now) + damper_n_s_per_m * (now - last) / data.period_s);
    }
    last = now;
    way.push_back(motion.position_m);
  }
  return way;
}

Explanation flexible_link(const Leftover& leftover, const AxisData& data, const PlacedModel& model,
                          bool held) {
  AxisModel behind{.mass_kg = (held ? share_behind_in_hand : share_behind) * model.axis.mass_kg};
  if (held) {
    behind.viscous_n_s_per_m = std::max(0.0, model.axis.viscous_n_s_per_m);
    behind.stiffness_n_per_m = std::max(0.0, model.axis.stiffness_n_per_m);
  }
  Explanation best{.missing = Missing::flexible_link};
  for (std::size_t i = 0; i < link_frequencies; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(link_frequencies - 1);
    const double frequency = slowest_link_rad_s * std::pow(fastest_link_rad_s / slowest_link_rad_s, share);
    const double spring = behind.mass_kg * frequency * frequency;
    for (const double damping : link_dampings_per_s) {
      const std::vector<double> way = behind_a_link(data, behind, spring, behind.mass_kg * damping);
      const Modulating& w = leftover.weights();
      const auto at = [&](std::size_t n) { return way[n]; };
      Eigen::MatrixXd columns(static_cast<Eigen::Index>(leftover.windows().size()), held ? 3 : 1);
      columns.col(0) = leftover.column(w.second, at);
      if (held) {
        columns.col(1) = leftover.column(w.first, at);
        columns.col(2) = leftover.column(w.value, at);
      }
      const double explained = leftover.by(columns).share;
      if (explained <= best.share) continue;
      best.share = explained;
      best.size = 1.0 / spring;
    }
  }
  return best;
}

/// The largest kurtosis of what is between a part of the mass and the rest, by parabolas over a few readings.
double blows(const AxisData& data, const Signals& signals, std::span<const Stretch> stretches,
             const PlacedModel& model, bool held) {
  const double delay_ticks = model.axis.delay_s / data.period_s;
  double largest = 0.0;
  for (const int reach : smoothing_ticks) {
    // Least squares of a parabola over 2 r + 1 readings: sums of i^2 and i^4.
    double sum_2 = 0.0;
    double sum_4 = 0.0;
    for (int i = -reach; i <= reach; ++i) {
      sum_2 += std::pow(i, 2);
      sum_4 += std::pow(i, 4);
    }
    const double count = 2.0 * reach + 1.0;
    const double curvature = sum_4 - sum_2 * sum_2 / count;
    std::vector<double> of_mass;
    std::vector<double> of_rest;
    for (const Stretch& stretch : stretches) {
      const auto edge = static_cast<std::size_t>(reach);
      for (std::size_t n = std::max<std::size_t>(stretch.begin, 16); n + edge < stretch.end(); ++n) {
        double acceleration = 0.0;
        double speed = 0.0;
        double force = 0.0;
        for (int i = -reach; i <= reach; ++i) {
          const std::size_t at = n + static_cast<std::size_t>(i + reach) - edge;
          const double position = signals.position(at) - signals.position(n);
          acceleration += 2.0 * (std::pow(i, 2) - sum_2 / count) / curvature * position;
          speed += i / sum_2 * position;
          force += signals.delayed(at, delay_ticks) / count;
        }
        speed /= data.period_s;
        const double friction = (held ? 0.0 : model.axis.viscous_n_s_per_m * speed) +
                                (speed == 0.0 ? 0.0 : std::copysign(model.axis.coulomb_n, speed));
        if (!std::isfinite(acceleration)) continue;
        of_mass.push_back(acceleration / (data.period_s * data.period_s));
        of_rest.push_back(friction - force - model.offset_n[stretch.place]);
      }
    }
    for (int share = 4; share < 20; ++share) {
      const double mass = 0.05 * share * model.axis.mass_kg;
      double second = 0.0;
      double fourth = 0.0;
      for (std::size_t i = 0; i < of_mass.size(); ++i) {
        const double square = std::pow(mass * of_mass[i] + of_rest[i], 2);
        second += square;
        fourth += square * square;
      }
      if (second > 0.0)
        largest = std::max(largest, fourth * static_cast<double>(of_mass.size()) / (second * second));
    }
  }
  return largest;
}

}  // namespace

std::string_view name_of(Missing missing) noexcept {
  switch (missing) {
    case Missing::backlash:
      return "backlash";
    case Missing::cogging:
      return "cogging";
    case Missing::flexible_link:
      break;
  }
  return "a flexible link";
}

std::vector<Explanation> explanations(const AxisData& data, std::span<const Stretch> stretches,
                                      const PlacedModel& model, bool held, double encoder_step_m) {
  const Leftover leftover(data, stretches, model, encoder_step_m);
  Explanation backlash = lost_motion(leftover, model);
  backlash.blows = blows(data, leftover.signals(), stretches, model, held);
  std::vector<Explanation> out{backlash, cogging(leftover), flexible_link(leftover, data, model, held)};
  const auto is_likelier = [](const Explanation& a, const Explanation& b) {
    const bool clear_a = a.share >= clear_share;
    const bool clear_b = b.share >= clear_share;
    if (clear_a || clear_b) return a.share > b.share;
    const bool blows_a = a.blows >= least_blows;
    const bool blows_b = b.blows >= least_blows;
    return blows_a != blows_b ? blows_a : a.share > b.share;
  };
  std::ranges::stable_sort(out, is_likelier);
  return out;
}

}  // namespace kerf::identification
