/* libkerf: the force laws of Kerf in other programs. C99; the ABI is that of libkerf.so.1.
 *
 * A law is opened from its file (`NAME.law.toml`), from text, or by the name of its model. A state is what
 * one tool has lived through with it. A step takes position, velocity and elapsed time and gives the force:
 * the same, to the last bit, as `kerf replay` and the loop of `kerf record` give.
 *
 * Units. SI: m, rad, m/s, rad/s, s, N, N·m. kerf_law_axis() tells which a law takes on each of its axes.
 *
 * Frames and signs. A law along one axis goes on any axis of a host; its file says where on it the tissue
 * begins and which direction leads into it (kerf_law_contact()), and kerf_step() takes positions of that
 * axis. A law in space has axes of its own (kerf_law_axis()): "x", "y", "z" [m] are right-handed with z up,
 * "rx", "ry", "rz" [rad] a rotation vector; others are joints or the angle of scissors, as docs/laws.md says
 * of the law. A force or torque is what the tissue exerts on the tool, positive where it pushes the position
 * of its axis up.
 *
 * Threads. A law never changes: any number of threads may ask it and make states of it at once. A state and a
 * safety belong to one thread at a time. Nothing is shared between two states.
 *
 * In the loop. kerf_step*(), kerf_safety_judge(), kerf_safety_apply(), kerf_state_assign() and
 * kerf_state_reset() allocate, lock, log and throw nothing; a law of a plug-in, what it does itself. All else
 * is for set-up. No function writes to a stream, and none lets an exception out.
 *
 * Arguments. Pointers are not NULL unless a function says that they may be; texts are UTF-8 and end in a
 * zero. What the library returns as text lives as long as the law, or for good.
 */
#ifndef KERF_KERF_H
#define KERF_KERF_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define KERF_API __attribute__((visibility("default")))
#else
#define KERF_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Version and words ---- */

/** The ABI that this header describes: that of the library's name, libkerf.so.1. */
#define KERF_ABI_VERSION 1

/** The ABI of the library that runs; a host that loaded it by hand compares it with KERF_ABI_VERSION. */
KERF_API uint32_t kerf_abi_version(void);
/** The library that runs: "0.1.0". */
KERF_API const char* kerf_version(void);
/** The same with its commit, as Kerf's files name the program: "kerf 0.1.0 (81988ff57a31)". */
KERF_API const char* kerf_software(void);

/** What came of a call at set-up; the numbers are the exit statuses of the program. */
typedef int32_t kerf_status;
enum {
  KERF_OK = 0,
  KERF_BAD_INPUT =
      2, /**< what was given is not as it must be; the error text says what, where, and what was expected */
  KERF_SYSTEM = 4 /**< the system refused: no memory, a file that could not be read to its end */
};
/** The status in words: "bad input". Any number is allowed. */
KERF_API const char* kerf_status_text(kerf_status status);

/* Calls at set-up take `error`, room of `error_size` bytes for one line that says what was wrong, cut where
 * it does not fit and ended by a zero; the empty text if nothing was. `error` may be NULL. */

/** Bits that a step returns; those of `/samples/flags` in recordings. 0: the force is what the law gives. */
enum {
  KERF_FORCE_LIMITED = 1 << 1, /**< safety: the force was cut to its limit */
  KERF_SLEW_LIMITED = 1 << 2,  /**< safety: the force changed more slowly than was asked for */
  KERF_SOFT_START = 1 << 3,    /**< safety: the force is let in along a ramp */
  KERF_LAW_FAULT =
      1 << 4, /**< an input or the law's force was not finite, or no time had passed: zero force */
  KERF_DEVICE_FAULT = 1 << 5,  /**< safety: a position or velocity was not finite: zero force */
  KERF_POSITION_JUMP = 1 << 8, /**< safety: the position moved farther than the device can: zero force */
  KERF_WATCHDOG = 1 << 9,      /**< safety: the host had stalled: zero force */
  KERF_ZERO_HELD = 1 << 12 /**< safety: the position had jumped, and nobody has confirmed it: zero force */
};
/** What one bit says, in words; NULL for a number that is none of these bits. */
KERF_API const char* kerf_flag_text(uint32_t flag);

/** A velocity or an elapsed time that the host does not have. Any NaN says so; the library does without: see
 * kerf_step().
 */
#define KERF_NONE (kerf_none())
KERF_API double kerf_none(void);

/* ---- Laws ---- */

/** A law: immutable, shared by as many states and threads as one likes. */
typedef struct kerf_law kerf_law;

