/* What libkerf.so.1 promises: every function with its signature, every structure with its layout, every
 * number. What stands here is not changed, but for lines that are added; what no longer compiles is another
 * ABI. C99. */
#include <stddef.h>
#include <stdio.h>

#include <kerf/kerf.h>

/* Each function as a program that was built against the first version calls it. */
static uint32_t (*const abi_version)(void) = kerf_abi_version;
static const char* (*const version)(void) = kerf_version;
static const char* (*const software)(void) = kerf_software;
static const char* (*const status_text)(int32_t) = kerf_status_text;
static const char* (*const flag_text)(uint32_t) = kerf_flag_text;
static double (*const none)(void) = kerf_none;
static size_t (*const model_count)(void) = kerf_model_count;
static const char* (*const model_name)(size_t) = kerf_model_name;
static int32_t (*const law_open)(const char*, kerf_law**, char*, size_t) = kerf_law_open;
static int32_t (*const law_parse)(const char*, size_t, const char*, kerf_law**, char*,
                                  size_t) = kerf_law_parse;
static int32_t (*const law_make)(const char*, const kerf_value*, size_t, const kerf_option*, size_t,
                                 kerf_law**, char*, size_t) = kerf_law_make;
static void (*const law_close)(kerf_law*) = kerf_law_close;
static const char* (*const law_texts[])(const kerf_law*) = {kerf_law_model, kerf_law_equation, kerf_law_text,
                                                            kerf_law_sha256};
static size_t (*const law_counts[])(const kerf_law*) = {kerf_law_axis_count, kerf_law_parameter_count};
static int32_t (*const law_axis)(const kerf_law*, size_t, kerf_axis*) = kerf_law_axis;
static int32_t (*const law_is_spatial)(const kerf_law*) = kerf_law_is_spatial;
static kerf_contact (*const law_contact)(const kerf_law*) = kerf_law_contact;
static int32_t (*const law_parameter)(const kerf_law*, size_t, kerf_parameter*) = kerf_law_parameter;
static size_t (*const law_option_count)(const kerf_law*) = kerf_law_option_count;
static int32_t (*const law_option)(const kerf_law*, size_t, kerf_option_info*) = kerf_law_option;
static int32_t (*const plugin_load)(const char*, const char**, char*, size_t) = kerf_plugin_load;
static int32_t (*const state_create)(const kerf_law*, kerf_state**, char*, size_t) = kerf_state_create;
static int32_t (*const state_copy)(const kerf_state*, kerf_state**, char*, size_t) = kerf_state_copy;
static int32_t (*const state_assign)(kerf_state*, const kerf_state*) = kerf_state_assign;
static void (*const state_ends[])(kerf_state*) = {kerf_state_destroy, kerf_state_reset};
static double (*const state_energy)(const kerf_state*) = kerf_state_energy;
static uint32_t (*const steps[])(kerf_state*, double, double, double, double*) = {kerf_step, kerf_step_depth};
static uint32_t (*const step_axes)(kerf_state*, const double*, const double*, double,
                                   double*) = kerf_step_axes;
static int32_t (*const safety_create)(const kerf_law*, const kerf_limits*, const kerf_safety_options*,
                                      kerf_safety**, char*, size_t) = kerf_safety_create;
static void (*const safety_ends[])(kerf_safety*) = {kerf_safety_destroy, kerf_safety_reset,
                                                    kerf_safety_confirm};
static uint32_t (*const step_safely)(kerf_safety*, kerf_state*, const double*, const double*, double,
                                     double*) = kerf_step_safely;
static uint32_t (*const safety_judge)(kerf_safety*, const double*, const double*, double) = kerf_safety_judge;
static uint32_t (*const safety_apply)(kerf_safety*, uint32_t, double*) = kerf_safety_apply;

