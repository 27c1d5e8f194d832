#pragma once

#include <kerf/compare/expect.h>

/// For Catch2, versions 2 and 3, and doctest, whose own header comes first: this one has none of them.
///
/// CHECK_FORCES_WITHIN_JND(expected, got, jnds [, rate_hz [, unit]]): forces [N] at 1 kHz unless said
/// otherwise, tick by tick within so many JNDs, and no vibration between them that a hand could feel.
#define CHECK_FORCES_WITHIN_JND(...) KERF_FORCES_WITHIN_JND(CHECK, __VA_ARGS__)
#define REQUIRE_FORCES_WITHIN_JND(...) KERF_FORCES_WITHIN_JND(REQUIRE, __VA_ARGS__)

#define KERF_FORCES_WITHIN_JND(assertion, ...)                                                \
  do {                                                                                        \
    const ::kerf::compare::TestResult kerf_result = ::kerf::compare::within_jnd(__VA_ARGS__); \
    INFO(kerf_result.why);                                                                    \
    assertion(kerf_result.why.empty());                                                       \
  } while (false)