/** How many models the library knows, and the name of each, from 0 on; NULL beyond the last. Those of
 * plug-ins follow the library's own, in the order in which they were loaded. */
KERF_API size_t kerf_model_count(void);
KERF_API const char* kerf_model_name(size_t model);

/** Reads a law file of at most 16 MiB.
 *  Errors: KERF_BAD_INPUT with file and line: no such file, not TOML, an unknown law, a key that is not known
 * (with the version that wrote it if that is newer than this one), a unit of another kind, a parameter out of
 * its range, a plug-in that is not loaded or of another content. `law` is NULL then. */
KERF_API kerf_status kerf_law_open(const char* path, kerf_law** law, char* error, size_t error_size);

/** Reads a law from `size` bytes of text in memory; `name` stands for the file in messages. Errors as
 * kerf_law_open(). */
KERF_API kerf_status kerf_law_parse(const char* text, size_t size, const char* name, kerf_law** law,
                                    char* error, size_t error_size);

/** A parameter by its name, in SI; one of several of a kind as "closing[3]". */
typedef struct kerf_value {
  const char* name;
  double value;
} kerf_value;

/** What an option holds. */
enum { KERF_OPTION_FLAG = 0, KERF_OPTION_NUMBER = 1, KERF_OPTION_TEXT = 2 };
/** An option of a law by its name: a setting that is chosen and not fitted ([fidelity] in a law file). */
typedef struct kerf_option {
  const char* name;
  int32_t kind;     /**< KERF_OPTION_FLAG, _NUMBER or _TEXT */
  double number;    /**< of a number; of a flag, 0 is false and all else true */
  const char* text; /**< of a text; else ignored */
} kerf_option;

/** Makes a law by the name of its model, with every parameter once, in any order, and those options that are
 * not at their standard. A law along one axis is on one in m and N, or in the units that it makes sense in,
 * with contact at 0 in the increasing direction; for another axis or contact write a text and use
 * kerf_law_parse(). `values` and `options` may be NULL where their count is 0. Errors: KERF_BAD_INPUT. */
KERF_API kerf_status kerf_law_make(const char* model, const kerf_value* values, size_t value_count,
                                   const kerf_option* options, size_t option_count, kerf_law** law,
                                   char* error, size_t error_size);

/** Loads the law of a plug-in, a shared object as kerf/law.h describes it, for the rest of the program: law
 * files that name it, with the SHA-256 of this very file, are opened from now on, and kerf_law_make() takes
 * its name, which `model` is given; `model` may be NULL. A file that is loaded already is that one.
 *
 * The plug-in's code runs within the program and with its rights, also while it is loaded, and a crash in it
 * is one of the program: let `kerf laws ./mylaw.so` try it before, which does so in a process of its own. A
 * step in which it throws, gives no finite number or writes behind its state is a KERF_LAW_FAULT. Not while
 * another thread makes a law.
 *
 * Errors: KERF_BAD_INPUT with the file: no such file, no plug-in, another version of kerf/law.h, a
 * description that makes no sense, the name of a law that there is already. `*model` is NULL then. */
KERF_API kerf_status kerf_plugin_load(const char* path, const char** model, char* error, size_t error_size);

/** Lets go of a law; its states may live on. NULL is allowed. */
KERF_API void kerf_law_close(kerf_law* law);

/** The model's name, "kelvin", and its equation in words of the field. */
KERF_API const char* kerf_law_model(const kerf_law* law);
KERF_API const char* kerf_law_equation(const kerf_law* law);
/** The text that the law was read from, byte for byte; of one that was made by name, the law file that says
 * the same. */
KERF_API const char* kerf_law_text(const kerf_law* law);
/** The SHA-256 of kerf_law_text() in 64 digits: what `sha256sum` says of the file. */
KERF_API const char* kerf_law_sha256(const kerf_law* law);

/** What a law takes and gives along one axis. */
typedef struct kerf_axis {
  const char* name;          /**< "x", "theta", ...; "position" where a law along one axis names none */
  const char* position_unit; /**< "m" or "rad"; the velocity is in it per second */
  const char* force_unit;    /**< "N", or "N·m" of a torque */
} kerf_axis;
/** How many axes: 1 of a law along one axis, up to KERF_MAX_AXES of a law in space. */
#define KERF_MAX_AXES 6
KERF_API size_t kerf_law_axis_count(const kerf_law* law);
/** One of them, from 0 on. KERF_BAD_INPUT beyond the last; `axis` is left as it was then. */
KERF_API kerf_status kerf_law_axis(const kerf_law* law, size_t index, kerf_axis* axis);
/** 1 for a law in space, whose axes are its own; 0 for a law along one axis. */
KERF_API int32_t kerf_law_is_spatial(const kerf_law* law);

