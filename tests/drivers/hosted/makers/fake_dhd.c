/* A libdrd.so of our own with the C interface of Force Dimension's DHD and DRD as public programs call it:
   one omega.3. WITHOUT_POSITION leaves out what a driver cannot do without, WITHOUT_DRD what older versions
   have not. */
#define _DEFAULT_SOURCE
#define KERF_FAKE_DEVICE
#include <stdbool.h>

#ifdef WITHOUT_POSITION
#define POSITION_EXPORT
#else
#define POSITION_EXPORT FAKE_EXPORT
#endif
#ifdef WITHOUT_DRD
#define DRD_EXPORT
#else
#define DRD_EXPORT FAKE_EXPORT
#endif

#include "fake_device.h"

static int error;
static int off_cause;

static int fail(int code) {
  error = code;
  return -1;
}

FAKE_EXPORT void dhdGetSDKVersion(int* major, int* minor, int* release, int* revision) {
  *major = fake_mood("old") ? 2 : 3;
  *minor = 17;
  *release = 5;
  *revision = 1;
}
FAKE_EXPORT int dhdGetDeviceCount(void) { return fake_mood("no_device") ? 0 : 1; }
FAKE_EXPORT int dhdErrorGetLast(void) { return error; }
FAKE_EXPORT const char* dhdErrorGetLastStr(void) {
  return error == 20 ? "device in use" : error == 2 ? "communication error" : "undefined error";
}

FAKE_EXPORT int dhdOpenID(signed char number) {
  if (fake_mood("busy")) return fail(20);
  if (number != 0) return fail(5);
  ++fake_at()->opened;
  return 0;
}
FAKE_EXPORT int dhdClose(signed char id) {
  (void)id;
  --fake_at()->opened;
  return 0;
}
FAKE_EXPORT int dhdStop(signed char id) {
  const double none[3] = {0.0, 0.0, 0.0};
  (void)id;
  fake_push(none);
  fake_at()->is_on = 0;
  return 0;
}
FAKE_EXPORT int dhdGetSystemType(signed char id) {
  (void)id;
  return fake_mood("unknown_type") ? 91 : 33;
}
FAKE_EXPORT const char* dhdGetSystemName(signed char id) {
  (void)id;
  return fake_mood("unknown_type") ? "custom" : "omega.3";
}
FAKE_EXPORT int dhdGetSerialNumber(unsigned short* number, signed char id) {
  (void)id;
  *number = 1234;
  return 0;
}
FAKE_EXPORT double dhdGetMaxForce(signed char id) {
  (void)id;
  return fake_mood("lower_limit") ? 5.0 : -1.0;
}
FAKE_EXPORT unsigned dhdGetButtonMask(signed char id) {
  (void)id;
  return fake_mood("pressed") ? 1u : 0u;
}

FAKE_EXPORT int dhdGetStatus(int* status, signed char id) {
  const struct FakeState* const state = fake_at();
  (void)id;
  memset(status, 0, 17 * sizeof *status);
  status[0] = !fake_mood("no_power");
  status[1] = 1;
  status[5] = state->is_on && off_cause == 0;
  status[6] = state->has_brakes;
  status[10] = state->has_gravity_compensation;
  status[14] = off_cause;
  return 0;
}

POSITION_EXPORT int dhdGetPosition(double* x, double* y, double* z, signed char id) {
  struct FakeState* const state = fake_at();
  (void)id;
  ++state->turns;
  if (fake_mood("late")) fake_pause_ms(4);
  while (fake_turns("hang")) fake_pause_ms(1000);
  if (fake_turns("unplugged")) return fail(2);
  if (fake_turns("button")) off_cause = 1;
  if (fake_turns("too_fast")) off_cause = 2;
  if (off_cause != 0) fake_at()->is_on = 0;
  const int is_same = fake_mood("timeguard") && state->turns % 2 != 0;
  if (!is_same) fake_move();
  *x = state->position_m[0];
  *y = state->position_m[1];
  *z = state->position_m[2];
  return is_same;
}

FAKE_EXPORT int dhdSetForce(double x, double y, double z, signed char id) {
  const double force_n[3] = {x, y, z};
  (void)id;
  if (fake_at()->is_on == 0 && (x != 0.0 || y != 0.0 || z != 0.0)) ++fake_at()->misused;
  fake_push(force_n);
  return fake_mood("saturated") ? 2 : 0;
}
FAKE_EXPORT int dhdEnableForce(unsigned char on, signed char id) {
  (void)id;
  fake_at()->is_on = on;
  return 0;
}
FAKE_EXPORT int dhdSetBrakes(int on, signed char id) {
  (void)id;
  fake_at()->has_brakes = on;
  return 0;
}
FAKE_EXPORT int dhdSetGravityCompensation(int on, signed char id) {
  (void)id;
  fake_at()->has_gravity_compensation = on;
  return 0;
}

DRD_EXPORT int drdOpenID(signed char number) { return dhdOpenID(number); }
DRD_EXPORT int drdClose(signed char id) { return dhdClose(id); }
DRD_EXPORT bool drdIsSupported(signed char id) {
  (void)id;
  return true;
}
DRD_EXPORT bool drdIsInitialized(signed char id) {
  (void)id;
  return !fake_mood("uncalibrated") || fake_at()->is_initialised;
}
DRD_EXPORT int drdAutoInit(signed char id) {
  (void)id;
  fake_at()->is_initialised = 1;
  return 0;
}
