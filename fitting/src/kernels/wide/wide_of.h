#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include <kerf/models/exponential.h>
#include <kerf/models/friction.h>
#include <kerf/models/kelvin.h>
#include <kerf/models/maxwell.h>
#include <kerf/models/springpot.h>

#include "kernels/law_kernel.h"
#include "kernels/wide/arms.h"
#include "kernels/wide/exponential.h"
#include "kernels/wide/friction.h"
#include "kernels/wide/springpot.h"

namespace kerf::fitting::wide {

/// A law that is reckoned with in columns, and its derivatives: a row for each parameter, of what it takes of
/// each column.
template <typename Columns>
struct Wide {
  Columns law;
  Eigen::MatrixXd derivatives;
};

/// How a law is reckoned with in columns. None for most laws, and none for some of their options.
template <template <typename> typename Law>
struct WideOf {
  static constexpr bool exists = false;
};

template <>
struct WideOf<models::Kelvin> {
  static constexpr bool exists = true;
  static std::optional<Wide<Arms>> at(const LawPoint& point) {
    const auto law = models::Kelvin<double>::make(point.values, point.options);
    if (law.integrator != models::Integrator::exact) return std::nullopt;
    const double time_s = law.relaxation_time();
    Wide<Arms> wide{
        .law = Arms(law.parallel_stiffness, {&law.series_stiffness, 1}, {&time_s, 1}, law.bilateral),
        .derivatives = Eigen::MatrixXd::Zero(3, 3)};
    wide.derivatives(0, 0) = 1.0;
    wide.derivatives(1, 1) = 1.0;
    wide.derivatives(1, 2) = -1.0;  // a stiffer spring relaxes sooner
    wide.derivatives(2, 2) = law.series_stiffness / law.damping;
    return wide;
  }
};

template <>
struct WideOf<models::Maxwell> {
  static constexpr bool exists = true;
  static std::optional<Wide<Arms>> at(const LawPoint& point) {
    const auto law = models::Maxwell<double>::make(point.values, point.options);
    if (law.integrator != models::Integrator::exact) return std::nullopt;
    const auto all = static_cast<Eigen::Index>(1 + 2 * law.arms);
    Wide<Arms> wide{.law = Arms(law.parallel_stiffness, {law.stiffness.data(), law.arms},
                                {law.relaxation_time.data(), law.arms}, law.bilateral),
                    .derivatives = Eigen::MatrixXd::Zero(all, all)};
    wide.derivatives(0, 0) = 1.0;
    for (std::size_t k = 0; k < law.arms; ++k) {
      const auto arm = static_cast<Eigen::Index>(k);
      const auto arms = static_cast<Eigen::Index>(law.arms);
      wide.derivatives(1 + arm, 1 + 2 * arm) = 1.0;
      wide.derivatives(1 + arms + arm, 2 + 2 * arm) = law.stiffness[k] / law.relaxation_time[k];
    }
    return wide;
  }
};

template <>
struct WideOf<models::Exponential> {
  static constexpr bool exists = true;
  static std::optional<Wide<Exponential>> at(const LawPoint& point) {
    const auto law = models::Exponential<double>::make(point.values, point.options);
    if (law.zero_at_contact) return std::nullopt;
    const models::OptionReader reader(law.name, law.options(), point.options);
    Wide<Exponential> wide{
        .law = Exponential(law),
        .derivatives = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(point.values.size()), 4)};
    wide.derivatives(0, 0) = 1.0;
    wide.derivatives(1, 1) = law.amplitude / law.exponent;
    Eigen::Index next = 2;
    if (reader.flag("viscous")) wide.derivatives(next++, 2) = 1.0;
    if (reader.flag("offset")) wide.derivatives(next, 3) = 1.0;
    return wide;
  }
};

template <>
struct WideOf<models::Friction> {
  static constexpr bool exists = true;
  static std::optional<Wide<Friction>> at(const LawPoint& point) {
    const auto law = models::Friction<double>::make(point.values, point.options);
    Wide<Friction> wide{.law = Friction(law), .derivatives = Eigen::MatrixXd::Identity(5, 5)};
    wide.derivatives(4, 4) = law.coulomb / law.presliding;
    return wide;
  }
};

