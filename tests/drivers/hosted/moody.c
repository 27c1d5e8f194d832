/* A device without a wire that does on demand what none should: option mood=..., from its 200th reading on
   where that is something of read(). Position is a micrometre a reading, channel `count` its number, force
   measured is minus that of the last write(). Each call but read() is a line of the file `log`: process,
   what, number. */
#define _DEFAULT_SOURCE
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <kerf/device.h>

static const char* const options[] = {"mood", "log", NULL};
enum { well = 200 }; /* readings */

struct device {
  char mood[32];
  int log;
  unsigned long long count;
  double force;
};

static void note(const struct device* device, const char* what, double number) {
  char line[128];
  const int size = snprintf(line, sizeof line, "%d %s %g\n", (int)getpid(), what, number);
  if (device->log >= 0 && write(device->log, line, (size_t)size) < 0) abort();
}

static int is(const struct device* device, const char* mood) { return strcmp(device->mood, mood) == 0; }

static void pause_ms(long ms) {
  const struct timespec time = {ms / 1000, ms % 1000 * 1000000};
  nanosleep(&time, NULL);
}

static void misbehave(const struct device* device, const char* where) {
  char mood[64];
  const char* const kinds[] = {"crash", "hang", "exit", "abort"};
  for (int kind = 0; kind < 4; ++kind) {
    snprintf(mood, sizeof mood, "%s_%s", kinds[kind], where);
    if (!is(device, mood)) continue;
    if (kind == 0) *(volatile int*)NULL = 1;
    if (kind == 1) pause_ms(3600000);
    if (kind == 2) exit(7);
    if (kind == 3) abort();
  }
}

static void* open_device(const char* const* values, char* why, size_t why_size) {
  struct device* const device = calloc(1, sizeof *device);
  snprintf(device->mood, sizeof device->mood, "%s", values[0] ? values[0] : "well");
  device->log = values[1] ? open(values[1], O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600) : -1;
  note(device, "open", 0.0);
  misbehave(device, "open");
  if (is(device, "refuse")) snprintf(why, why_size, "there is no board; plug it\nin");
  if (is(device, "refuse") || is(device, "refuse_silently")) return NULL;
  if (is(device, "slow_open")) pause_ms(2200);
  return device;
}

static void describe(void* self, kerf_device_facts_v1* facts) {
  const struct device* const device = self;
  snprintf(facts->model, sizeof facts->model, "moody");
  snprintf(facts->serial, sizeof facts->serial, "M1");
  snprintf(facts->settings, sizeof facts->settings, "%s", is(device, "no_toml") ? "gain = " : "gain = 2");
  facts->flags = KERF_MEASURES_FORCE | KERF_COUNTS_READINGS;
  if (is(device, "any_time") || is(device, "hang_write_any_time")) facts->flags |= KERF_WRITES_ANY_TIME;
  if (is(device, "at_once")) facts->flags |= KERF_ANSWERS_AT_ONCE;
  if (is(device, "unpaced")) facts->flags |= KERF_ANSWERS_AT_ONCE;
  facts->rate_hz = is(device, "unpaced") ? 0.0 : 1000.0;
  facts->count_modulus = 256;
  facts->axis_count = is(device, "seven_axes") ? 7 : 1;
  facts->axes[0] = (kerf_device_axis_v1){.name = "x",
                                         .position_unit = "m",
                                         .force_unit = "N",
                                         .resolution = 1e-6,
                                         .lower = -1.0,
                                         .upper = 1.0,
                                         .force_limit = 5.0,
                                         .slew_limit = 2000.0,
                                         .acceleration_limit = 200.0};
  if (is(device, "about_an_angle")) strcpy(facts->axes[0].position_unit, "rad");
  if (is(device, "degrees")) strcpy(facts->axes[0].position_unit, "deg");
  if (is(device, "no_range")) facts->axes[0].upper = -1.0;
  if (is(device, "no_limit")) facts->axes[0].force_limit = 0.0;
  if (is(device, "no_zero")) memset(facts->model, 'm', sizeof facts->model);
  facts->channel_count = 1;
  snprintf(facts->channels[0].name, sizeof facts->channels[0].name, "%s",
           is(device, "our_channel") ? "report_age" : "count");
  misbehave(device, "describe");
}

static int read_device(void* self, kerf_device_reading_v1* reading) {
  struct device* const device = self;
  if (!is(device, "at_once")) pause_ms(1);
  if (is(device, "nothing")) return 0;
  ++device->count;
  if (device->count > well) {
    misbehave(device, "read");
    if (is(device, "lost")) return -1;
    if (is(device, "silent")) return 0;
    if (is(device, "doubts")) reading->flags |= KERF_DOUBTED;
    if (is(device, "gap") && device->count == well + 1) device->count += 10;
  }
  reading->position[0] = is(device, "no_number") && device->count > well ? NAN : 1e-6 * (double)device->count;
  reading->force[0] = -device->force;
  reading->channels[0] = (double)device->count;
  reading->number = device->count % 256;
  if (is(device, "from_the_future")) reading->taken_ns = 1LL << 62;
  return 1;
}

static int write_device(void* self, const double* force) {
  struct device* const device = self;
  note(device, "write", force[0]);
  if (force[0] != 0.0) misbehave(device, "write");
  if (force[0] != 0.0) misbehave(device, "write_any_time");
  if (is(device, "takes_none")) return 1;
  device->force = force[0];
  return 0;
}

static void release(void* self) { note(self, "release", 0.0); }

static void close_device(void* self) {
  note(self, "close", 0.0);
  free(self);
}

static const kerf_device_v1 description = {.abi = KERF_DEVICE_ABI,
                                           .size = sizeof description,
                                           .name = "moody",
                                           .about = "for tests",
                                           .options = options,
                                           .open_s = 3.0,
                                           .open = open_device,
                                           .describe = describe,
                                           .read = read_device,
                                           .write = write_device,
                                           .release = release,
                                           .close = close_device};

const kerf_device_v1* kerf_plugin_device(void) { return &description; }
