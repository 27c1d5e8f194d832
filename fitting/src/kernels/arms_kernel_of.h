#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <kerf/models/contact_energy.h>

#include "kernels/kept_ticks.h"
#include "kernels/law_kernel.h"
#include "kernels/normal_sums.h"
#include "kernels/short_dual.h"

namespace kerf::fitting {

/// LawKernel of a law of arms beside a spring, [spring, stiffness of each arm, time of each arm]. What an arm
/// does depends on its own two parameters alone, and the element's force is the sum: each arm is the law
/// itself with this one arm, on dual numbers of these two, and the first of them has the spring. So the work
/// grows with the arms, and not with their square. What is held has derivatives that nobody asks for.
template <template <typename> typename Law>
class ArmsKernelOf final : public LawKernel {
 public:
  bool sums(const LawPoint& point, const RunView& run, const RobustLoss& loss, Sums& sums) const override {
    with_arms(point, [&]<std::size_t Arms>() { sums_of<Arms>(point, run, loss, sums); });
    return true;
  }

  bool rows(const LawPoint& point, const RunView& run, Eigen::Ref<Eigen::VectorXd> force,
            Eigen::Ref<Eigen::MatrixXd> jacobian) const override {
    with_arms(point, [&]<std::size_t Arms>() { rows_of<Arms>(point, run, force, jacobian); });
    return true;
  }

 private:
  static constexpr std::size_t most_arms = Law<double>::max_arms;

  template <typename Work>
  static void with_arms(const LawPoint& point, const Work& work) {
    const std::size_t arms = (point.values.size() - 1) / 2;
    [&]<std::size_t... A>(std::index_sequence<A...>) {
      ((arms == A + 1 ? work.template operator()<A + 1>() : void()), ...);
    }
    (std::make_index_sequence<most_arms>{});
  }

  /// The law with one of the arms.
  template <int Width>
  struct Arm {
    using Dual = ShortDual<Width>;
    Law<Dual> law;
    typename Law<Dual>::State state{};
    KeptTicks<typename Law<Dual>::State> ticks{};

    Arm(const LawPoint& point, std::size_t which, std::size_t arms)
        : law(Law<Dual>::make(values(point, which, arms), options(point))) {}

    static std::vector<Dual> values(const LawPoint& point, std::size_t which, std::size_t arms) {
      const auto searched = [&](std::size_t parameter, int column) {
        Dual value(point.values[parameter]);
        value.v[column] = point.slope[parameter];
        return value;
      };
      std::vector<Dual> values{Dual(0.0), searched(1 + which, 0), searched(1 + arms + which, 1)};
      if constexpr (Width > 2) values[0] = searched(0, 2);
      return values;
    }
    static models::Options options(const LawPoint& point) {
      models::Options one(point.options);
      one[std::string(Law<double>::facts.size.option)] = 1.0;
      return one;
    }
    [[gnu::always_inline]] Dual step(double x, double period_s) noexcept {
      if (law.arms != 1) __builtin_unreachable();  // or each step would go through memory
      const bool known = ticks.recall(state, period_s);
      const Dual force = law.bilateral_step(state, x, period_s);
      if (!known) ticks.keep(state, period_s);
      return force;
    }
  };

  /// Columns of what is searched as the arms have them: those of the first, the spring, a place that is free,
  /// and the others.
  template <std::size_t Arms>
  static std::vector<Eigen::Index> columns(const LawPoint& point) {
    std::array<Eigen::Index, 2 * Arms + 1> at{2};
    for (std::size_t arm = 0; arm < Arms; ++arm) {
      at[1 + arm] = static_cast<Eigen::Index>(2 * arm + (arm > 0 ? 2 : 0));
      at[1 + Arms + arm] = at[1 + arm] + 1;
    }
    std::vector<Eigen::Index> searched;
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (point.slope[i] != 0.0) searched.push_back(at[i]);
    }
    return searched;
  }

  /// Calls `add(i, force, row)` for each sample that counts.
  template <std::size_t Arms, typename Counts, typename Add>
  [[gnu::always_inline]] static void pass(const LawPoint& point, const RunView& run, const Counts& counts,
                                          const Add& add) {
    using Row = typename NormalSums<2 * static_cast<int>(Arms) + 2>::Row;
    Arm<4> first(point, 0, Arms);
    auto others = [&]<std::size_t... A>(std::index_sequence<A...>) {
      return std::array<Arm<2>, Arms - 1>{Arm<2>(point, A + 1, Arms)...};
    }
    (std::make_index_sequence<Arms - 1>{});
    Row row;
    const bool bilateral = first.law.bilateral;
    for (std::size_t i = 0; i < run.count; ++i) {
      const double moved = run.motion[i].penetration;
      const double x = bilateral ? moved : models::pressed(moved);
      const double period_s = run.period_s[i];
      const auto begin = first.step(x, period_s);
      double force = begin.a;
      for (int k = 0; k < 4; ++k) row[k] = begin.v[k];
      for (std::size_t arm = 0; arm + 1 < Arms; ++arm) {
        const auto more = others[arm].step(x, period_s);
        force += more.a;
        const auto at = static_cast<Eigen::Index>(2 * arm + 4);
        row[at] = more.v[0];
        row[at + 1] = more.v[1];
      }
      if (!counts(i)) continue;
      const double felt = bilateral ? force : models::pushing(force);
      if (felt != force) row.setZero();
      add(i, felt, row);
    }
  }

  template <std::size_t Arms>
  [[gnu::flatten]] static void sums_of(const LawPoint& point, const RunView& run, const RobustLoss& loss,
                                       Sums& sums) {
    NormalSums<2 * static_cast<int>(Arms) + 2> normal(loss);
    pass<Arms>(
        point, run, [&](std::size_t i) { return run.weight[i] != 0.0; },
        [&](std::size_t i, double force, const auto& row) {
          normal.add(force - run.force[i], run.weight[i], row);
        });
    normal.write(columns<Arms>(point), sums);
  }

  template <std::size_t Arms>
  [[gnu::flatten]] static void rows_of(const LawPoint& point, const RunView& run,
                                       Eigen::Ref<Eigen::VectorXd> forces,
                                       Eigen::Ref<Eigen::MatrixXd> jacobian) {
    const auto at = columns<Arms>(point);
    Eigen::Index next = 0;
    pass<Arms>(
        point, run, [&](std::size_t i) { return run.is_row(i); },
        [&](std::size_t, double force, const auto& row) {
          forces[next] = force;
          for (std::size_t k = 0; k < at.size(); ++k)
            jacobian(next, static_cast<Eigen::Index>(k)) = row[at[k]];
          ++next;
        });
  }
};

}  // namespace kerf::fitting
