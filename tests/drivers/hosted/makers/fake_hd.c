/* A libHD.so of our own with the C interface of OpenHaptics' HDAPI as public programs call it: a thread at 1
   kHz that calls what was scheduled, frames, a stack of errors. Lengths in mm. WITHOUT_SCHEDULER leaves out
   what a driver cannot do without. */
#define _DEFAULT_SOURCE
#define KERF_FAKE_DEVICE
#include <pthread.h>

#ifdef WITHOUT_SCHEDULER
#define SCHEDULER_EXPORT
#else
#define SCHEDULER_EXPORT FAKE_EXPORT
#endif

#include "fake_device.h"

typedef struct {
  uint32_t code;
  int32_t internal;
  uint32_t device;
} error_info;

enum { handle = 7, most_errors = 16 };
static uint32_t errors[most_errors];
static int error_count;
static pthread_mutex_t errors_lock = PTHREAD_MUTEX_INITIALIZER;
static int is_in_frame;
static int is_calibrated;
static uint32_t (*scheduled)(void*);
static void* scheduled_for;
static volatile int runs;
static pthread_t scheduler;

static void fail(uint32_t code) {
  pthread_mutex_lock(&errors_lock);
  if (error_count < most_errors) errors[error_count++] = code;
  pthread_mutex_unlock(&errors_lock);
}
static void needs_frame(void) {
  if (!is_in_frame) ++fake_at()->misused;
}

FAKE_EXPORT uint32_t hdInitDevice(const char* name) {
  if (fake_mood("no_device") ||
      (name != NULL && strcmp(name, "left") != 0 && strcmp(name, "Default Device") != 0)) {
    fail(0x0300);
    return 0xffffffff;
  }
  if (fake_mood("busy")) {
    fail(0x0301);
    return 0xffffffff;
  }
  ++fake_at()->opened;
  is_calibrated = !fake_mood("inkwell") && !fake_mood("uncalibrated");
  return handle;
}
FAKE_EXPORT void hdDisableDevice(uint32_t device) {
  if (device == handle) --fake_at()->opened;
}
FAKE_EXPORT void hdMakeCurrentDevice(uint32_t device) {
  if (device != handle) fail(0x0104);
}
FAKE_EXPORT uint32_t hdGetCurrentDevice(void) { return handle; }

FAKE_EXPORT void hdBeginFrame(uint32_t device) {
  (void)device;
  if (is_in_frame) fail(0x0400);
  is_in_frame = 1;
}
FAKE_EXPORT void hdEndFrame(uint32_t device) {
  (void)device;
  if (!is_in_frame) fail(0x0401);
  is_in_frame = 0;
}

FAKE_EXPORT error_info hdGetError(void) {
  error_info info = {0, 0, handle};
  pthread_mutex_lock(&errors_lock);
  if (error_count > 0) info.code = errors[--error_count];
  pthread_mutex_unlock(&errors_lock);
  return info;
}
FAKE_EXPORT const char* hdGetErrorString(uint32_t code) {
  return code == 0x0501 ? "HD_SCHEDULER_FULL" : "an error of a fake library";
}

FAKE_EXPORT void hdEnable(uint32_t what) {
  if (what == 0x4000) fake_at()->is_on = 1;
}
FAKE_EXPORT void hdDisable(uint32_t what) {
  if (what == 0x4000) fake_at()->is_on = 0;
}