/** Where along a host's axis the tissue begins. penetration = direction (axis position - position). */
typedef struct kerf_contact {
  double position;  /**< of first contact [m or rad] */
  double direction; /**< +1 if the position grows into the tissue, -1 if it shrinks */
} kerf_contact;
/** The contact of the law file; {0, +1} where it names none, and for a law in space, which has none. */
KERF_API kerf_contact kerf_law_contact(const kerf_law* law);

/** A parameter as the law has it. */
typedef struct kerf_parameter {
  const char* name;
  const char* unit;    /**< in SI, "N/rad"; "1" of a ratio */
  const char* meaning; /**< in a few words */
  double value;
  double lower;     /**< smallest value that the law accepts, inclusive */
  double upper;     /**< largest one, inclusive */
  double std_error; /**< of the fit; NaN: not known */
} kerf_parameter;
KERF_API size_t kerf_law_parameter_count(const kerf_law* law);
/** One of them, from 0 on, in the order of the law. KERF_BAD_INPUT beyond the last; `parameter` is left as it
 * was then.
 */
KERF_API kerf_status kerf_law_parameter(const kerf_law* law, size_t index, kerf_parameter* parameter);

/** An option as the law has it: what it is set to, and to what where a law file does not name it. The numbers
 * and texts of both can be given to kerf_law_make(). */
typedef struct kerf_option_info {
  const char* meaning; /**< in a few words */
  kerf_option value;
  kerf_option standard;
} kerf_option_info;
KERF_API size_t kerf_law_option_count(const kerf_law* law);
/** One of them, from 0 on. KERF_BAD_INPUT beyond the last; `option` is left as it was then. */
KERF_API kerf_status kerf_law_option(const kerf_law* law, size_t index, kerf_option_info* option);

/* ---- States ---- */

/** What one tool has lived through with a law. Belongs to one thread at a time. */
typedef struct kerf_state kerf_state;

/** A state before the first step, with all the memory that it will ever need. It keeps what it needs of the
 * law. Errors: KERF_SYSTEM for want of memory. `state` is NULL then. */
KERF_API kerf_status kerf_state_create(const kerf_law* law, kerf_state** state, char* error,
                                       size_t error_size);
/** Another state that has lived through the same; the first step of the copy by the library's clock is as
 * that of a new one. Errors as kerf_state_create(). */
KERF_API kerf_status kerf_state_copy(const kerf_state* from, kerf_state** copy, char* error,
                                     size_t error_size);
/** Lets go of it. NULL is allowed. */
KERF_API void kerf_state_destroy(kerf_state* state);

/** Saves and restores: `to` becomes what `from` is, in the memory that it has. To save is to assign to a
 * state that was made before, to restore is to assign back. KERF_BAD_INPUT if they are not states of the same
 * kerf_law (or of copies of one state): `to` is left as it was then. For the loop. */
KERF_API kerf_status kerf_state_assign(kerf_state* to, const kerf_state* from);
/** As before the first step. For the loop. */
KERF_API void kerf_state_reset(kerf_state* state);

/** Energy that the law can give back from this state [J for a position in m, N·rad for rad]; NaN where the
 * law does not say. For the loop, though the tables of some laws are gone through. */
KERF_API double kerf_state_energy(const kerf_state* state);

/* ---- Steps ---- */

/** One tick of a law along one axis, in the sense of the host's axis: the contact of the law file is applied.
 *
 * - position [m or rad]
 * - velocity: its derivative; NaN: the host has none. Then it is the difference of the positions over the
 *   elapsed time, low-passed at first order with a corner of 20 Hz (it lags by some 8 ms), as Kerf's drivers
 *   make it: zero in the first such step. A host gives velocities always or never; where it does now and
 *   then, the difference is taken over the steps between two without.
 * - elapsed_s: since the state's last step, > 0, of any length: a law takes a stall as one tick. NaN: the
 *   host has none. Then the library asks the machine's monotonic clock; the first step is 1 ms long.
 * - force: the answer [N or N·m]; always written, 0 with KERF_LAW_FAULT
 *
 * Returns 0, or KERF_LAW_FAULT for a number that is not finite, time that has not passed, or a law in space:
 * the state is then as if the tick had not been, but for its clock. */
