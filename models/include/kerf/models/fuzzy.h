#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <kerf/models/choice.h>
#include <kerf/models/law_facts.h>
#include <kerf/models/parameter.h>

namespace kerf::models {

/// Takagi-Sugeno fuzzy system over depth and speed: the force at which tissue ruptures.
///
///     F(d, s) = sum_ij w_ij (p_ij d + q_ij s + r_ij) / sum_ij w_ij
///     w_ij    = mu_i(d) nu_j(s),   mu(x) = exp(-(x - centre)^2 / (2 width^2))
///
/// m Gaussian memberships an input, m^2 rules. Outside the box of the inputs they clamp to its edge. The
/// result is never below zero. Far from every centre the nearest rule alone counts: the weights are scaled by
/// the largest, so that their sum never vanishes.
///
/// Source: [FuzzyKelvin], section 2.2, figs. 2-3 (first-order consequents, as ANFIS has them).
template <typename T>
struct FuzzySurface {
  static constexpr std::size_t max_memberships = 5;

  /// One input: its memberships and the box it is clamped to.
  struct Input {
    std::array<T, max_memberships> centre{};
    std::array<T, max_memberships> width{};
    double least = 0.0;
    double most = 1.0;
  };
  struct Rule {
    T per_depth{};  ///< p [N/m]
    T per_speed{};  ///< q [N·s/m]
    T constant{};   ///< r [N]
  };

  std::size_t memberships = 3;  ///< m
  Input depth;
  Input speed;
  std::array<Rule, max_memberships * max_memberships> rule{};  ///< w_ij at i m + j

  /// Number of parameters of m memberships, in the order of parameters(): 4 m premises, 3 m^2 consequents.
  static constexpr std::size_t parameter_count(std::size_t m) { return 4 * m + 3 * m * m; }

  /// Facts of the laws that have one: the box of the data, and how many memberships.
  static constexpr Few<DataOption, 5> from_data(double memberships) {
    return {{"memberships", From::number, memberships},
            {"least_depth", From::number, 0.0},
            {"most_depth", From::depth},
            {"least_speed", From::number, 0.0},
            {"most_speed", From::speed}};
  }
  static constexpr SizeFacts size{
      .option = "memberships", .unit = "rule", .first = 2, .last = 5, .squared = true};

  static std::vector<OptionInfo> options() {
    return {{"memberships", 3.0, "m, memberships an input, 1 to 5; m^2 rules"},
            {"least_depth", 0.0, "depths clamp to this from below [m]"},
            {"most_depth", 0.01, "and to this from above [m]"},
            {"least_speed", 0.0, "speeds clamp to this from below [m/s]"},
            {"most_speed", 0.01, "and to this from above [m/s]"}};
  }
  static std::vector<ParameterInfo> parameters(const OptionReader& reader) {
    const std::size_t m = reader.count("memberships", 1, max_memberships);
    std::vector<ParameterInfo> all;
    const auto add = [&](const char* what, std::size_t count, Quantity quantity, double lower, double upper,
                         Scale scale, const char* meaning) {
      for (std::size_t i = 0; i < count; ++i) {
        all.push_back(
            {std::string(what) + "[" + std::to_string(i) + "]", quantity, lower, upper, scale, meaning});
      }
    };
    add("depth_centre", m, Quantity::position, -1e3, 1e3, Scale::linear, "centre of a membership of depth");
    add("depth_width", m, Quantity::position, 1e-9, 1e3, Scale::logarithmic, "its width");
    add("speed_centre", m, Quantity::velocity, -1e3, 1e3, Scale::linear, "centre of a membership of speed");
    add("speed_width", m, Quantity::velocity, 1e-9, 1e3, Scale::logarithmic, "its width");
    add("per_depth", m * m, Quantity::stiffness, -1e9, 1e9, Scale::linear, "p of a rule, depth by depth");
    add("per_speed", m * m, Quantity::damping, -1e9, 1e9, Scale::linear, "q of a rule");
    add("constant", m * m, Quantity::force, -1e6, 1e6, Scale::linear, "r of a rule");
    return all;
  }
  static FuzzySurface make(std::span<const T> values, const OptionReader& reader) {
    FuzzySurface surface;
    const std::size_t m = surface.memberships = reader.count("memberships", 1, max_memberships);
    const auto box = [&](Input& input, const char* least, const char* most) {
      input.least = reader.number(least, -1e3, 1e3);
      input.most = reader.number(most, input.least, 1e3);
    };
    box(surface.depth, "least_depth", "most_depth");
    box(surface.speed, "least_speed", "most_speed");
    for (std::size_t i = 0; i < m; ++i) {
      surface.depth.centre[i] = values[i];
      surface.depth.width[i] = values[m + i];
      surface.speed.centre[i] = values[2 * m + i];
      surface.speed.width[i] = values[3 * m + i];
    }
    for (std::size_t k = 0; k < m * m; ++k) {
      surface.rule[k] = {values[4 * m + k], values[4 * m + m * m + k], values[4 * m + 2 * m * m + k]};
    }
    return surface;
  }

