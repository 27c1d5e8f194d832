/* plugin FOLDER: laws of the test's plug-ins in the library, as a program in C99 has them. Says what does not
 * hold. */
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Both in one source: a host may bring a law of its own. */
#include <kerf/kerf.h>
#include <kerf/law.h>

static const char* folder;
static char error[512];
static int failures = 0;

static void expect(int holds, const char* what) {
  if (holds) return;
  printf("does not hold: %s; the last error is '%s'\n", what, error);
  ++failures;
}

static int says(const char* words) { return strstr(error, words) != NULL; }

static kerf_status load(const char* name, const char** model) {
  char path[1024];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return kerf_plugin_load(path, model, error, sizeof error);
}

static kerf_law* parsed(const char* text) {
  kerf_law* law;
  kerf_law_parse(text, strlen(text), "own.law.toml", &law, error, sizeof error);
  return law;
}

static kerf_law* made(const char* model, const kerf_value* values, size_t count) {
  kerf_law* law;
  kerf_law_make(model, values, count, NULL, 0, &law, error, sizeof error);
  return law;
}

static kerf_state* state_of(const kerf_law* law) {
  kerf_state* state = NULL;
  if (law != NULL) kerf_state_create(law, &state, error, sizeof error);
  return state;
}

static const kerf_value spring[] = {
    {"offset", 0.1}, {"stiffness", 300.0}, {"viscosity", 2.0}, {"coulomb", 0.5}, {"presliding", 2e-4}};
/* As a fit would have left it, with another content of the plug-in. */
static const char of_another_content[] =
    "model = \"coulomb_spring\"\n"
    "[parameters]\n"
    "offset = { value = 0, unit = \"N\" }\n"
    "stiffness = { value = 300, unit = \"N/m\" }\n"
    "viscosity = { value = 2, unit = \"N*s/m\" }\n"
    "coulomb = { value = 0.5, unit = \"N\" }\n"
    "presliding = { value = 0.2, unit = \"mm\" }\n"
    "[plugin]\n"
    "name = \"coulomb_spring.so\"\n"
    "sha256 = \"0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef\"\n";

static void is_asked_for_by_the_call_that_loads_it(void) {
  expect(parsed(of_another_content) == NULL, "a law of a plug-in is not opened without it");
  expect(says("own.law.toml:8: ") && says("kerf_plugin_load() of PATH/coulomb_spring.so"),
         "the refusal names file, line, call and plug-in");
}

static void refuses_what_is_none(void) {
  const char* model = "";
  expect(load("missing.so", &model) == KERF_BAD_INPUT && model == NULL && says("missing.so: no such file"),
         "a file that is not there is bad input");
  expect(load("no_law.so", NULL) == KERF_BAD_INPUT && says("exports no kerf_plugin_law()"),
         "a shared object without a law is bad input");
  expect(load("moody_other_version.so", NULL) == KERF_BAD_INPUT && says("version 2 of kerf/law.h"),
         "a plug-in of another version is bad input");
  expect(kerf_plugin_load(NULL, NULL, error, sizeof error) == KERF_BAD_INPUT, "no path is bad input");
}

/* In and out, as the law of the house that says the same does. */
static void steps_as_the_house_does(void) {
  kerf_law* own = made("coulomb_spring", spring, 5);
  kerf_law* house = made("friction", spring, 5);
  kerf_state* of_own = state_of(own);
  kerf_state* of_house = state_of(house);
  kerf_law* again = own == NULL ? NULL : parsed(kerf_law_text(own));
  int tick;
  expect(of_own != NULL && of_house != NULL, "both laws are made by name");
  expect(again != NULL, "its text names the plug-in that is loaded");
  for (tick = 0; of_own != NULL && of_house != NULL && tick < 1000; ++tick) {
    const double phase = 0.02 * tick;
    double forces[2];
    uint32_t flags = kerf_step(of_own, 0.01 * sin(phase), 0.2 * cos(phase), 1e-3, &forces[0]);
    flags |= kerf_step(of_house, 0.01 * sin(phase), 0.2 * cos(phase), 1e-3, &forces[1]);
    if (flags == 0 && fabs(forces[0] - forces[1]) < 1e-12) continue;
    expect(0, "the plug-in gives what 'friction' gives");
    break;
  }
  kerf_state_destroy(of_own);
  kerf_state_destroy(of_house);
  kerf_law_close(own);
  kerf_law_close(house);
  kerf_law_close(again);
}

