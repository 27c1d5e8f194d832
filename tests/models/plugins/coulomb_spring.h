// coulomb_spring.c once more, as a header for 'kerf law build'.
#pragma once

#include <cmath>
#include <span>
#include <string_view>
#include <vector>

#include <kerf/plugin.h>

template <typename T>
struct CoulombSpring {
  static constexpr std::string_view name = "coulomb_spring_header";
  static constexpr std::string_view equation = "F = F0 + k x + b v + Fc z";
  static constexpr std::string_view linear[] = {"offset", "stiffness", "viscosity", "coulomb"};
  static constexpr unsigned tells = KERF_TELLS_LOOP | KERF_TELLS_RATE;

  T offset{};
  T stiffness{};
  T viscosity{};
  T coulomb{};
  T presliding{};

  struct State {
    T slip{0.0};
    double penetration = 0.0;
    bool started = false;
  };

  static std::vector<kerf::models::ParameterInfo> parameters(const kerf::models::Options&) {
    using kerf::models::Quantity;
    using kerf::models::Scale;
    return {{"offset", Quantity::force, -1e6, 1e6, Scale::linear, "force at zero and at rest"},
            {"stiffness", Quantity::stiffness, -1e9, 1e9, Scale::linear, "force per position"},
            {"viscosity", Quantity::damping, -1e6, 1e6, Scale::linear, "force per speed"},
            {"coulomb", Quantity::force, 0.0, 1e6, Scale::linear, "dry friction"},
            {"presliding", Quantity::position, 1e-9, 1e3, Scale::logarithmic, "travel of its rise"}};
  }
  static std::vector<double> initial() { return {0.0, 100.0, 0.0, 0.2, 1e-3}; }
  static CoulombSpring make(std::span<const T> values, const kerf::models::Options&) {
    return {values[0], values[1], values[2], values[3], values[4]};
  }

  T step(State& state, const kerf::models::Motion& motion, double) const {
    using std::exp;
    const double travel = state.started ? motion.penetration - state.penetration : 0.0;
    state.started = true;
    state.penetration = motion.penetration;
    if (travel != 0.0) {
      const double sign = travel > 0.0 ? 1.0 : -1.0;
      state.slip = sign + (state.slip - sign) * exp(-std::abs(travel) / presliding);
    }
    return offset + stiffness * motion.penetration + viscosity * motion.velocity + coulomb * state.slip;
  }
};

KERF_LAW(CoulombSpring);
