/* Spring, viscosity and Coulomb friction that builds up over a travel (Dahl), as a lab would write it in C99:
   what kerf::models::Friction is. */
#include <math.h>

#include <kerf/law.h>

struct state {
  double slip;
  double position;
  double started;
};

static void step(const double* p, void* memory, const double* position, const double* velocity, double dt,
                 double* force) {
  struct state* state = memory;
  double travel;
  (void)dt;
  if (state->started == 0.0) {
    state->started = 1.0;
    state->position = *position;
  }
  travel = *position - state->position;
  state->position = *position;
  if (travel != 0.0) {
    const double sign = travel > 0.0 ? 1.0 : -1.0;
    state->slip = sign + (state->slip - sign) * exp(-fabs(travel) / p[4]);
  }
  *force = p[0] + p[1] * *position + p[2] * *velocity + p[3] * state->slip;
}

static const kerf_law_parameter_v1 parameters[] = {
    {"offset", "N", "force at zero and at rest", -1e6, 1e6, 0.0, KERF_SEARCHED | KERF_LINEAR},
    {"stiffness", "N/m", "force per position", -1e9, 1e9, 100.0, KERF_SEARCHED | KERF_LINEAR},
    {"viscosity", "N*s/m", "force per speed", -1e6, 1e6, 0.0, KERF_SEARCHED | KERF_LINEAR},
    {"coulomb", "N", "dry friction", 0.0, 1e6, 0.2, KERF_SEARCHED | KERF_LINEAR},
    {"presliding", "m", "travel in which the friction builds up", 1e-9, 1e3, 1e-3,
     KERF_SEARCHED | KERF_LOGARITHMIC}};

KERF_LAW_EXPORT const kerf_law_v1* kerf_plugin_law(void) {
  static kerf_law_v1 law = {KERF_LAW_ABI, sizeof(kerf_law_v1), "coulomb_spring", "F = F0 + k x + b v + Fc z",
                            NULL, NULL, parameters, NULL, 5, 0, KERF_TELLS_LOOP | KERF_TELLS_RATE, 0,
                            sizeof(struct state), sizeof(double), NULL, step, NULL, 0, 0, NULL, NULL};
  return &law;
}
