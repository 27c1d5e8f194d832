#ifndef KERF_LAW_H
#define KERF_LAW_H

/*
 * A force law of your own as a shared object, in C99 (docs/own-law.md).
 *
 * It exports one function, kerf_plugin_law(), which returns a description that never changes. Everything is
 * in SI: m or rad, N or N·m, s. A law along one axis sees a penetration, which grows into the tissue, and its
 * force is positive where it resists; a law with axes of its own sees their positions, and its force is what
 * the tissue exerts on the tool.
 *
 * A state is a block of bytes that Kerf owns, copies by memcpy() and gives back without a word: it holds all
 * that the law remembers, and no pointer to memory of its own. A step is called a thousand times a second: it
 * allocates, locks, prints and waits for nothing. Several states are stepped in turns, by several threads.
 */

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What this header describes. */
#define KERF_LAW_ABI 1u

/* Flags of a parameter. */
#define KERF_SEARCHED 1u    /* by a fit; without it a fit holds the parameter at its initial value */
#define KERF_LOGARITHMIC 2u /* searched by its logarithm; the lower bound is then above zero */
#define KERF_LINEAR 4u      /* at given other parameters the force is linear in it: a fit finds it at once */

typedef struct kerf_law_parameter_v1 {
  const char* name; /* as law files have it: a-z, 0-9 and _, first a letter */
  /* "N", "m", "m/s", "N/m", "N·s/m" (or N*s/m), "1", "s", "1/s", "kg", "J", "N·m", ...; those of the axis
     follow it: what is N/m along a depth is N/rad about an angle */
  const char* unit;
  const char* meaning; /* a few words */
  double lower;        /* smallest value that is accepted, inclusive */
  double upper;        /* largest, inclusive */
  double initial;      /* where a fit begins, of the right order; what ./mylaw.so renders as it is */
  uint32_t flags;
} kerf_law_parameter_v1;

/* An axis of a law that acts on axes which it names; units "m" or "rad", "N" or "N·m" (or N*m). */
typedef struct kerf_law_axis_v1 {
  const char* name; /* "x", "rx", "theta", ... as 'kerf devices' lists them */
  const char* position_unit;
  const char* force_unit;
} kerf_law_axis_v1;

/* What the law can tell of a cut beside a force that grows with the depth; 'kerf choose' asks for it. */
#define KERF_TELLS_LOOP 1u        /* opening is felt otherwise than closing, at any speed */
#define KERF_TELLS_RELAXATION 2u  /* the force fades while the tool is held */
#define KERF_TELLS_CUTTING 4u     /* the tissue gives way, and the force falls */
#define KERF_TELLS_RATE 8u        /* the force depends on the speed */
#define KERF_TELLS_STIFFENING 16u /* the force is no straight line over the depth */

typedef struct kerf_law_v1 {
  uint32_t abi;  /* KERF_LAW_ABI */
  uint32_t size; /* sizeof(kerf_law_v1) */
  const char* name;
  const char* equation;
  const char* position_unit; /* "m" or "rad"; NULL: the law makes sense in either */
  const char* force_unit;    /* "N" or "N·m", likewise */
  const kerf_law_parameter_v1* parameters;
  const kerf_law_axis_v1* axes; /* NULL: it goes on any one axis */
  uint32_t parameter_count;     /* 1 to 32 */
  uint32_t axis_count;          /* 0 (a law along one axis) to 6 */
  uint32_t tells;               /* KERF_TELLS_... */
  uint32_t reserved;            /* 0 */
  size_t state_size;            /* bytes, up to 64 MiB; 0: it remembers nothing */
  size_t state_alignment;       /* a power of two, up to 4096; 0: that of a double */

  /* Before the first step the state is zero. Not NULL: this is called once more; what it returns is 0, or
     these parameters make no law. */
  int (*init)(const double* parameters, void* state);
  /* One tick. Positions, velocities and forces: one number an axis, one along one axis. dt is the time since
     the last tick [s], be it a minute. */
  void (*step)(const double* parameters, void* state, const double* position, const double* velocity,
               double dt, double* force);
  /* Energy that a state can give back at most [J or N·rad]; NULL: the law does not say. */
  double (*stored_energy)(const double* parameters, const void* state);

  /* For fits, and only of a law along one axis; step_derivatives NULL: they take central differences. A state
     of its own kind, and as many derivatives as there are parameters, d force / d parameter in its unit. */
  size_t derivatives_state_size;
  size_t derivatives_state_alignment;
  int (*init_derivatives)(const double* parameters, void* state);
  void (*step_derivatives)(const double* parameters, void* state, const double* position,
                           const double* velocity, double dt, double* force, double* derivatives);
} kerf_law_v1;

#define KERF_LAW_EXPORT __attribute__((visibility("default")))

/* What a plug-in exports. */
KERF_LAW_EXPORT const kerf_law_v1* kerf_plugin_law(void);

#ifdef __cplusplus
}
#endif

#endif
