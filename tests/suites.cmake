# Read by ctest itself for each test program of a build that runs suites as one test (KERF_TESTS_BY_SUITE): a program takes a twelfth
# of a second to start, under the sanitizers a third, which for thousands of cases was half of all time.
#
# In: kerf_program, kerf_properties (of each test), kerf_left_out (a file of what is not run, or nothing: a line for a suite,
# "Suite.*", or for cases, a pattern as GoogleTest reads it; # begins a comment). Out: a test for each suite, named as it.
if(NOT EXISTS ${kerf_program})
  add_test(${kerf_program}_NOT_BUILT ${kerf_program}_NOT_BUILT)
  return()
endif()
execute_process(COMMAND ${kerf_program} --gtest_list_tests OUTPUT_VARIABLE kerf_listed COMMAND_ERROR_IS_FATAL ANY)
set(kerf_patterns)
if(kerf_left_out)
  file(STRINGS ${kerf_left_out} kerf_patterns REGEX "^[^#]")
endif()
list(JOIN kerf_patterns ":" kerf_patterns_joined)
string(REGEX MATCHALL "(^|\n)[^ \n][^ \n]*\\.( |\n)" kerf_suites "${kerf_listed}")
foreach(kerf_suite IN LISTS kerf_suites)
  string(REGEX REPLACE "^\n|\\..*$" "" kerf_suite "${kerf_suite}")
  list(FIND kerf_patterns "${kerf_suite}.*" kerf_found)
  if(kerf_found EQUAL -1)
    add_test(${kerf_suite} ${kerf_program} --gtest_filter=${kerf_suite}.*-${kerf_patterns_joined})
    set_tests_properties(${kerf_suite} PROPERTIES ${kerf_properties})
  endif()
endforeach()
