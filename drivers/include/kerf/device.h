#ifndef KERF_DEVICE_H
#define KERF_DEVICE_H

/*
 * A device, or a force sensor, of your own as a shared object, in C99 (docs/own-device.md).
 *
 * It exports one function, kerf_plugin_device(), which returns a description that never changes. Everything
 * is in SI: m or rad, N or N·m, s. A force is positive where it pushes the position up; a measured force is
 * what the tissue exerts, in the same sense.
 *
 * All of it runs in a process of its own, kerf-device-host, which outlives the program that renders: it lets
 * the device go when that program dies, hangs or says nothing for 50 ms. read() and write() are called in
 * turns by one thread; they may wait, allocate and lock. What crashes or does not come back ends the run, is
 * named, and the device is let go by release(), in a copy of the process that was made after describe().
 */

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What this header describes. */
#define KERF_DEVICE_ABI 1u
#define KERF_DEVICE_AXES 6
#define KERF_DEVICE_CHANNELS 8

typedef struct kerf_device_axis_v1 {
  char name[32];         /* "x", "theta", ...: a-z, 0-9 and _, first a letter */
  char position_unit[8]; /* "m" or "rad" */
  char force_unit[8];    /* "N" or "N·m" (or N*m) */
  double lever; /* travel of where the force acts per unit of position; 0: 1, of m with N, rad with N·m */
  double resolution;         /* step of the encoder, in the unit of position */
  double lower, upper;       /* range of motion */
  double force_limit;        /* largest force that may be commanded; with write() above 0 */
  double slew_limit;         /* largest change of force per second; with write() above 0 */
  double speed_limit;        /* faster than hand and mechanism can be; 0: not known */
  double acceleration_limit; /* its speed cannot grow faster; 0: not known, and a turned bit goes unseen */
} kerf_device_axis_v1;

/* Flags of a channel. */
#define KERF_CHANNEL_BUTTON 1u /* not 0 while a person presses a button of the device; of one channel */

/* A further quantity that is recorded. */
typedef struct kerf_device_channel_v1 {
  char name[32];
  char unit[16];
  uint32_t flags;
} kerf_device_channel_v1;

/* Flags of a device. */
#define KERF_MEASURES_FORCE 1u /* readings have the force of each axis */
#define KERF_TELLS_VELOCITY 2u /* readings have the velocity; without it Kerf takes differences */
#define KERF_FORCE_SENSOR \
  4u /* no axes: `force` of readings is fx, fy, fz, tx, ty, tz, and there is no write() */
#define KERF_COUNTS_READINGS 8u  /* readings have the device's own count, and what is missing is told */
#define KERF_ANSWERS_AT_ONCE 16u /* read() waits for nothing: it is called rate_hz times a second */
#define KERF_WRITES_ANY_TIME \
  32u /* write() and release() may be called from another thread while read() waits */

typedef struct kerf_device_facts_v1 {
  char model[96];  /* required */
  char about[96];  /* one line */
  char serial[64]; /* empty: it has none */
  kerf_device_axis_v1 axes[KERF_DEVICE_AXES];
  kerf_device_channel_v1 channels[KERF_DEVICE_CHANNELS];
  uint32_t axis_count; /* 1 to 6; 0 of a force sensor */
  uint32_t channel_count;
  uint32_t flags;         /* KERF_... */
  uint32_t reserved;      /* 0 */
  double rate_hz;         /* readings a second; 0: not known */
  double jitter_s;        /* by how much `taken_ns` may be wrong */
  uint64_t count_modulus; /* `number` begins again at 0 after so many; 0: never */
  char settings[1024];    /* what it runs with, as TOML, for the recording */
} kerf_device_facts_v1;

/* Flags of a reading. */
#define KERF_NO_FORCE 1u   /* the measured force is none now, and nothing is wrong */
#define KERF_OVERLOADED 2u /* the force sensor is overloaded: its force is none */
#define KERF_DOUBTED 4u    /* the device doubts this reading: a fault of it */

typedef struct kerf_device_reading_v1 {
  double position[KERF_DEVICE_AXES];
  double velocity[KERF_DEVICE_AXES]; /* with KERF_TELLS_VELOCITY */
  double force[KERF_DEVICE_AXES];    /* with KERF_MEASURES_FORCE or KERF_FORCE_SENSOR */
  double channels[KERF_DEVICE_CHANNELS];
  int64_t taken_ns; /* when it was true, by CLOCK_MONOTONIC; 0: when read() came back */
  uint64_t number;  /* with KERF_COUNTS_READINGS */
  uint32_t flags;
  uint32_t reserved;
} kerf_device_reading_v1;

typedef struct kerf_device_v1 {
  uint32_t abi;  /* KERF_DEVICE_ABI */
  uint32_t size; /* sizeof(kerf_device_v1) */
  const char* name;
  const char* about;
  const char* const* options; /* names of those that its URI takes, NULL behind the last; NULL: none */
  double open_s; /* longest time of open(), up to 60 s, which is shown where it is above 2; 0: 2 s */

  /* Opens it; `values` as `options`, each NULL where it was not given. NULL where it cannot, and `why` then
     says so in one line: what, where, how to mend it. No force acts before the first write(). */
  void* (*open)(const char* const* values, char* why, size_t why_size);
  /* Fills in what is not 0; after open(), once. */
  void (*describe)(void* device, kerf_device_facts_v1* facts);
  /* Waits for the next reading, for 10 ms at most, so that a force is not held up. 1: there is one; 0: none
     yet; -1: the device is lost. A reading that is not taken again is the last one. */
  int (*read)(void* device, kerf_device_reading_v1* reading);
  /* Hands over a force per axis, within the limits and finite. 0; 1: it was not taken; -1: the device is
     lost. NULL: it takes no force. */
  int (*write)(void* device, const double* force);
  /* Makes the force zero, now, whatever is under way; also in the copy of the process, where nothing is as
     read() and write() have left it. NULL only without write(). */
  void (*release)(void* device);
  void (*close)(void* device);
  /* Why the last read() or write() said -1, in one line; NULL: it is said that the device is lost, and no
   * more. */
  const char* (*trouble)(void* device);
} kerf_device_v1;

#define KERF_DEVICE_EXPORT __attribute__((visibility("default")))

/* What a plug-in exports. */
KERF_DEVICE_EXPORT const kerf_device_v1* kerf_plugin_device(void);

#ifdef __cplusplus
}
#endif

#endif