KERF_API uint32_t kerf_step(kerf_state* state, double position, double velocity, double elapsed_s,
                            double* force);

/** The same by the raw penetration, past the law file's contact: positive in the tissue, the velocity grows
 * into it, and the force is positive where the tissue resists. A state is stepped by one of the two
 * functions, not by both. */
KERF_API uint32_t kerf_step_depth(kerf_state* state, double penetration, double velocity, double elapsed_s,
                                  double* force);

/** One tick of any law by its axes: arrays of kerf_law_axis_count() numbers in the order of kerf_law_axis(),
 * forces and torques alike. `velocity` may be NULL, and each of its numbers NaN: none. Else as kerf_step(),
 * which it is for a law along one axis. `force` may be the same array as `position` or `velocity`. */
KERF_API uint32_t kerf_step_axes(kerf_state* state, const double* position, const double* velocity,
                                 double elapsed_s, double* force);

/* ---- Safety ---- */

/** What stands between laws and a hand, as in Kerf's own loop (docs/safety.md): a reading that cannot be
 * true, a law that fails or a host that stalled make the force zero at once; it comes back along a ramp; and
 * each axis' force and its change stay within limits. Belongs to one thread at a time. */
typedef struct kerf_safety kerf_safety;

/** What one axis of the device may do and can do. */
typedef struct kerf_limits {
  double force;        /**< largest force [N or N·m], > 0 */
  double slew;         /**< largest change of force per second, > 0 */
  double speed;        /**< faster than hand and mechanism can be, per second; 0: not known */
  double acceleration; /**< the speed cannot grow faster than that, per second squared; 0: not known */
  double resolution;   /**< step of the encoder, in the unit of position; 0: not known */
} kerf_limits;

typedef struct kerf_safety_options {
  double period_s;     /**< nominal time of a step, over which the limit of slew is reckoned, > 0 */
  double soft_start_s; /**< ramp of the force at the start and after every zero force, >= 0 */
  double stall_s;      /**< a host that was silent for longer had stalled, > 0 */
  double report_s; /**< time between reports of the device, >= 0: a position that stays the same for less is
                      the same report, as a host sees it that asks more often. 0: every step has a report of
                      its own */
} kerf_safety_options;

/** A safety for the axes of a law, `limits` one for each. `options` may be NULL: 1 ms, 0.25 s, 10 ms and 0,
 * as Kerf's loop has them at 1 kHz. Errors: KERF_BAD_INPUT for a limit that is not as above, KERF_SYSTEM for
 * want of memory. */
KERF_API kerf_status kerf_safety_create(const kerf_law* law, const kerf_limits* limits,
                                        const kerf_safety_options* options, kerf_safety** safety, char* error,
                                        size_t error_size);
/** Lets go of it. NULL is allowed. */
KERF_API void kerf_safety_destroy(kerf_safety* safety);
/** As before the first step. For the loop. */
KERF_API void kerf_safety_reset(kerf_safety* safety);

/** kerf_step_axes() within the limits: judges the reading, steps the law where it may be believed, over all
 * the time since the state's last step, and limits what it gives. Returns the bits of what it did. The state
 * must be of the law that the safety was made for, or of one with as many axes; else KERF_LAW_FAULT and zero
 * force. */
KERF_API uint32_t kerf_step_safely(kerf_safety* safety, kerf_state* state, const double* position,
                                   const double* velocity, double elapsed_s, double* force);

/** The two halves of kerf_step_safely(), for a host that adds up several laws: once a tick judge(), then, if
 * it returned 0, the laws' steps, then apply() to the sum with the bits of all of them. `velocity` may be
 * NULL or hold NaN: none; `elapsed_s` is finite and > 0 (else KERF_LAW_FAULT), and a law that was passed by
 * is to be given the time of those ticks too. */
KERF_API uint32_t kerf_safety_judge(kerf_safety* safety, const double* position, const double* velocity,
                                    double elapsed_s);
/** Makes of a force what the device is given; a force that is not finite, or a bit that says zero, make it
 * zero. Returns `flags` and what it did. */
KERF_API uint32_t kerf_safety_apply(kerf_safety* safety, uint32_t flags, double* force);

/** Somebody says that the tool is where it seems to be: the zero of KERF_ZERO_HELD ends. For the loop's
 * thread. */
KERF_API void kerf_safety_confirm(kerf_safety* safety);

#ifdef __cplusplus
}
#endif

#endif
