# cmake -D OUTPUT=page_files.cpp -D FUNCTION=session_page -D HEADER=subject/session_page.h -D FILES="a;b" -P embed.cmake:
# the files as arrays of characters, behind a function that the header declares.
set(arrays "")
set(table "")
set(index 0)
foreach(file IN LISTS FILES)
  get_filename_component(name "${file}" NAME)
  file(READ "${file}" bytes HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${bytes}")
  string(APPEND arrays "constexpr char ${FUNCTION}_${index}[] = {${bytes}};\n")
  string(APPEND table "    {\"${name}\", {${FUNCTION}_${index}, sizeof ${FUNCTION}_${index}}},\n")
  math(EXPR index "${index} + 1")
endforeach()
file(
  WRITE "${OUTPUT}"
  "#include \"${HEADER}\"\n\nnamespace kerf::bench {\nnamespace {\n\n${arrays}"
  "constexpr EmbeddedFile ${FUNCTION}_all[] = {\n${table}};\n\n}  // namespace\n\n"
  "std::span<const EmbeddedFile> ${FUNCTION}() noexcept { return ${FUNCTION}_all; }\n\n}  // namespace kerf::bench\n")