template <>
struct WideOf<models::Springpot> {
  static constexpr bool exists = true;
  static std::optional<Wide<Springpot>> at(const LawPoint& point) {
    using Dual = Springpot::Dual;
    std::vector<Dual> values(point.values.begin(), point.values.end());
    values.back().v[0] = 1.0;
    const auto count = static_cast<Eigen::Index>(values.size());
    // Without the spring there is no parameter that the first column would be of.
    Wide<Springpot> wide{.law = Springpot(models::Springpot<Dual>::make(values, point.options)),
                         .derivatives = Eigen::MatrixXd::Identity(3, 3).bottomRows(count)};
    return wide;
  }
};

/// The derivatives by what is searched.
template <typename Columns>
Eigen::MatrixXd searched_rows(const Wide<Columns>& wide, const LawPoint& point) {
  Eigen::MatrixXd rows(wide.derivatives.rows(), wide.derivatives.cols());
  Eigen::Index next = 0;
  for (std::size_t i = 0; i < point.slope.size(); ++i) {
    if (point.slope[i] == 0.0) continue;
    rows.row(next++) = point.slope[i] * wide.derivatives.row(static_cast<Eigen::Index>(i));
  }
  return rows.topRows(next);
}

template <typename Columns>
void sums(Wide<Columns>& wide, const LawPoint& point, const RunView& run, Sums& sums) {
  Products products(wide.law.columns());
  Block block;
  for (std::size_t begin = 0; begin < run.count; begin += Block::most_rows) {
    block.take(run, begin);
    if (!block.counts && !Columns::remembers) continue;
    wide.law.fill(block);
    if (block.counts) products.add(block);
  }
  const Sums by_columns = products.sums();
  const Eigen::MatrixXd rows = searched_rows(wide, point);
  sums.squares = by_columns.squares;
  sums.score.noalias() = rows * by_columns.score;
  sums.normal.noalias() = rows * by_columns.normal * rows.transpose();
}

/// The force and its derivatives, row by row.
template <typename Columns>
void rows(Wide<Columns>& wide, const LawPoint& point, const RunView& run, Eigen::Ref<Eigen::VectorXd> force,
          Eigen::Ref<Eigen::MatrixXd> jacobian) {
  const Eigen::MatrixXd searched = searched_rows(wide, point);
  Block block;
  Eigen::Index done = 0;
  for (std::size_t begin = 0; begin < run.count; begin += Block::most_rows) {
    block.take(run, begin);
    const bool some = run.only_those_that_count && !block.all_count;
    if (some && !block.counts && !Columns::remembers) continue;
    wide.law.fill(block);
    if (some) block.keep_those_that_count(wide.law.columns());
    const auto count = static_cast<Eigen::Index>(block.count);
    force.segment(done, count) = Eigen::Map<const Eigen::VectorXd>(block.force.data(), count);
    for (Eigen::Index k = 0; k < searched.rows(); ++k) {
      auto column = jacobian.col(k).segment(done, count);
      bool first = true;
      for (Eigen::Index j = 0; j < searched.cols(); ++j) {
        if (searched(k, j) == 0.0) continue;
        const Eigen::Map<const Eigen::VectorXd> part(block.column[static_cast<std::size_t>(j)].data(), count);
        if (first) {
          column = searched(k, j) * part;
        } else {
          column += searched(k, j) * part;
        }
        first = false;
      }
      if (first) column.setZero();
    }
    done += count;
  }
}

/// The force alone, row by row.
template <typename Columns>
void forces(Wide<Columns>& wide, RunView run, double* force) {
  run.force = run.weight = run.period_s;  // neither is asked for
  Block block;
  for (std::size_t begin = 0; begin < run.count; begin += Block::most_rows) {
    block.take(run, begin);
    wide.law.fill(block);
    std::copy_n(block.force.begin(), block.count, force + begin);
  }
}

}  // namespace kerf::fitting::wide
