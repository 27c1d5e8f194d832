/* Drives an FMU as FMI 3.0 Co-Simulation has it: a step for each sample of the standard input, its force to the standard
 * output. See verify/host_program.h for the samples.
 *     importer LIBRARY TOKEN REFERENCE_OF_POSITION REFERENCE_OF_VELOCITY REFERENCE_OF_FORCE */
#include <dlfcn.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

typedef void* instance;
typedef void (*log_message)(void* environment, int status, const char* category, const char* message);
typedef instance (*instantiate_function)(const char* name, const char* token, const char* resources, bool visible,
                                         bool logging, bool event_mode, bool early_return, const uint32_t required[],
                                         size_t required_count, void* environment, log_message log, void* update);
typedef int (*initialize_function)(instance, bool tolerance_defined, double tolerance, double start, bool stop_defined,
                                   double stop);
typedef int (*plain_function)(instance);
typedef void (*free_function)(instance);
typedef int (*get_function)(instance, const uint32_t references[], size_t count, double values[], size_t value_count);
typedef int (*set_function)(instance, const uint32_t references[], size_t count, const double values[],
                            size_t value_count);
typedef int (*step_function)(instance, double point, double size, bool no_way_back, bool* event, bool* terminate,
                             bool* early, double* last);
typedef int (*save_function)(instance, void** state);
typedef int (*restore_function)(instance, void* state);

static void say(void* environment, int status, const char* category, const char* message) {
  (void)environment, (void)status, (void)category;
  fprintf(stderr, "%s\n", message);
}

static void* library;
static void* function(const char* name) {
  void* found = dlsym(library, name);
  if (found == NULL) {
    fprintf(stderr, "the FMU has no %s\n", name);
    exit(1);
  }
  return found;
}

static void demand(int status, const char* what) {
  if (status == 0) return;
  fprintf(stderr, "%s gave the status %d\n", what, status);
  exit(1);
}

int main(int count, char** words) {
  double sample[3], time = 0.0;
  void* before = NULL;
  if (count != 6) return 2;
  library = dlopen(words[1], RTLD_NOW | RTLD_LOCAL);
  if (library == NULL) {
    fprintf(stderr, "%s\n", dlerror());
    return 1;
  }
  const uint32_t inputs[2] = {(uint32_t)atoi(words[3]), (uint32_t)atoi(words[4])};
  const uint32_t output[1] = {(uint32_t)atoi(words[5])};
  instantiate_function instantiate = (instantiate_function)function("fmi3InstantiateCoSimulation");
  initialize_function initialize = (initialize_function)function("fmi3EnterInitializationMode");
  plain_function initialized = (plain_function)function("fmi3ExitInitializationMode");
  set_function set = (set_function)function("fmi3SetFloat64");
  get_function get = (get_function)function("fmi3GetFloat64");
  step_function step = (step_function)function("fmi3DoStep");
  save_function save = (save_function)function("fmi3GetFMUState");
  save_function forget = (save_function)function("fmi3FreeFMUState");
  restore_function restore = (restore_function)function("fmi3SetFMUState");
  plain_function terminate = (plain_function)function("fmi3Terminate");
  free_function let_go = (free_function)function("fmi3FreeInstance");

  instance fmu = instantiate("verify", words[2], NULL, false, true, false, false, NULL, 0, NULL, say, NULL);
  if (fmu == NULL) return 1;
  demand(initialize(fmu, false, 0.0, time, false, 0.0), "fmi3EnterInitializationMode");
  demand(initialized(fmu), "fmi3ExitInitializationMode");
  while (fread(sample, sizeof sample, 1, stdin) == 1) {
    bool event = true, end = true, early = true;
    double force = NAN, last = -1.0;
    demand(save(fmu, &before), "fmi3GetFMUState");
    if (set(fmu, inputs, 2, sample, 2) == 0 &&
        step(fmu, time, sample[2], true, &event, &end, &early, &last) == 0 && !event && !end && !early &&
        get(fmu, output, 1, &force, 1) == 0) {
      time = last;
    } else { /* a fault: as if the tick had not been */
      force = NAN;
      demand(restore(fmu, before), "fmi3SetFMUState");
    }
    if (fwrite(&force, sizeof force, 1, stdout) != 1) return 1;
  }
  demand(forget(fmu, &before), "fmi3FreeFMUState");
  demand(terminate(fmu), "fmi3Terminate");
  let_go(fmu);
  return fflush(stdout) == 0 ? 0 : 1;
}
