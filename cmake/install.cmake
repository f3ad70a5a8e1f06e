# SPDX-License-Identifier: MIT
# An installation, in components: the program, the library, what both read at run time, what hosts are compiled with
# (find_package(afterglow) and pkg-config), the Python module.
include(CMakePackageConfigHelpers)

install(DIRECTORY scripts shaders presets templates calibration assets DESTINATION ${CMAKE_INSTALL_DATADIR}/afterglow
  USE_SOURCE_PERMISSIONS COMPONENT data)

if(AFTERGLOW_PROGRAM)
  include(${CMAKE_CURRENT_LIST_DIR}/install_program.cmake)
endif()

set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/afterglow)
install(EXPORT afterglow NAMESPACE afterglow:: FILE afterglow-targets.cmake DESTINATION ${config_folder} COMPONENT development)
configure_package_config_file(cmake/afterglow-config.cmake.in ${CMAKE_BINARY_DIR}/afterglow-config.cmake
  INSTALL_DESTINATION ${config_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/afterglow-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/afterglow-config.cmake ${CMAKE_BINARY_DIR}/afterglow-config-version.cmake
  DESTINATION ${config_folder} COMPONENT development)

file(RELATIVE_PATH AFTERGLOW_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/afterglow.pc.in ${CMAKE_BINARY_DIR}/afterglow.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/afterglow.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
