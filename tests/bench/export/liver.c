/* A stand-in for what `kerf export --as c` writes: a Kelvin element with state. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#ifndef LIVER_API
#define LIVER_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef struct liver_state { // NOLINT(readability-identifier-naming): C
  double arm_force, last_penetration;
  int started;
} liver_state;

LIVER_API void liver_reset(liver_state* state) { memset(state, 0, sizeof *state); }

LIVER_API int liver_step_depth(liver_state* state, double penetration, double velocity, double elapsed_s,
                               double* force) {
  const double k1 = 8.0, k2 = 7.0, b = 130.0;
  const double decay = exp(-elapsed_s * k2 / b);
  double depth, arm, total;
  *force = 0.0;
  if (!isfinite(penetration) || !isfinite(velocity) || !isfinite(elapsed_s) || elapsed_s <= 0.0) return 1;
  depth = penetration > 0.0 ? penetration : 0.0;
  arm = state->arm_force * decay;
  if (state->started) arm += b * (depth - state->last_penetration) / elapsed_s * (1.0 - decay);
  total = k1 * depth + arm;
  state->arm_force = arm;
  state->last_penetration = depth;
  state->started = 1;
  if (!isfinite(total)) return 1; /* the state is of no use after that, which the hosts have to mind */
  if (penetration > 0.0 && total > 0.0) *force = total;
  return 0;
}

LIVER_API int liver_step(liver_state* state, double position, double velocity, double elapsed_s, double* force) {
  const int fault = liver_step_depth(state, -(position - 0.5), -velocity, elapsed_s, force);
  return fault;
}

LIVER_API size_t liver_state_size(void) { return sizeof(liver_state); }

LIVER_API const char* liver_describe(void) {
  return "{\"law\": \"liver.law.toml\", \"model\": \"kelvin\", \"equation\": \"F = k1 x + f, 'exact' \\\"\\\"\\\"\", "
         "\"parameters\": [{\"name\": \"parallel_stiffness\", \"value\": 8, \"unit\": \"N\xc2\xb7s/rad\"}]}";
}

#ifdef __cplusplus
}
#endif
