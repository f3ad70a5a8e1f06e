# SPDX-License-Identifier: MIT
# An installation, in components: the program, the library, what both read at run time, what hosts are compiled with
# (find_package(afterglow) and pkg-config), the Python module.
include(CMakePackageConfigHelpers)

install(DIRECTORY scripts shaders presets templates calibration assets DESTINATION ${CMAKE_INSTALL_DATADIR}/afterglow
  USE_SOURCE_PERMISSIONS COMPONENT data)

# What shells, `man` and desktops know of the program; the texts come from the program itself.
set(words ${CMAKE_BINARY_DIR}/words)
add_custom_command(OUTPUT ${words}/made DEPENDS afterglow ${CMAKE_CURRENT_LIST_DIR}/words.cmake
  COMMAND ${CMAKE_COMMAND} -D program=$<TARGET_FILE:afterglow> -D folder=${words} -P ${CMAKE_CURRENT_LIST_DIR}/words.cmake
  COMMENT "Writing manual pages and completions" VERBATIM)
if(NOT AFTERGLOW_FUZZ)
  add_custom_target(afterglow_words ALL DEPENDS ${words}/made)
  install(DIRECTORY ${words}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
  install(FILES ${words}/bash/afterglow DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
  install(FILES ${words}/zsh/_afterglow DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program)
  install(FILES ${words}/fish/afterglow.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
endif()
install(FILES packaging/org.afterglow.afterglow.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT program)
install(FILES packaging/org.afterglow.afterglow.metainfo.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/metainfo COMPONENT program)
install(FILES packaging/afterglow.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages COMPONENT program)
install(FILES packaging/afterglow.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps COMPONENT program)
install(FILES packaging/afterglow.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/mimetypes
  RENAME text-x-afterglow-look.svg COMPONENT program)

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
