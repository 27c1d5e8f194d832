#include "blade/blade_phases.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kerf::fitting {
namespace {

constexpr std::size_t max_iterations = 30;
constexpr std::size_t splitting_iterations = 10;
constexpr double significant = 50.0;  // twice the logarithm of a likelihood ratio, before phases are changed
constexpr double max_shift = 1.5;     // rows
constexpr std::size_t shortest = 4;   // rows of a part
constexpr std::size_t coarse_cuts = 40;

/// Where the tissue began to hold, and how far the tool moves in a row there.
struct Anchor {
  models::Pose pose;
  models::Twist step;
};

class Fitter {
 public:
  Fitter(const BladeRows& rows, const BladeFitOptions& options)
      : rows_(rows), options_(options), deviation_(noise_of(rows, options)) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      moving_.push_back(rows.in_tissue[i] ? columns_of(rows, i, rows.twist[i]) : Columns::Zero().eval());
    }
  }

  PhaseFit fit() {
    divide();
    guess_releases();
    fit_fields();
    if (!both_known()) try_other_kind();
    for (fit_.iterations = 1; fit_.iterations < max_iterations && !fit_.settled; ++fit_.iterations) {
      const Eigen::Vector3d viscous = fit_.viscous.value;
      const Eigen::Vector3d elastic = fit_.elastic.value;
      bool changed = assign();
      if (fit_.iterations < splitting_iterations && split()) changed = true;
      if (merge()) changed = true;
      fit_fields();
      fit_.settled = !changed && (fit_.viscous.value - viscous).norm() <= 1e-6 * viscous.norm() &&
                     (fit_.elastic.value - elastic).norm() <= 1e-6 * elastic.norm();
    }
    find_residuals();
    return std::move(fit_);
  }

 private:
  void divide() {
    const std::vector<Jump> jumps = find_jumps(rows_, deviation_, options_);
    auto jump = jumps.begin();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (!rows_.in_tissue[i]) continue;
      while (jump != jumps.end() && jump->row < i) ++jump;
      const bool jumps_here = jump != jumps.end() && jump->row == i;
      const bool goes_on = i > 0 && rows_.in_tissue[i - 1] && rows_.follows(i);
      if (goes_on && !jumps_here) {
        fit_.phases.back().end = i + 1;
        continue;
      }
      const bool enters = rows_.follows(i) && !rows_.in_tissue[i - 1];
      const bool begins_free = jumps_here
                                   ? jump->after.head<3>().norm() <
                                         std::max(3.0 * jump->error_n, 0.1 * jump->before.head<3>().norm())
                                   : begins_without_force(i);
      fit_.phases.push_back({.begin = i,
                             .end = i + 1,
                             .elastic = enters || begins_free,
                             .follows_another = jumps_here,
                             .anchor_may_shift = enters || jumps_here});
    }
  }

  /// A viscous force does not jump: a cutting phase that ends in a jump to another one has held before it,
  /// from about where the force was least.
  void guess_releases() {
    std::vector<BladePhase> all;
    for (std::size_t p = 0; p < fit_.phases.size(); ++p) {
      BladePhase phase = fit_.phases[p];
      const bool jumps_to_cutting = p + 1 < fit_.phases.size() && fit_.phases[p + 1].begin == phase.end &&
                                    fit_.phases[p + 1].follows_another && !fit_.phases[p + 1].elastic;
      BladePhase second;
      const std::size_t at = phase.elastic || !jumps_to_cutting ? phase.end : least_force_row(phase);
      if (at < phase.end) cut(phase, second, at);
      all.push_back(phase);
      if (second.end > 0) all.push_back(second);
    }
    fit_.phases = std::move(all);
  }
  [[nodiscard]] std::size_t least_force_row(const BladePhase& phase) const {
    const std::size_t window = window_rows(rows_, options_);
    if (phase.end - phase.begin < 2 * window + shortest) return phase.end;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double least = std::numeric_limits<double>::infinity();
    std::size_t at = phase.end;
    for (std::size_t i = phase.begin; i < phase.end; ++i) {
      sum += rows_.force[i].head<3>();
      if (i < phase.begin + window) continue;
      sum -= rows_.force[i - window].head<3>();
      if (sum.norm() < least) {
        least = sum.norm();
        at = i - window / 2;
      }
    }
    return at + shortest < phase.end ? at : phase.end;
  }

  [[nodiscard]] bool begins_without_force(std::size_t row) const {
    const std::size_t window = window_rows(rows_, options_);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    double largest = 0.0;
    for (std::size_t i = row; i < std::min(row + window, rows_.size()); ++i) {
      mean += rows_.force[i].head<3>() / static_cast<double>(window);
    }
    for (const Vector6d& force : rows_.force) largest = std::max(largest, force.head<3>().norm());
    const double error = deviation_.head<3>().maxCoeff() / std::sqrt(static_cast<double>(window));
    return mean.norm() < std::max(3.0 * error, 0.1 * largest);
  }

  [[nodiscard]] double cost(const Vector6d& residual) const {
    return residual.cwiseQuotient(deviation_).squaredNorm();
  }
  [[nodiscard]] double moving_cost(std::size_t row) const {
    return cost(rows_.force[row] - moving_[row] * fit_.viscous.value);
  }

  [[nodiscard]] Anchor anchor_of(const BladePhase& phase) const {
    Anchor anchor{.pose = rows_.pose[phase.begin]};
    if (!phase.anchor_may_shift) return anchor;
    anchor.step = displacement_of(anchor.pose, rows_.pose[phase.begin - 1]);
    anchor.pose.hand += phase.shift * anchor.step.linear;
    anchor.pose.rotation = models::rotation_of(phase.shift * anchor.step.angular) * anchor.pose.rotation;
    return anchor;
  }
  /// What the elastic field exerts at a row for a displacement.
  [[nodiscard]] Vector6d elastic_force(std::size_t row, const models::Twist& displacement) const {
    const Eigen::Vector3d& field = fit_.elastic.value;
    return force_of(rows_, row, {field[0], field[1], field[2]}, displacement);
  }
  [[nodiscard]] Vector6d elastic_residual(std::size_t row, const Anchor& anchor) const {
    return rows_.force[row] - elastic_force(row, displacement_of(rows_.pose[row], anchor.pose));
  }

  /// Cost of a phase as an elastic one; its anchor is shifted to where it is least.
  double held_cost(BladePhase& phase) const {
    const Anchor anchor = anchor_of(phase);
    double squares = 0.0;
    double cross = 0.0;
    double along = 0.0;
    for (std::size_t i = first_fitted_row(phase); i < phase.end; ++i) {
      const Vector6d residual = elastic_residual(i, anchor).cwiseQuotient(deviation_);
      squares += residual.squaredNorm();
      if (!phase.anchor_may_shift) continue;
      const Vector6d by_shift = elastic_force(i, anchor.step).cwiseQuotient(deviation_);
      cross += by_shift.dot(residual);
      along += by_shift.squaredNorm();
    }
    if (!(along > 0.0)) return squares;
    const double shift = std::clamp(phase.shift - cross / along, -max_shift, max_shift);
    const double change = shift - phase.shift;
    phase.shift = shift;
    return squares + 2.0 * change * cross + change * change * along;
  }
  double moving_cost(const BladePhase& phase) const {
    double sum = 0.0;
    for (std::size_t i = first_fitted_row(phase); i < phase.end; ++i) sum += moving_cost(i);
    return sum;
  }

  [[nodiscard]] bool both_known() const { return fit_.elastic_rows > 0 && fit_.cutting_rows > 0; }

  /// Where nothing jumps there is one kind of phase; the force alone does not say which.
  void try_other_kind() {
    const auto whole_cost = [&] {
      double sum = 0.0;
      for (BladePhase& phase : fit_.phases) sum += phase.elastic ? held_cost(phase) : moving_cost(phase);
      return sum;
    };
    const double as_it_is = whole_cost();
    const PhaseFit kept = fit_;
    for (BladePhase& phase : fit_.phases) phase.elastic = !phase.elastic;
    fit_fields();
    if (whole_cost() >= as_it_is) fit_ = kept;
  }

  /// Gives each phase to the field that explains it better. Every phase's anchor moves to its best place.
  bool assign() {
    bool changed = false;
    for (BladePhase& phase : fit_.phases) {
      const double as_held = held_cost(phase);
      if (!both_known()) continue;
      const bool elastic = as_held < moving_cost(phase);
      changed = changed || elastic != phase.elastic;
      phase.elastic = elastic;
    }
    return changed;
  }

  /// Looks in each phase for a change to the other kind that was too small to be seen as a jump.
  bool split() {
    if (!both_known()) return false;
    std::vector<BladePhase> all;
    for (BladePhase& phase : fit_.phases) {
      BladePhase second = phase;
      const bool found = phase.elastic ? find_rupture(phase, second) : find_release(phase, second);
      all.push_back(phase);
      if (found) all.push_back(second);
    }
    const bool changed = all.size() != fit_.phases.size();
    fit_.phases = std::move(all);
    return changed;
  }

  static void cut(BladePhase& phase, BladePhase& second, std::size_t at) {
    second = {.begin = at,
              .end = phase.end,
              .elastic = !phase.elastic,
              .follows_another = true,
              .anchor_may_shift = true};
    phase.end = at;
  }

  bool find_rupture(BladePhase& phase, BladePhase& second) const {
    if (phase.end - phase.begin < 2 * shortest + 2) return false;
    const Anchor anchor = anchor_of(phase);
    const std::size_t first = first_fitted_row(phase);
    double gain = 0.0;  // of cutting from a row on
    double best = significant;
    std::size_t at = 0;
    for (std::size_t i = phase.end; i-- > first + shortest;) {
      gain += cost(elastic_residual(i, anchor)) - moving_cost(i);
      if (gain > best && phase.end - i >= shortest) {
        best = gain;
        at = i;
      }
    }
    if (at == 0) return false;
    cut(phase, second, at);
    return true;
  }

  bool find_release(BladePhase& phase, BladePhase& second) const {
    if (phase.end - phase.begin < 2 * shortest + 2) return false;
    const std::size_t lowest = phase.begin + shortest;
    const std::size_t highest = phase.end - shortest;
    std::vector<double> rest(phase.end - phase.begin + 1, 0.0);  // cost of cutting from a row on
    for (std::size_t i = phase.end; i-- > phase.begin;) {
      rest[i - phase.begin] = rest[i + 1 - phase.begin] + moving_cost(i);
    }
    const auto gain_at = [&](std::size_t i) {
      BladePhase part{.begin = i, .end = phase.end, .elastic = true, .anchor_may_shift = true};
      return rest[i - phase.begin] - held_cost(part);
    };
    std::size_t step = std::max<std::size_t>(1, (highest - lowest) / coarse_cuts);
    std::size_t at = highest;
    double best = 0.0;
    const auto consider = [&](std::size_t i) {
      if (const double gain = gain_at(i); gain > best) {
        best = gain;
        at = i;
      }
    };
    for (std::size_t i = lowest; i <= highest; i += step) consider(i);
    while (step > 1) {
      step = (step + 1) / 2;
      const std::size_t middle = at;
      if (middle >= lowest + step) consider(middle - step);
      if (middle + step <= highest) consider(middle + step);
    }
    if (best < significant) return false;
    cut(phase, second, at);
    return true;
  }

  /// Joins neighbours between which nothing changed.
  bool merge() {
    std::vector<BladePhase> all;
    for (BladePhase& phase : fit_.phases) {
      if (!all.empty() && all.back().end == phase.begin && phase.follows_another &&
          all.back().elastic == phase.elastic && one_phase(all.back(), phase)) {
        all.back().end = phase.end;
      } else {
        all.push_back(phase);
      }
    }
    const bool changed = all.size() != fit_.phases.size();
    fit_.phases = std::move(all);
    return changed;
  }
  [[nodiscard]] bool one_phase(BladePhase first, BladePhase second) const {
    if (!first.elastic) return true;
    BladePhase both = first;
    both.end = second.end;
    return held_cost(both) < held_cost(first) + held_cost(second) + significant;
  }

  /// Takes the unknown shift of the anchor out of an elastic phase: what is left of columns and force is
  /// orthogonal to it.
  void add_held(FieldRows& all, const BladePhase& phase) const {
    const Anchor anchor = anchor_of(phase);
    const std::size_t first = all.size();
    const bool free = phase.anchor_may_shift && std::abs(phase.shift) < max_shift;
    const Vector6d weight = deviation_.cwiseAbs2().cwiseInverse();
    std::vector<Vector6d> by_shift;
    Eigen::RowVector3d of_columns = Eigen::RowVector3d::Zero();
    double of_force = 0.0;
    double along = 0.0;
    for (std::size_t i = first_fitted_row(phase); i < phase.end; ++i) {
      all.columns.push_back(columns_of(rows_, i, displacement_of(rows_.pose[i], anchor.pose)));
      all.force.push_back(rows_.force[i]);
      if (!free) continue;
      by_shift.push_back(elastic_force(i, anchor.step));
      const Vector6d weighted = by_shift.back().cwiseProduct(weight);
      of_columns += weighted.transpose() * all.columns.back();
      of_force += weighted.dot(all.force.back());
      along += weighted.dot(by_shift.back());
    }
    if (!(along > 0.0)) return;
    for (std::size_t k = 0; k < by_shift.size(); ++k) {
      all.columns[first + k] -= by_shift[k] * of_columns / along;
      all.force[first + k] -= by_shift[k] * of_force / along;
    }
  }

  void fit_fields() {
    FieldRows cutting;
    FieldRows elastic;
    for (const BladePhase& phase : fit_.phases) {
      if (phase.elastic) {
        add_held(elastic, phase);
        continue;
      }
      for (std::size_t i = first_fitted_row(phase); i < phase.end; ++i) {
        cutting.columns.push_back(moving_[i]);
        cutting.force.push_back(rows_.force[i]);
      }
    }
    fit_.elastic_rows = elastic.size();
    fit_.cutting_rows = cutting.size();
    fit_.viscous = fit_field(cutting, options_);
    fit_.elastic = fit_field(elastic, options_);
  }

  void find_residuals() {
    fit_.residuals.assign(rows_.size(), Vector6d::Zero());
    for (const BladePhase& phase : fit_.phases) {
      const Anchor anchor = anchor_of(phase);
      for (std::size_t i = first_fitted_row(phase); i < phase.end; ++i) {
        fit_.residuals[i] =
            phase.elastic ? elastic_residual(i, anchor) : rows_.force[i] - moving_[i] * fit_.viscous.value;
      }
    }
  }

  const BladeRows& rows_;
  const BladeFitOptions& options_;
  Vector6d deviation_;
  std::vector<Columns> moving_;
  PhaseFit fit_;
};

}  // namespace

PhaseFit fit_phases(const BladeRows& rows, const BladeFitOptions& options) {
  return Fitter(rows, options).fit();
}

}  // namespace kerf::fitting
