# embed_files(TARGET FUNCTION HEADER FILES...): files, of a page or as texts, become part of a library.
function(embed_files target function header)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${function}_files.cpp)
  set(script ${PROJECT_SOURCE_DIR}/bench/data/embed/embed.cmake)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -D OUTPUT=${output} -D FUNCTION=${function} -D HEADER=${header} -D "FILES=${ARGN}" -P ${script}
    DEPENDS ${ARGN} ${script}
    VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
