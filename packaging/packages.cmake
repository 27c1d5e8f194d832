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
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_KERF_PACKAGE_NAME kerf)
set(CPACK_DEBIAN_KERF_PACKAGE_RECOMMENDS "gnuplot-nox | gnuplot")
set(CPACK_DEBIAN_KERF_PACKAGE_SUGGESTS "usbip, xdg-utils")
set(CPACK_DEBIAN_KERF_DESCRIPTION
    "${PROJECT_DESCRIPTION}
Records device trajectories and forces, fits force laws to them, and proves
that a law renders at 1 kHz in closed loop, for labs that build surgical
simulators. It drives the Novint Falcon, WoodenHaptics and Polhem, a
force/torque sensor on a LabJack U6, and 3Dconnexion caps; simulated devices
and emulators on the USB stand in for them.")

# kerf_package(PACKAGE COMPONENTS...): what Debian asks of each, in a component of its own that nothing else installs.
function(kerf_package package)
  set(files ${CMAKE_CURRENT_BINARY_DIR}/debian/${package})
  configure_file(debian/copyright.in ${files}/copyright @ONLY)
  configure_file(debian/changelog.in ${files}/changelog.Debian @ONLY)
  execute_process(COMMAND ${KERF_GZIP} -9nfk ${files}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
  set(about COMPONENT debian-${package} EXCLUDE_FROM_ALL)
  install(FILES ${files}/copyright ${files}/changelog.Debian.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} ${about})
  install(FILES debian/${package}.overrides DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides RENAME ${package} ${about})
endfunction()
kerf_package(kerf)

set(CPACK_COMPONENTS_ALL program udev documentation examples debian-kerf)
include(CPack)
cpack_add_component_group(kerf)
foreach(component program udev documentation examples debian-kerf)
  cpack_add_component(${component} GROUP kerf)
endforeach()
