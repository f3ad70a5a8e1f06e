# An installation: the program (found by engine/apps), what it reads at run time, and the library for programs that embed it:
#   find_package(afterglow REQUIRED)  and  target_link_libraries(engine PRIVATE afterglow::session)
include(CMakePackageConfigHelpers)

install(DIRECTORY scripts shaders presets templates calibration assets DESTINATION ${CMAKE_INSTALL_DATADIR}/afterglow USE_SOURCE_PERMISSIONS)
install(DIRECTORY engine/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/afterglow
  FILES_MATCHING PATTERN "*.h" PATTERN reference EXCLUDE PATTERN bench EXCLUDE PATTERN batch EXCLUDE PATTERN edit EXCLUDE PATTERN stress EXCLUDE PATTERN play EXCLUDE PATTERN window EXCLUDE PATTERN apps EXCLUDE)

set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/afterglow)
install(EXPORT afterglow NAMESPACE afterglow:: FILE afterglow-targets.cmake DESTINATION ${config_folder})
configure_package_config_file(cmake/afterglow-config.cmake.in ${CMAKE_BINARY_DIR}/afterglow-config.cmake
  INSTALL_DESTINATION ${config_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/afterglow-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/afterglow-config.cmake ${CMAKE_BINARY_DIR}/afterglow-config-version.cmake
  cmake/dependencies.cmake cmake/lua.cmake DESTINATION ${config_folder})