FAKE_EXPORT void hdGetIntegerv(uint32_t what, int32_t* value) {
  if (what == 0x2000) needs_frame();
  if (what == 0x2000) *value = fake_mood("pressed") ? 2 : 0;
  if (what == 0x2555) *value = 4; /* by its inkwell */
}
FAKE_EXPORT void hdGetDoublev(uint32_t what, double* value) {
  const struct FakeState* const state = fake_at();
  switch (what) {
    case 0x2050:
      needs_frame();
      for (int i = 0; i < 3; ++i) value[i] = 1e3 * state->position_m[i];
      if (fake_turns("nan")) value[1] = NAN;
      break;
    case 0x2150:
      needs_frame();
      value[0] = 0.1;
      value[1] = 0.2;
      value[2] = 0.3;
      break;
    case 0x2052: /* by columns */
      needs_frame();
      for (int i = 0; i < 16; ++i) value[i] = i % 5 == 0 ? 1.0 : 0.0;
      for (int i = 0; i < 3; ++i) value[12 + i] = 1e3 * state->position_m[i];
      break;
    case 0x2551: {
      const double range[6] = {-160, -120, -70, 160, 120, 70};
      memcpy(value, range, sizeof range);
      break;
    }
    case 0x2603:
      *value = 3.3;
      break;
    case 0x2604:
      *value = fake_mood("no_limit") ? 0.0 : 0.88;
      break;
    case 0x2605:
      value[0] = 0.25;
      value[1] = 0.5;
      value[2] = 0.125;
      break;
    default:
      fail(0x0100);
  }
}
FAKE_EXPORT void hdSetDoublev(uint32_t what, const double* value) {
  needs_frame();
  if (what == 0x2700) fake_push(value);
}
FAKE_EXPORT const char* hdGetString(uint32_t what) {
  switch (what) {
    case 0x2500:
      return "3.4.0";
    case 0x2501:
      return "Touch";
    case 0x2502:
      return "2023.1";
    case 0x2503:
      return "nobody";
    case 0x2504:
      return "T-17";
    default:
      fail(0x0100);
      return NULL;
  }
}

FAKE_EXPORT uint32_t hdCheckCalibration(void) {
  if (is_calibrated) return 0x5000;
  return fake_mood("inkwell") ? 0x5001 : 0x5002;
}
FAKE_EXPORT void hdUpdateCalibration(uint32_t style) {
  if (style == 4) is_calibrated = 1;
}

static void* serve(void* unused) {
  (void)unused;
  struct FakeState* const state = fake_at();
  struct timespec next;
  clock_gettime(CLOCK_MONOTONIC, &next);
  while (runs) {
    next.tv_nsec += fake_mood("late") ? 5000000 : 1000000;
    if (next.tv_nsec >= 1000000000) {
      next.tv_nsec -= 1000000000;
      ++next.tv_sec;
    }
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, NULL);
    ++state->turns;
    while (runs && (fake_turns("stall") || (fake_mood("pause") && state->turns == fake_well))) {
      fake_pause_ms(fake_mood("pause") ? 300 : 1);
      if (fake_mood("pause")) ++state->turns;
    }
    if (fake_turns("crash")) *(volatile int*)NULL = 1;
    if (fake_mood("max_force") && state->turns == fake_well) fail(0x0201);
    if (fake_turns("warm")) fail(0x0200);
    if (fake_turns("errs")) fail(0x0204);
    if (fake_turns("unplugged")) fail(0x0302);
    if (scheduled != NULL && scheduled(scheduled_for) == 0) scheduled = NULL;
    fake_move();
  }
  return NULL;
}

SCHEDULER_EXPORT void hdSetSchedulerRate(unsigned long hz) {
  if (hz != 500 && hz != 1000) fail(0x0101);
}
SCHEDULER_EXPORT unsigned long hdScheduleAsynchronous(uint32_t (*callback)(void*), void* for_it,
                                                      uint16_t priority) {
  (void)priority;
  if (fake_mood("full")) {
    fail(0x0501);
    return 0;
  }
  scheduled_for = for_it;
  scheduled = callback;
  return 1;
}
SCHEDULER_EXPORT void hdStartScheduler(void) {
  if (fake_mood("no_timer")) {
    fail(0x0304);
    return;
  }
  runs = 1;
  pthread_create(&scheduler, NULL, serve, NULL);
}
SCHEDULER_EXPORT void hdStopScheduler(void) {
  if (!runs) return;
  runs = 0;
  pthread_join(scheduler, NULL);
}
SCHEDULER_EXPORT void hdUnschedule(unsigned long number) {
  (void)number;
  scheduled = NULL;
}