  /// Normalised weights of the rules at inputs that are already within the box.
  void weights(Signal<T> d, Signal<T> s, std::span<T> weight) const noexcept {
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): filled below, and zeros would cost the tick
    std::array<T, max_memberships> of_depth;
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): filled below, and zeros would cost the tick
    std::array<T, max_memberships> of_speed;
    memberships_of(depth, d, of_depth);
    memberships_of(speed, s, of_speed);
    T of_all_depths(0.0);
    T of_all_speeds(0.0);
    for (std::size_t i = 0; i < memberships; ++i) {
      of_all_depths += of_depth[i];
      of_all_speeds += of_speed[i];
    }
    const T scale = 1.0 / (of_all_depths * of_all_speeds);  // the sum over all products
    for (std::size_t i = 0; i < memberships; ++i) {
      for (std::size_t j = 0; j < memberships; ++j) {
        weight[i * memberships + j] = of_depth[i] * of_speed[j] * scale;
      }
    }
  }

  /// Integral of the rupture force over the depth, from 0 to a depth >= 0 at one speed [J]: by Gauss' rule of
  /// eight points within the box, and by the constants to which the depth clamps beyond it.
  [[nodiscard]] T work_to(double d, double s) const noexcept {
    constexpr std::array<double, 4> node{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                         0.9602898564975363};
    constexpr std::array<double, 4> weight_of{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                              0.1012285362903763};
    const double from = std::clamp(depth.least, 0.0, d);
    const double to = std::clamp(depth.most, from, d);
    T work(0.0);
    if (from > 0.0) work += from * (*this)(from, s);
    if (to < d) work += (d - to) * (*this)(to, s);
    const double half = 0.5 * (to - from);
    for (std::size_t i = 0; half > 0.0 && i < node.size(); ++i) {
      work += half * weight_of[i] *
              ((*this)(from + half * (1.0 - node[i]), s) + (*this)(from + half * (1.0 + node[i]), s));
    }
    return work;
  }

  /// Rupture force at a depth [m] and a speed [m/s], >= 0 [N].
  [[nodiscard]] T operator()(Signal<T> d, Signal<T> s) const noexcept {
    d = within(depth, d);
    s = within(speed, s);
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): likewise
    std::array<T, max_memberships * max_memberships> weight;
    weights(d, s, weight);
    T force(0.0);
    for (std::size_t k = 0; k < memberships * memberships; ++k) {
      force += weight[k] * (rule[k].per_depth * d + rule[k].per_speed * s + rule[k].constant);
    }
    return chosen(force < T(0.0), T(0.0), force);
  }

 private:
  static Signal<T> within(const Input& input, Signal<T> x) noexcept {
    return lesser(greater(x, Signal<T>(input.least)), Signal<T>(input.most));
  }
  void memberships_of(const Input& input, Signal<T> x,
                      std::array<T, max_memberships>& membership) const noexcept {
    using std::exp;
    T least(std::numeric_limits<double>::max());
    for (std::size_t i = 0; i < memberships; ++i) {
      const T distance = (x - input.centre[i]) / input.width[i];
      membership[i] = 0.5 * distance * distance;
      least = lesser(least, membership[i]);
    }
    for (std::size_t i = 0; i < memberships; ++i) membership[i] = exp(least - membership[i]);
  }
};

}  // namespace kerf::models
