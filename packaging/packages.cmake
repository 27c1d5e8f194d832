# Debian packages by CPack, one of each group of components; scripts/package makes and checks them.
set(KERF_MAINTAINER "Kerf maintainers <maintainers@kerf.example>" CACHE STRING "Who answers for the packages that are built here")
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # each package has its own
set(CPACK_PACKAGE_NAME kerf)
set(CPACK_PACKAGE_VENDOR Kerf)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
                                                WORLD_EXECUTE)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${KERF_MAINTAINER})
set(CPACK_DEBIAN_PACKAGE_SOURCE kerf)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_KERF_PACKAGE_SECTION science)
set(CPACK_DEBIAN_KERF_PACKAGE_RECOMMENDS "gnuplot-nox | gnuplot")
set(CPACK_DEBIAN_KERF_PACKAGE_SUGGESTS "g++, libkerf-dev, usbip, xdg-utils")
set(CPACK_DEBIAN_KERF_DESCRIPTION
    "${PROJECT_DESCRIPTION}
Records device trajectories and forces, fits force laws to them, and proves
that a law renders at 1 kHz in closed loop, for labs that build surgical
simulators. It drives the Novint Falcon, WoodenHaptics and Polhem, a
force/torque sensor on a LabJack U6, and 3Dconnexion caps; simulated devices
and emulators on the USB stand in for them.")

set(CPACK_DEBIAN_LIBKERF1_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBKERF1_PACKAGE_SHLIBDEPS OFF)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_SOURCE_DIR}/depends.cmake)
set(CPACK_DEBIAN_LIBKERF1_DESCRIPTION
    "Force laws of haptic cutting, for other programs
Steps the force laws that Kerf fits in a simulator, a controller or a test,
to the last bit as Kerf itself does: from the law file, by position, velocity
and elapsed time, within limits of force where a device is held by a hand.")

set(CPACK_DEBIAN_LIBKERF-DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBKERF-DEV_PACKAGE_DEPENDS "libkerf1 (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}), libeigen3-dev")
set(CPACK_DEBIAN_LIBKERF-DEV_PACKAGE_SUGGESTS "cmake, kerf, pkg-config")
set(CPACK_DEBIAN_LIBKERF-DEV_DESCRIPTION
    "Force laws of haptic cutting: headers
What is needed to build programs with libkerf in C99 or C++20, by CMake or
pkg-config; the laws themselves as C++ templates with a static library; and
the headers by which Kerf makes a plug-in of somebody's own law.")

if(KERF_WITH_PYTHON)
  math(EXPR next "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON3-KERF_PACKAGE_SECTION python)
  # Files are read by the programs of kerf, of the same version.
  set(CPACK_DEBIAN_PYTHON3-KERF_PACKAGE_DEPENDS
      "kerf (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}), python3 (>= 3.${Python3_VERSION_MINOR}~), python3 (<< 3.${next}), \
python3-numpy")
  set(CPACK_DEBIAN_PYTHON3-KERF_PACKAGE_SUGGESTS "python3-pandas")
  set(CPACK_DEBIAN_PYTHON3-KERF_DESCRIPTION
      "Force laws of haptic cutting, for Python
Reads recordings of Kerf as NumPy arrays and pandas frames, fits force laws to
them and renders trajectories through laws, to the last bit as Kerf itself
does.")
endif()

# kerf_package(PACKAGE COMPONENTS...): a package of these components, and what Debian asks of each in a component of its own that nothing
# else installs.
function(kerf_package package)
  set(files ${CMAKE_CURRENT_BINARY_DIR}/debian/${package})
  set(also "") # of what the copyright tells
  if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/debian/${package}.copyright)
    file(READ debian/${package}.copyright also)
  endif()
  configure_file(debian/copyright.in ${files}/copyright @ONLY)
  configure_file(debian/changelog.in ${files}/changelog.Debian @ONLY)
  execute_process(COMMAND ${KERF_GZIP} -9nfk ${files}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
  set(about COMPONENT debian-${package} EXCLUDE_FROM_ALL)
  install(FILES ${files}/copyright ${files}/changelog.Debian.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} ${about})
  install(FILES debian/${package}.overrides DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides RENAME ${package} ${about})
  cpack_add_component_group(${package})
  foreach(component ${ARGN} debian-${package})
    cpack_add_component(${component} GROUP ${package})
  endforeach()
endfunction()

# What other packages that link the library are to depend on, and that the linker's cache is to be made anew.
set(control ${CMAKE_CURRENT_BINARY_DIR}/debian/control)
configure_file(${PROJECT_SOURCE_DIR}/libkerf/libkerf1.symbols ${control}/symbols COPYONLY)
file(CONFIGURE OUTPUT ${control}/shlibs CONTENT "libkerf 1 libkerf1 (>= ${PROJECT_VERSION})\n")
file(CONFIGURE OUTPUT ${control}/triggers CONTENT "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBKERF1_PACKAGE_CONTROL_EXTRA ${control}/symbols ${control}/shlibs ${control}/triggers)

# Compiled when it is installed, as Debian's own packages for Python are.
file(CONFIGURE OUTPUT ${control}/python/postinst CONTENT "#!/bin/sh
set -e
if [ \"$1\" = configure ] && command -v py3compile >/dev/null; then py3compile -p python3-kerf; fi
")
file(CONFIGURE OUTPUT ${control}/python/prerm CONTENT "#!/bin/sh
set -e
if command -v py3clean >/dev/null; then py3clean -p python3-kerf; fi
")
file(CHMOD ${control}/python/postinst ${control}/python/prerm PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
     WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_PYTHON3-KERF_PACKAGE_CONTROL_EXTRA ${control}/python/postinst ${control}/python/prerm)

set(packages kerf libkerf1 libkerf-dev)
if(KERF_WITH_PYTHON)
  list(APPEND packages python3-kerf)
endif()
set(components_kerf program udev documentation examples)
set(components_libkerf1 runtime)
set(components_libkerf-dev development)
set(components_python3-kerf python)
# Libraries of several architectures lie side by side; the program serves any.
set(multi_arch_kerf foreign)
set(multi_arch_libkerf1 same)
set(multi_arch_libkerf-dev same)
set(multi_arch_python3-kerf no)
set(CPACK_COMPONENTS_ALL "")
foreach(package IN LISTS packages)
  string(TOUPPER ${package} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${package})
  # CMake has a variable for the second field from 3.31 on.
  set(CPACK_DEBIAN_${upper}_PACKAGE_PRIORITY "optional\nMulti-Arch: ${multi_arch_${package}}")
  list(APPEND CPACK_COMPONENTS_ALL ${components_${package}} debian-${package})
endforeach()
include(CPack)
foreach(package IN LISTS packages)
  kerf_package(${package} ${components_${package}})
endforeach()
