/* Springs and dampers along as many axes as it is compiled for, each with a stiffness of its own: what is
 * told of one axis and reaches another is seen. */
#include <kerf/law.h>

static void step(const double* p, void* state, const double* position, const double* velocity, double dt,
                 double* force) {
  int axis;
  (void)state;
  (void)dt;
  for (axis = 0; axis < KERF_TEST_AXES; ++axis)
    force[axis] = -p[0] * (axis + 1) * position[axis] - (axis + 1) * velocity[axis];
}

static const kerf_law_parameter_v1 parameters[] = {
    {"stiffness", "N/m", "of the spring along the first axis", 0.0, 1e6, 100.0, KERF_SEARCHED}};
static const kerf_law_axis_v1 axes[] = {{"x", "m", "N"}, {"y", "m", "N"}, {"z", "m", "N"},
                                        {"u", "m", "N"}, {"v", "m", "N"}, {"w", "m", "N"}};
static const char* const names[] = {"axes_1", "axes_2", "axes_3", "axes_4", "axes_5", "axes_6"};

KERF_LAW_EXPORT const kerf_law_v1* kerf_plugin_law(void) {
  static kerf_law_v1 law;
  law.abi = KERF_LAW_ABI;
  law.size = sizeof law;
  law.name = names[KERF_TEST_AXES - 1];
  law.equation = "F = -k x - c v";
  law.parameters = parameters;
  law.axes = axes;
  law.parameter_count = 1;
  law.axis_count = KERF_TEST_AXES;
  law.step = step;
  return &law;
}
