# Makes OUTPUT of TEMPLATE with VERSION and the commit of TREE; touches it only if something changed.
set(COMMIT unknown)
find_program(git git)
# Sources unpacked within somebody else's clone are none of its commits.
if(git AND EXISTS ${TREE}/.git)
  execute_process(
    COMMAND ${CMAKE_COMMAND} -E env GIT_OPTIONAL_LOCKS=0 ${git} -C ${TREE} describe --always --dirty --abbrev=12
    OUTPUT_VARIABLE described RESULT_VARIABLE failed ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT failed)
    set(COMMIT ${described})
  endif()
endif()
configure_file(${TEMPLATE} ${OUTPUT} @ONLY)
