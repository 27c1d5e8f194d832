# Read by cpack once all is laid out: what libkerf1 depends on. CPack would ask dpkg-shlibdeps itself, but then it adds scripts to a package
# with a library, which call ldconfig; Debian has that done by a trigger (packages.cmake).
set(work ${CPACK_TEMPORARY_DIRECTORY}/depends)
file(WRITE ${work}/debian/control "")
file(GLOB_RECURSE library ${CPACK_TEMPORARY_DIRECTORY}/libkerf1/libkerf.so.1.*)
execute_process(
  COMMAND dpkg-shlibdeps -O ${library}
  WORKING_DIRECTORY ${work}
  OUTPUT_VARIABLE depends
  COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "^shlibs:Depends=|\n$" "" CPACK_DEBIAN_LIBKERF1_PACKAGE_DEPENDS "${depends}")
