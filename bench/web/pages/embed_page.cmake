# embed_page(TARGET FUNCTION HEADER FILES...): files of a page become part of kerf_bench.
function(embed_page target function header)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${function}_files.cpp)
  set(script ${PROJECT_SOURCE_DIR}/bench/web/embed.cmake)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -D OUTPUT=${output} -D FUNCTION=${function} -D HEADER=${header} -D "FILES=${ARGN}" -P ${script}
    DEPENDS ${ARGN} ${script}
    VERBATIM)
  add_custom_target(${target} DEPENDS ${output})
  add_dependencies(kerf_bench ${target})
  target_sources(kerf_bench PRIVATE ${output})
endfunction()