static void is_known_by_name_once_it_is_loaded(void) {
  const size_t count = kerf_model_count();
  const char* model = NULL;
  const char* again = NULL;
  expect(load("coulomb_spring.so", &model) == KERF_OK && strcmp(model, "coulomb_spring") == 0,
         "it is loaded");
  expect(load("coulomb_spring.so", &again) == KERF_OK && again == model, "twice is once");
  expect(kerf_model_count() == count + 1 && kerf_model_name(count) == model &&
             kerf_model_name(count + 1) == NULL,
         "it follows the models of the library");
  expect(parsed(of_another_content) == NULL && says("SHA-256 0123456789ab") && says("load the one"),
         "a law that was made with another content is refused");
}

static void is_a_fault_where_it_breaks(double mood) {
  const kerf_value values[] = {{"stiffness", 100.0}, {"mood", mood}};
  kerf_law* law = made("moody", values, 2);
  kerf_state* state = state_of(law);
  double force = 1.0;
  expect(state != NULL, "a law that breaks later is made");
  if (state == NULL) return;
  expect(kerf_step_depth(state, 0.001, 0.0, 1e-3, &force) == 0 && force == 0.1, "it is well before");
  expect(kerf_step_depth(state, 0.003, 0.0, 1e-3, &force) == KERF_LAW_FAULT && force == 0.0,
         "where it breaks the force is zero");
  kerf_state_destroy(state);
  kerf_law_close(law);
}

/* Whether the force along each axis is that of its own position and velocity, and none is written beyond. */
static void steps_each_axis(kerf_state* state, int axes, const double* velocity, const double* seen) {
  static const double position[KERF_MAX_AXES] = {0.01, 0.02, -0.03, 0.04, 0.05, -0.06};
  double force[KERF_MAX_AXES + 1];
  int axis;
  for (axis = 0; axis <= KERF_MAX_AXES; ++axis) force[axis] = 7.0;
  expect(kerf_step_axes(state, position, velocity, 1e-3, force) == 0, "a law in space is stepped");
  for (axis = 0; axis < axes; ++axis)
    expect(force[axis] == -100.0 * (axis + 1) * position[axis] - (axis + 1) * seen[axis],
           "an axis feels its own position and velocity");
  for (; axis <= KERF_MAX_AXES; ++axis) expect(force[axis] == 7.0, "what is not the law's is left alone");
}

static void goes_along_as_many_axes_as_it_has(int axes) {
  static const double none[KERF_MAX_AXES] = {0.0};
  static const double told[KERF_MAX_AXES] = {1.0, -2.0, 3.0, 4.0, -5.0, 6.0};
  const kerf_value stiffness = {"stiffness", 100.0};
  double some[KERF_MAX_AXES];
  double seen[KERF_MAX_AXES];
  char name[32];
  int lacking;
  snprintf(name, sizeof name, "axes_%d.so", axes);
  expect(load(name, NULL) == KERF_OK, "a law in space is loaded");
  name[6] = '\0';
  for (lacking = 0; lacking < axes; ++lacking) {
    kerf_law* law = made(name, &stiffness, 1);
    kerf_state* state = state_of(law);
    expect(state != NULL, "a law in space is made");
    if (state == NULL) return;
    memcpy(some, told, sizeof some);
    memcpy(seen, told, sizeof seen);
    some[lacking] = KERF_NONE;
    seen[lacking] = 0.0; /* of the first step */
    steps_each_axis(state, axes, some, seen);
    kerf_state_reset(state);
    steps_each_axis(state, axes, NULL, none);
    steps_each_axis(state, axes, told, told);
    kerf_state_destroy(state);
    kerf_law_close(law);
  }
}

int main(int argc, char** argv) {
  int axes;
  if (argc != 2) return 2;
  folder = argv[1];
  is_asked_for_by_the_call_that_loads_it();
  refuses_what_is_none();
  is_known_by_name_once_it_is_loaded();
  steps_as_the_house_does();
  expect(load("moody.so", NULL) == KERF_OK, "the name is not asked for");
  is_a_fault_where_it_breaks(1.0); /* no number */
  is_a_fault_where_it_breaks(6.0); /* throws */
  is_a_fault_where_it_breaks(7.0); /* writes behind its state */
  for (axes = 1; axes <= KERF_MAX_AXES; ++axes) goes_along_as_many_axes_as_it_has(axes);
  return failures == 0 ? 0 : 1;
}
