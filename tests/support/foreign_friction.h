#pragma once

#include <cmath>
#include <vector>

#include <kerf/models/foreign.h>

namespace kerf::test {

/// Spring, viscosity and Dahl's friction as a plug-in would have them: kerf::models::Friction once more, in
/// the terms of kerf/law.h.
namespace foreign_friction {

struct State {
  double slip, penetration, started;
};
inline void step(const double* p, void* memory, const double* x, const double* v, double, double* force) {
  State& state = *static_cast<State*>(memory);
  if (state.started == 0.0) state = {0.0, *x, 1.0};
  const double travel = *x - state.penetration;
  state.penetration = *x;
  if (travel != 0.0) {
    const double sign = travel > 0.0 ? 1.0 : -1.0;
    state.slip = sign + (state.slip - sign) * std::exp(-std::abs(travel) / p[4]);
  }
  *force = p[0] + p[1] * *x + p[2] * *v + p[3] * state.slip;
}

struct DualState {
  State value;
  double slip_by_presliding;
};
inline void step_derivatives(const double* p, void* memory, const double* x, const double* v, double,
                             double* force, double* by) {
  DualState& state = *static_cast<DualState*>(memory);
  const bool first = state.value.started == 0.0;
  const double travel = first ? 0.0 : *x - state.value.penetration;
  if (travel != 0.0) {
    const double sign = travel > 0.0 ? 1.0 : -1.0;
    const double decay = std::exp(-std::abs(travel) / p[4]);
    state.slip_by_presliding =
        decay * (state.slip_by_presliding + (state.value.slip - sign) * std::abs(travel) / (p[4] * p[4]));
  }
  step(p, &state.value, x, v, 0.0, force);
  by[0] = 1.0;
  by[1] = *x;
  by[2] = *v;
  by[3] = state.value.slip;
  by[4] = p[3] * state.slip_by_presliding;
}

inline constexpr unsigned linear = KERF_SEARCHED | KERF_LINEAR;
inline const kerf_law_parameter_v1 parameters[] = {
    {"offset", "N", "force at zero and at rest", -1e6, 1e6, 0.0, linear},
    {"stiffness", "N/m", "force per position", -1e9, 1e9, 1.0, linear},
    {"viscosity", "N*s/m", "force per speed", -1e6, 1e6, 0.0, linear},
    {"coulomb", "N", "dry friction", 0.0, 1e6, 1.0, linear},
    {"presliding", "m", "travel in which the friction builds up", 1e-9, 1e3, 1e-2,
     KERF_SEARCHED | KERF_LOGARITHMIC}};

/// Its description, by this name; with derivatives of its own or without.
inline kerf_law_v1 described(const char* name, bool with_derivatives) {
  kerf_law_v1 law{};
  law.abi = KERF_LAW_ABI;
  law.size = sizeof(kerf_law_v1);
  law.name = name;
  law.equation = "F = F0 + k x + b v + Fc z";
  law.parameters = parameters;
  law.parameter_count = 5;
  law.tells = KERF_TELLS_LOOP | KERF_TELLS_RATE;
  law.state_size = sizeof(State);
  law.state_alignment = alignof(State);
  law.step = step;
  if (with_derivatives) {
    law.derivatives_state_size = sizeof(DualState);
    law.derivatives_state_alignment = alignof(DualState);
    law.step_derivatives = step_derivatives;
  }
  return law;
}

}  // namespace foreign_friction
}  // namespace kerf::test