/* An array of -1 members does not compile. */
#define HOLDS(name, condition) typedef char name[(condition) ? 1 : -1]
HOLDS(numbers_of_statuses, KERF_OK == 0 && KERF_BAD_INPUT == 2 && KERF_SYSTEM == 4);
HOLDS(numbers_of_flags, KERF_FORCE_LIMITED == 0x2 && KERF_SLEW_LIMITED == 0x4 && KERF_SOFT_START == 0x8 &&
                            KERF_LAW_FAULT == 0x10 && KERF_DEVICE_FAULT == 0x20 &&
                            KERF_POSITION_JUMP == 0x100 && KERF_WATCHDOG == 0x200 &&
                            KERF_ZERO_HELD == 0x1000);
HOLDS(numbers_of_options, KERF_OPTION_FLAG == 0 && KERF_OPTION_NUMBER == 1 && KERF_OPTION_TEXT == 2);
HOLDS(number_of_axes, KERF_MAX_AXES == 6 && KERF_ABI_VERSION == 1);
#define IN_WORDS(words) ((words) * sizeof(double))
HOLDS(words_are_pointers, sizeof(double) == sizeof(char*));
HOLDS(layout_of_value, sizeof(kerf_value) == IN_WORDS(2) && offsetof(kerf_value, value) == IN_WORDS(1));
HOLDS(layout_of_option, sizeof(kerf_option) == IN_WORDS(4) && offsetof(kerf_option, kind) == IN_WORDS(1) &&
                            offsetof(kerf_option, number) == IN_WORDS(2) &&
                            offsetof(kerf_option, text) == IN_WORDS(3));
HOLDS(layout_of_axis, sizeof(kerf_axis) == IN_WORDS(3) && offsetof(kerf_axis, position_unit) == IN_WORDS(1) &&
                          offsetof(kerf_axis, force_unit) == IN_WORDS(2));
HOLDS(layout_of_contact,
      sizeof(kerf_contact) == IN_WORDS(2) && offsetof(kerf_contact, direction) == IN_WORDS(1));
HOLDS(layout_of_parameter,
      sizeof(kerf_parameter) == IN_WORDS(7) && offsetof(kerf_parameter, unit) == IN_WORDS(1) &&
          offsetof(kerf_parameter, meaning) == IN_WORDS(2) &&
          offsetof(kerf_parameter, value) == IN_WORDS(3) && offsetof(kerf_parameter, lower) == IN_WORDS(4) &&
          offsetof(kerf_parameter, upper) == IN_WORDS(5) &&
          offsetof(kerf_parameter, std_error) == IN_WORDS(6));
HOLDS(layout_of_option_info, sizeof(kerf_option_info) == IN_WORDS(9) &&
                                 offsetof(kerf_option_info, value) == IN_WORDS(1) &&
                                 offsetof(kerf_option_info, standard) == IN_WORDS(5));
HOLDS(layout_of_limits, sizeof(kerf_limits) == IN_WORDS(5) && offsetof(kerf_limits, slew) == IN_WORDS(1) &&
                            offsetof(kerf_limits, speed) == IN_WORDS(2) &&
                            offsetof(kerf_limits, acceleration) == IN_WORDS(3) &&
                            offsetof(kerf_limits, resolution) == IN_WORDS(4));
HOLDS(layout_of_safety_options, sizeof(kerf_safety_options) == IN_WORDS(4) &&
                                    offsetof(kerf_safety_options, soft_start_s) == IN_WORDS(1) &&
                                    offsetof(kerf_safety_options, stall_s) == IN_WORDS(2) &&
                                    offsetof(kerf_safety_options, report_s) == IN_WORDS(3));

int main(void) {
  const void* const unused[] = {
      &version,      &software,     &status_text,    &flag_text,        &none,
      &model_name,   &law_open,     &law_parse,      &law_make,         &law_close,
      law_texts,     law_counts,    &law_axis,       &law_contact,      &law_parameter,
      &state_create, &state_copy,   &state_assign,   state_ends,        &state_energy,
      steps,         &step_axes,    &safety_create,  safety_ends,       &step_safely,
      &safety_judge, &safety_apply, &law_is_spatial, &law_option_count, &law_option,
      &plugin_load};
  printf("%u functions in tables, %u models\n", (unsigned)(sizeof unused / sizeof unused[0]),
         (unsigned)model_count());
  return abi_version() == KERF_ABI_VERSION ? 0 : 1;
}
