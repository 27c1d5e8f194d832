/* A spring that crashes some time after its first step: in a loop, and not in its trial. */
#include <stdlib.h>

#include <kerf/law.h>

static void step(const double* p, void* state, const double* position, const double* velocity, double dt,
                 double* force) {
  double* const elapsed = state;
  (void)velocity;
  *force = p[0] * (*position > 0.0 ? *position : 0.0);
  *elapsed += dt;
  if (*elapsed > p[1]) abort();
}

static const kerf_law_parameter_v1 parameters[] = {
    {"stiffness", "N/m", "of a spring", 0.0, 1e6, 400.0, KERF_SEARCHED | KERF_LINEAR},
    {"life", "s", "after which it crashes", 0.0, 1e9, 1e9, 0}};

KERF_LAW_EXPORT const kerf_law_v1* kerf_plugin_law(void) {
  static kerf_law_v1 law = {KERF_LAW_ABI,
                            sizeof(kerf_law_v1),
                            "late_crash",
                            "F = k x, for a while",
                            NULL,
                            NULL,
                            parameters,
                            NULL,
                            2,
                            0,
                            0,
                            0,
                            sizeof(double),
                            sizeof(double),
                            NULL,
                            step,
                            NULL,
                            0,
                            0,
                            NULL,
                            NULL};
  return &law;
}
