#ifndef KERF_TESTS_FAKE_DEVICE_H
#define KERF_TESTS_FAKE_DEVICE_H

/*
 * What the libraries of makers that are played here have alike: a handle in a hand of 300 N/m without mass,
 * whose state stands in the file that FAKE_STATE names, for whoever looks at it from outside and for the
 * copies of a process; and FAKE_MOOD, which says what goes wrong, mostly from the 300th frame or reading on.
 */

#include <stdint.h>

struct FakeState {
  double position_m[3];
  double force_n[3];   /* of its motors, now */
  double largest_n[3]; /* that was ever there */
  uint64_t turns;      /* frames, or readings */
  uint64_t misused;    /* calls that the interface forbids where they were made */
  int32_t is_on;       /* force output */
  int32_t has_brakes;
  int32_t has_gravity_compensation;
  int32_t is_initialised; /* it has found its stops */
  int32_t opened;         /* less closed */
};

#ifdef KERF_FAKE_DEVICE

#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

enum { fake_well = 300 };

static struct FakeState* fake_at(void) {
  static struct FakeState* state;
  if (state != NULL) return state;
  const char* const file = getenv("FAKE_STATE");
  const int number = open(file != NULL ? file : "/dev/null", O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (number < 0 || ftruncate(number, sizeof *state) != 0) abort();
  state = mmap(NULL, sizeof *state, PROT_READ | PROT_WRITE, MAP_SHARED, number, 0);
  if (state == MAP_FAILED) abort();
  close(number);
  return state;
}

static int fake_mood(const char* mood) {
  const char* const now = getenv("FAKE_MOOD");
  return now != NULL && strcmp(now, mood) == 0;
}
/* Whether it is in that mood, and has been well for long enough. */
static int fake_turns(const char* mood) { return fake_mood(mood) && fake_at()->turns > fake_well; }

static void fake_pause_ms(long ms) {
  const struct timespec time = {ms / 1000, ms % 1000 * 1000000};
  nanosleep(&time, NULL);
}

static void fake_push(const double* force_n) {
  struct FakeState* const state = fake_at();
  for (int i = 0; i < 3; ++i) {
    state->force_n[i] = force_n[i];
    state->largest_n[i] = fmax(state->largest_n[i], fabs(force_n[i]));
  }
}

/* A millisecond of the hand. */
static void fake_move(void) {
  struct FakeState* const state = fake_at();
  for (int i = 0; i < 3; ++i) {
    const double force_n = state->is_on ? state->force_n[i] : 0.0;
    state->position_m[i] += 0.05 * (force_n / 300.0 - state->position_m[i]);
  }
}

#define FAKE_EXPORT __attribute__((visibility("default")))

#endif
#endif
