/* What is wrong before anything is opened: WRONG says what. */
#include <stddef.h>

#include <kerf/device.h>

static void* open_device(const char* const* values, char* why, size_t why_size) {
  (void)values;
  (void)why;
  (void)why_size;
  return NULL;
}
static void describe(void* device, kerf_device_facts_v1* facts) {
  (void)device;
  (void)facts;
}
static int read_device(void* device, kerf_device_reading_v1* reading) {
  (void)device;
  (void)reading;
  return 0;
}
static int write_device(void* device, const double* force) {
  (void)device;
  (void)force;
  return 0;
}
static void close_device(void* device) { (void)device; }

enum { other_version = 1, no_release, no_name, nothing };

static const kerf_device_v1 description = {.abi = WRONG == other_version ? 2u : KERF_DEVICE_ABI,
                                           .size = sizeof description,
                                           .name = WRONG == no_name ? NULL : "wrong",
                                           .open = open_device,
                                           .describe = describe,
                                           .read = read_device,
                                           .write = write_device,
                                           .close = close_device};

const kerf_device_v1* kerf_plugin_device(void) { return WRONG == nothing ? NULL : &description; }
